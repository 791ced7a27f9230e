# What is out of focus is blurred as Cycles blurs it, whatever the camera's opening; viewports show it, comparisons not.
import math
import types

import bpy
import mathutils
import numpy as np
import pytest
from mesograin import compat
from mesograin.engine import engine
from mesograin.scene import export
from mesograin.studies.comparison import ours
from test_export import add_camera, add_object, add_sun

WIDTH, HEIGHT = 96, 48


def scene_of_balls(**settings):
    """Three Lambert balls, the one in the middle in focus, before a camera with depth of field."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "MESOGRAIN"
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.render.film_transparent = True
    scene.mesograin.exchange = "off"
    material = bpy.data.materials.new("Chalk")
    compat.use_nodes(material)
    material.node_tree.nodes.clear()
    nodes = material.node_tree.nodes
    diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = (0.8, 0.5, 0.2, 1.0)
    material.node_tree.links.new(diffuse.outputs[0], output.inputs[0])
    for x, z in ((-1.6, 2.5), (0.0, 0.0), (2.6, -4.0)):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=0.9, location=(x, 0.3 * x, z))
        bpy.ops.object.shade_smooth()
        bpy.context.object.data.materials.append(material)
    focus = add_object("Focus", None)
    focus.location = (3.0, 1.0, 0.9)
    camera = add_camera((0.0, 0.0, 8.0), **{"lens": 60.0, **settings})
    camera.rotation_euler = (0.02, 0.01, 0.3)
    field = camera.data.dof
    field.use_dof, field.focus_object = True, focus
    add_sun((0.5, 0.3, 1.0), 3.0)
    return scene, field


def cycles(scene):
    """Renders what follows with Cycles, direct light only."""
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = 512, False, False
    scene.cycles.pixel_filter_type, scene.cycles.max_bounces = "BOX", 0
    scene.cycles.sample_clamp_indirect = scene.cycles.sample_clamp_direct = 0.0


def in_blocks(picture, side=4):
    return picture.reshape(HEIGHT // side, side, WIDTH // side, side, -1).mean(axis=(1, 3))


def apart(picture, reference):
    """Relative L1 in blocks of 4 x 4 pixels, over all channels."""
    return np.abs(in_blocks(picture) - in_blocks(reference)).sum() / in_blocks(reference).sum()


@pytest.mark.parametrize("camera, opening", [
    ({}, {"aperture_fstop": 0.03}),
    ({}, {"aperture_fstop": 0.015, "aperture_blades": 3, "aperture_rotation": 0.6, "aperture_ratio": 1.7}),
    ({"type": "ORTHO", "ortho_scale": 8.0}, {"aperture_fstop": 0.5, "aperture_blades": 5}),
], ids=["round", "blades", "ortho"])
def test_the_blur_is_that_of_cycles(render, camera, opening):
    scene, field = scene_of_balls(**camera)
    for name, value in opening.items():
        setattr(field, name, value)
    scene.mesograin.samples = 256
    blurred = render()
    field.use_dof = False
    scene.mesograin.samples = 16
    sharp = render()
    field.use_dof = True
    cycles(scene)
    reference = render()
    assert apart(sharp, reference) > 0.08
    assert apart(blurred, reference) < 0.01


def test_a_focus_distance_counts_along_the_axis_and_a_bone_is_a_focus():
    scene, field = scene_of_balls()
    camera = scene.camera
    camera.rotation_euler = (0.0, math.radians(30.0), 0.0)

    def focus():
        bpy.context.view_layer.update()
        return export.camera_from_scene(bpy.context.evaluated_depsgraph_get(), WIDTH, HEIGHT).lens.focus_distance

    axis = (0.5, 0.0, math.sqrt(0.75))
    assert focus() == pytest.approx(abs(np.dot(axis, np.subtract((0.0, 0.0, 8.0), (3.0, 1.0, 0.9)))), rel=1e-5)
    rig = add_object("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = rig.data.edit_bones.new("Tip")
    bone.head, bone.tail = (0.0, 0.0, 2.0), (0.0, 0.0, 3.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    field.focus_object, field.focus_subtarget = rig, "Tip"
    assert focus() == pytest.approx(abs(np.dot(axis, (0.0, 0.0, 6.0))), rel=1e-5)
    field.focus_object, field.focus_distance = None, 0.0
    assert focus() > 0.0
    field.use_dof = False
    assert export.camera_from_scene(bpy.context.evaluated_depsgraph_get(), WIDTH, HEIGHT).lens is None


def test_a_viewport_shows_it_through_the_camera_only():
    scene, _ = scene_of_balls()
    evaluated = bpy.context.evaluated_depsgraph_get()
    for perspective, has in (("CAMERA", True), ("PERSP", False)):
        view = types.SimpleNamespace(view_perspective=perspective, view_matrix=scene.camera.matrix_world.inverted(),
                                     window_matrix=scene.camera.calc_matrix_camera(evaluated, x=WIDTH, y=HEIGHT))
        space = types.SimpleNamespace(use_local_camera=False, camera=None)
        seen = engine._viewport_camera(types.SimpleNamespace(region_data=view, space_data=space), evaluated)
        assert (seen.lens is not None) == has
        if has:
            rendered = export.camera_from_scene(evaluated, WIDTH, HEIGHT).lens
            assert seen.lens.focus_distance == pytest.approx(rendered.focus_distance, rel=1e-5)
            assert seen.lens.aperture_radius == rendered.aperture_radius


def test_a_viewport_says_that_its_camera_is_scaled_to_nothing(native):
    scene, _ = scene_of_balls()
    view = types.SimpleNamespace(view_perspective="CAMERA", view_matrix=mathutils.Matrix.Diagonal((1.0, 0.0, 1.0, 1.0)),
                                 window_matrix=mathutils.Matrix())
    context = types.SimpleNamespace(region_data=view,
                                    space_data=types.SimpleNamespace(use_local_camera=False, camera=None))
    with pytest.raises(native.Error, match=f"Camera '{scene.camera.name}' is scaled to nothing"):
        engine._viewport_camera(context, bpy.context.evaluated_depsgraph_get())


def test_a_comparison_is_sharp_on_both_sides():
    scene_of_balls()
    pictures = ours.Ours(bpy.context.evaluated_depsgraph_get(), (WIDTH, HEIGHT), {}, parts=1)
    assert pictures._camera.lens is None


def test_its_panels_are_shown():
    names = {panel.__name__ for panel in compat.borrowed_panels()}
    assert {"DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture"} <= names
