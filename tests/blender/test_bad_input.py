# Whatever is wrong with a scene becomes one sentence that names it, and Blender lives on.
import math
import os
import signal
import threading
import time

import bpy
import numpy as np
import pytest
from mathutils import Matrix
from mesograin import compat
from mesograin.engine import status
from mesograin.studies.baking import surface
from test_export import add_camera, add_cube, add_mesh_object, add_object, add_sun


@pytest.fixture
def scene():
    """A lit cube before a camera, 16 pixels wide."""
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.mesograin.samples = 1
    cube = add_cube()
    sand = bpy.data.materials.new("Sand")  # from Blender 5 on with nodes, of which something would be left out
    sand.mesograin.model = "lambert"
    cube.data.materials.append(sand)
    add_camera((0.0, 0.0, 6.0))
    add_sun((0.2, 0.1, 1.0), 3.0)
    return scene


def error_of_render():
    with pytest.raises(RuntimeError) as complaint:
        bpy.ops.render.render()
    return str(complaint.value)


def assert_one_sentence(sentence, *words):
    assert all(word in sentence for word in words), sentence
    assert "Traceback" not in sentence


def warnings_of_render(render):
    picture = render()
    return picture, status.get(status.RENDER).warnings


def test_the_scene_itself_is_fine(scene, render):
    picture, warnings = warnings_of_render(render)
    assert warnings == () and picture[8, 8, 0] > 0.1


@pytest.mark.parametrize("parameter", ["g", "eta", "roughness", "scale"])
@pytest.mark.parametrize("value", [math.nan], ids=["nan"])
def test_number_that_is_none(scene, render, parameter, value):
    grain = bpy.data.materials["Sand"].mesograin
    kept = getattr(grain, parameter)
    setattr(grain, parameter, value)
    assert_one_sentence(error_of_render(), "Material 'Sand'", parameter, "nan")
    assert_one_sentence(status.get(status.RENDER).error, "Material 'Sand'", parameter)
    setattr(grain, parameter, kept)
    assert render()[8, 8, 0] > 0.1


@pytest.mark.parametrize("parameter", ["reflectance", "sigma_a", "sigma_s"])
@pytest.mark.parametrize("value", [math.nan], ids=["nan"])
def test_vector_with_a_number_that_is_none(scene, parameter, value):
    setattr(bpy.data.materials["Sand"].mesograin, parameter, (0.5, value, 0.5))
    assert_one_sentence(error_of_render(), "Material 'Sand'", parameter, "channel G", "nan")


def test_coordinates_that_are_none(scene):
    bpy.data.objects["Cube"].data.vertices[3].co.x = math.nan
    assert_one_sentence(error_of_render(), "Object 'Cube'", "finite")


@pytest.mark.parametrize("kind", ["SUN", "POINT", "SPOT", "AREA"])
@pytest.mark.parametrize("energy, reason", [(-1.0, "negative"), (math.nan, "no number"), (math.inf, "no number")])
def test_a_light_of_no_strength_that_can_be_drawn_is_left_out_and_no_other(scene, render, kind, energy, reason):
    before = render()
    lost = add_object("Lost", bpy.data.lights.new("Lost", kind), Matrix.Translation((0.0, 0.0, 3.0)))
    lost.data.energy = energy
    picture, warnings = warnings_of_render(render)
    [sentence] = warnings
    assert_one_sentence(sentence, "Light 'Lost'", reason, "left out")
    np.testing.assert_array_equal(picture, before)


def test_sun_as_wide_as_half_the_sky(scene, render):
    bpy.data.lights["Sun"].angle = math.pi
    picture = render()
    assert np.isfinite(picture).all() and picture[8, 8, 0] > 0.1


def test_more_lights_than_anyone_needs(scene, render):
    bpy.data.materials["Sand"].mesograin.model = "lambert"
    before = render()
    bpy.data.lights["Sun"].energy /= 40
    for _ in range(39):
        add_object("Copy", bpy.data.lights["Sun"], bpy.data.objects["Sun"].matrix_world.copy())
    for model in ("lambert", "model_3"):
        bpy.data.materials["Sand"].mesograin.model = model
        picture, warnings = warnings_of_render(render)
        assert warnings == () and np.isfinite(picture).all() and picture[8, 8, 0] > 0.01
        if model == "lambert":
            np.testing.assert_allclose(picture, before, rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("place, complaints", [(math.nan, 1), (1e38, 0)], ids=["nan", "far"])
def test_object_that_is_nowhere(scene, render, place, complaints):
    before = render()
    add_cube("Lost").location.x = place
    picture, warnings = warnings_of_render(render)
    assert len(warnings) == complaints and all("Object 'Lost' has a place" in sentence for sentence in warnings)
    np.testing.assert_allclose(picture, before, atol=1e-5)


def nowhere(camera):
    camera.location.y = math.nan


def scaled_to_nothing(camera):
    camera.scale = (0.0, 0.0, 0.0)


def without_a_lens(camera):
    camera.data.lens = math.nan


def between_planes_that_are_one(camera):
    camera.data.clip_start = camera.data.clip_end = 1.0


def sees_something(camera):
    """Whether this Blender makes a lens of what it is told."""
    lens = np.array(camera.calc_matrix_camera(bpy.context.evaluated_depsgraph_get(), x=8, y=8))
    return np.isfinite(lens).all() and np.linalg.det(lens) != 0.0


@pytest.mark.parametrize("spoil, words", [(nowhere, "place it anew"), (scaled_to_nothing, "clear its scale"),
                                          (without_a_lens, "focal length"), (between_planes_that_are_one, "clip")])
def test_camera_that_cannot_look(scene, render, spoil, words):
    spoil(scene.camera)
    if spoil is between_planes_that_are_one and sees_something(scene.camera):
        return  # Blender 5 puts them apart itself
    assert_one_sentence(error_of_render(), "Camera 'Camera'", words)
    bpy.data.objects.remove(scene.camera)
    add_camera((0.0, 0.0, 6.0))
    assert render()[8, 8, 0] > 0.1


def test_no_camera(scene, render):
    bpy.data.objects.remove(bpy.data.objects["Camera"])
    assert_one_sentence(error_of_render().lower(), "camera")
    add_camera((0.0, 0.0, 6.0))
    assert render()[8, 8, 0] > 0.1


def test_no_light(scene, render):
    bpy.data.objects.remove(bpy.data.objects["Sun"])
    picture, warnings = warnings_of_render(render)
    assert picture[..., :3].max() == 0.0
    [sentence] = warnings
    assert_one_sentence(sentence, "no light", "add a light")


def test_other_lights(scene, render):
    dark = render()[8, 8, 0]
    for kind in ("POINT", "SPOT", "AREA"):
        made = add_object(kind.title(), bpy.data.lights.new(kind.title(), kind))
        made.location, made.data.energy = (0.0, 0.0, 4.0), 100.0
        picture, warnings = warnings_of_render(render)
        assert warnings == ()
        assert picture[8, 8, 0] > 1.05 * dark, kind
        dark = picture[8, 8, 0]


@pytest.mark.parametrize("strength, reason", [(-1.0, "negative"), (math.nan, "no number")])
def test_a_world_of_no_strength_that_can_be_drawn_is_black(scene, render, strength, reason):
    before = render()
    scene.world = bpy.data.worlds.new("Night")
    compat.use_nodes(scene.world)
    tree = scene.world.node_tree
    number = tree.nodes.new("ShaderNodeValue")
    tree.links.new(number.outputs[0], tree.nodes["Background"].inputs["Strength"])
    number.outputs[0].default_value = strength
    picture, warnings = warnings_of_render(render)
    [sentence] = warnings
    assert_one_sentence(sentence, "World 'Night'", reason, "black")
    np.testing.assert_array_equal(picture, before)


def test_world_without_background(scene, render):
    scene.world = bpy.data.worlds.new("Sky")
    compat.use_nodes(scene.world)
    tree = scene.world.node_tree
    background = tree.nodes["Background"]
    background.inputs["Color"].default_value[:3] = (0.0, 0.0, 0.0)
    assert warnings_of_render(render)[1] == ()
    sky = tree.nodes.new("ShaderNodeTexSky")
    sky.sky_type = "HOSEK_WILKIE"
    tree.links.new(background.inputs["Color"], sky.outputs[0])
    [sentence] = warnings_of_render(render)[1]
    assert_one_sentence(sentence, "World 'Sky'", sky.name, "environment image")
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    tree.links.new(background.inputs["Color"], texture.outputs["Color"])
    [sentence] = warnings_of_render(render)[1]
    assert_one_sentence(sentence, "World 'Sky'", "without an image")
    texture.image = bpy.data.images.new("Lost", 8, 8)
    texture.image.source, texture.image.filepath = "FILE", "//lost.hdr"
    [sentence] = warnings_of_render(render)[1]
    assert_one_sentence(sentence, "World 'Sky'", "Lost", "cannot be loaded")
    tree.nodes.remove(background)
    assert warnings_of_render(render)[1] == ()


def test_sun_with_nodes(scene, render):
    sun = bpy.data.lights["Sun"]
    compat.use_nodes(sun)
    assert warnings_of_render(render)[1] == (), "nodes that change nothing are no cause for a warning"
    emission = next(node for node in sun.node_tree.nodes if node.type == "EMISSION")
    single = render()[8, 8, 0]
    emission.inputs["Strength"].default_value = 2.0
    picture, warnings = warnings_of_render(render)
    assert warnings == () and picture[8, 8, 0] == pytest.approx(2.0 * single)
    falloff = sun.node_tree.nodes.new("ShaderNodeLightFalloff")
    sun.node_tree.links.new(falloff.outputs[0], emission.inputs["Strength"])
    [sentence] = warnings_of_render(render)[1]
    assert_one_sentence(sentence, "Light 'Sun'", "strength", "left out")


def test_a_picture_that_was_not_chosen(scene, render):
    cube = bpy.data.objects["Cube"]
    cube.active_material = paint = bpy.data.materials.new("Paint")
    compat.use_nodes(paint)
    shader = next(node for node in paint.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    texture = paint.node_tree.nodes.new("ShaderNodeTexImage")
    paint.node_tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    [sentence] = warnings_of_render(render)[1]
    assert_one_sentence(sentence, "Material 'Paint'", f"its node '{texture.name}' has no image")


def test_a_volume_of_the_world_is_said(scene, render):
    scene.world = bpy.data.worlds.new("Fog")
    compat.use_nodes(scene.world)
    tree = scene.world.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    scatter = tree.nodes.new("ShaderNodeVolumeScatter")
    link = tree.links.new(scatter.outputs[0], output.inputs["Volume"])
    [sentence] = warnings_of_render(render)[1]
    assert_one_sentence(sentence, "World 'Fog'", "volume", "left out")
    tree.links.remove(link)
    assert warnings_of_render(render)[1] == ()


@pytest.mark.parametrize("ask, words", [
    (lambda cube: setattr(cube, "is_holdout", True), ("a holdout",)),
    (lambda cube: setattr(cube, "is_shadow_catcher", True), ("a shadow catcher",)),
    (lambda cube: (setattr(cube, "visible_camera", False), setattr(cube, "visible_shadow", False)),
     ("hidden from camera and shadow rays",)),
    (lambda cube: cube.modifiers.new("Fur", "PARTICLE_SYSTEM").particle_system.settings.__setattr__("type", "HAIR"),
     ("hair 'Fur'", "convert it to a mesh")),
])
def test_what_an_object_asks_for_in_vain_is_said(scene, render, ask, words):
    cube = bpy.data.objects["Cube"]
    assert warnings_of_render(render)[1] == ()
    ask(cube)
    [sentence] = warnings_of_render(render)[1]
    assert_one_sentence(sentence, "Object 'Cube'", "left out", *words)


def test_a_light_without_shadows_is_said(scene, render):
    light = bpy.data.lights["Sun"]
    if hasattr(light.cycles, "cast_shadow"):
        light.cycles.cast_shadow = False
    else:
        light.use_shadow = False
    [sentence] = warnings_of_render(render)[1]
    assert_one_sentence(sentence, "Light 'Sun'", "casts shadows")


def test_empty_mesh(scene, render):
    add_mesh_object("Dust", [], [])
    add_mesh_object("Wire", [(0, 0, 0), (1, 0, 0)], [])
    picture, warnings = warnings_of_render(render)
    assert picture[8, 8, 0] > 0.1
    assert len(warnings) == 2
    for name in ("Dust", "Wire"):
        assert any(f"Object '{name}' has no faces" in sentence for sentence in warnings)


def test_empty_scene(scene, render):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    picture, warnings = warnings_of_render(render)
    assert picture[..., :3].max() == 0.0
    assert any("nothing to draw" in sentence for sentence in warnings)


def test_object_scaled_to_nothing(scene, render):
    add_cube("Gone", matrix=Matrix.Diagonal((1.0, 0.0, 1.0, 1.0)))
    picture, warnings = warnings_of_render(render)
    assert picture[8, 8, 0] > 0.1
    assert any("Object 'Gone' is scaled to nothing" in sentence for sentence in warnings)


def test_degenerate_faces(scene, render):
    add_mesh_object("Sliver", [(0, 0, 2), (0, 0, 2), (0, 0, 2)], [(0, 1, 2)])
    add_mesh_object("Partly", [(0, 0, 2), (0, 0, 2), (0, 0, 2), (9, 9, -9), (9, 8, -9), (8, 9, -9)],
                    [(0, 1, 2)] * 70 + [(3, 4, 5)])
    picture, warnings = warnings_of_render(render)
    assert (picture == picture).all() and picture[8, 8, 0] > 0.1
    [sentence] = warnings
    assert_one_sentence(sentence, "Object 'Sliver'", "without any area")


def test_uvs_that_are_no_numbers_matter_to_a_bake_alone(scene, render):
    before = render()
    cube = bpy.data.objects["Cube"]
    layer = cube.data.uv_layers.new()
    layer.data[3].uv.x = math.nan
    picture, warnings = warnings_of_render(render)
    assert warnings == ()
    np.testing.assert_allclose(picture, before, atol=1e-6)
    with pytest.raises(surface.BakeError, match="Object 'Cube' has UVs that are no numbers: unwrap it anew"):
        surface.Surface(bpy.context.evaluated_depsgraph_get(), "Cube", (8, 8))
    layer.data[3].uv.x = 0.5
    cube.data.update_tag()
    surface.Surface(bpy.context.evaluated_depsgraph_get(), "Cube", (8, 8))


def test_panoramic_camera(scene, render):
    bpy.data.cameras["Camera"].type = "PANO"
    _, warnings = warnings_of_render(render)
    assert any("panoramic" in sentence for sentence in warnings)


def test_mirrored_object_is_lit_from_outside(scene, render):
    before = render()
    bpy.data.objects["Cube"].scale = (-1.0, 1.0, 1.0)
    assert abs(render() - before).max() < 1e-4


def test_warnings_vanish_with_their_cause(scene, render):
    add_mesh_object("Dust", [], [])
    assert warnings_of_render(render)[1]
    bpy.data.objects.remove(bpy.data.objects["Dust"])
    assert warnings_of_render(render)[1] == ()
    assert status.complaints() == []


def test_a_cancelled_render_ends_at_once_and_keeps_what_it_has(scene):
    scene.mesograin.samples = 1 << 20
    # Ctrl-C is how a render without a window is cancelled.
    timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    started = time.monotonic()
    bpy.ops.render.render()
    assert time.monotonic() - started < 10.0
    assert 0 < status.get(status.RENDER).samples < 1 << 20


def test_an_exposure_that_is_cycles_own_is_said(scene, render):
    if not hasattr(scene, "cycles"):
        pytest.skip("this Blender has no Cycles")
    scene.cycles.film_exposure = 0.7
    [sentence] = warnings_of_render(render)[1]
    assert_one_sentence(sentence, "exposure", "0.7", "Color Management")
