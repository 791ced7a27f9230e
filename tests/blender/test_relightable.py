# A surface baked for light from anywhere: what was baked comes back, and the node group shows in Cycles what we draw.
import json
import os

import bpy
import numpy as np
import pytest
from cycles_scenes import depsgraph, make_sphere, unit
from mathutils import Euler, Vector
from test_bake import start

from mesograin import compat
from mesograin.scene import export
from mesograin.studies.baking import lobes, relightable, relightable_files, relightable_nodes, surface
from mesograin.studies.baking.relightable_bake import RelightableBake

COUNT = 25  # a cosine that ends at the terminator takes many


def blocks(pixels, side=8):
    height, width = (length // side for length in pixels.shape[:2])
    return pixels[:height * side, :width * side].reshape(height, side, width, side, -1).sum(axis=(1, 3))


@pytest.fixture
def turned():
    """A sphere of paint, turned, stretched and shadowless; the object."""
    make_sphere([((0.0, 0.0, 1.0), 1.0)], segments=32, rings=16, model="lambert", reflectance=(0.8, 0.4, 0.2))
    thing = bpy.context.object
    thing.rotation_euler = Euler((0.4, -0.7, 1.1))
    thing.scale = (1.0, 0.8, 0.9)
    return thing


@pytest.fixture
def files(turned, tmp_path):
    """relightable_files.paths of a bake of it."""
    output = tmp_path / "paint.exr"
    bake = RelightableBake(depsgraph(), turned.name, (64, 32), 2, COUNT)
    assert bake.bake().errors.mean() < 0.06
    bake.write(output, 4, False)
    bake.write_nodes(output)
    assert all("light" in sentence for sentence in bake.warnings)
    return relightable_files.paths(output)


def our_picture(size=64):
    evaluated = depsgraph()
    native = surface.native_module.get()
    view = native.View(size, size)
    scene, _ = export.scene_from_depsgraph(evaluated)
    view.set_scene(scene)
    view.set_camera(export.camera_from_scene(evaluated, size, size))
    view.render(16)
    return view.read()[..., :3]


def rendered(engine, out, size=64):
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.film_transparent = True
    scene.view_settings.view_transform = "Raw"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(out)
    scene.eevee.taa_render_samples = 1
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = 16, False, False
    bpy.ops.render.render(write_still=True)
    return surface.native_module.get().read_exr(str(out))[0][..., :3]


def wear(thing, files, to_light, irradiance):
    """The object's material is what it was baked to, of the library that was written."""
    with bpy.data.libraries.load(str(files["nodes"])) as (there, wanted):
        wanted.node_groups = there.node_groups
    material = bpy.data.materials.new("Relit")
    compat.use_nodes(material)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    group = nodes.new("ShaderNodeGroup")
    group.node_tree = wanted.node_groups[0]
    group.inputs["To Light"].default_value = to_light
    group.inputs["Irradiance"].default_value = (*irradiance, 1.0)
    emission, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    links.new(group.outputs[0], emission.inputs["Color"])
    links.new(emission.outputs[0], output.inputs["Surface"])
    thing.data.materials[0] = material


@pytest.mark.parametrize("towards", [(0.3, 0.5, 0.8), (0.9, -0.4, 0.1)])
def test_cycles_shows_by_the_nodes_what_we_draw(turned, files, towards, tmp_path):
    sun = next(thing for thing in bpy.data.objects if thing.type == "LIGHT")
    sun.rotation_euler = Vector(towards).to_track_quat("Z", "Y").to_euler()
    ours = blocks(our_picture())
    wear(turned, files, unit(towards), (1.0, 1.0, 1.0))
    sun.hide_render = True
    theirs = blocks(rendered("CYCLES", tmp_path / "cycles.exr"))
    assert np.abs(theirs - ours).sum() / ours.sum() < 0.09
    # What 25 lobes have too little or too much of a cosine that ends is clamped where it is dark.
    assert theirs.sum() / ours.sum() == pytest.approx(1.0, abs=0.07)


# EEVEE needs a screen, which tests/window/test_eevee.py has; a device filters textures to some 8 bits.
ENGINES = {"CYCLES": 2e-3, **({compat.eevee(): 0.02} if os.environ.get("DISPLAY") else {})}


@pytest.mark.parametrize("engine", ENGINES)
def test_the_nodes_are_the_sum_of_products(turned, native, tmp_path, engine):
    """Components of one colour each, so that the whole object has the colour that the lobes say."""
    rng = np.random.default_rng(2)
    colours = rng.uniform(0.1, 1.0, (5, 3))
    maps = (1.0 + lobes.map_directions() @ rng.uniform(-0.4, 0.4, (3, 5))).T.reshape(5, lobes.SIDE, lobes.SIDE)
    textures = np.broadcast_to(colours[:, None, None, :], (5, 8, 8, 3)).astype(np.float32)
    made = relightable.Relightable(textures, np.ones((8, 8), np.float32), maps, np.zeros((1, 3)), np.zeros(1))
    relightable_files.write(native, tmp_path / "a.exr", "A", made, {"margin": 0}, surface.PROVENANCE)
    paths = relightable_files.paths(tmp_path / "a.exr")
    relightable_nodes.save(paths, "Relit A", 5)
    depsgraph()  # from now on the matrix is that of the turned object
    for towards in lobes.even_directions(5):
        wear(turned, paths, towards, (1.0, 0.5, 2.0))
        in_object = np.array(turned.matrix_world.to_3x3().inverted() @ Vector(towards))
        expected = lobes.look_up(maps, [in_object])[0] @ colours * (1.0, 0.5, 2.0)
        middle = rendered(engine, tmp_path / "b.exr")[30:34, 30:34].mean(axis=(0, 1))
        np.testing.assert_allclose(middle, expected, rtol=ENGINES[engine])


def test_the_files_say_the_same(files, native):
    layers, channels, attributes = native.read_exr(files["layers"])
    assert channels[:3] == ["component_00.R", "component_00.G", "component_00.B"] and len(channels) == 3 * COUNT
    told = json.loads(attributes[surface.PROVENANCE])
    numbers = json.loads(files["numbers"].read_text())
    assert numbers["relative_l1_mean"] == told["relative_l1_mean"]
    assert len(numbers["directions"]) == relightable.JUDGED
    # The third component, in the atlas: column 2 of the lowest row.
    atlas = native.read_exr(files["atlas"])[0]
    columns, rows = relightable_files.grid(COUNT)
    height, width = atlas.shape[0] // rows, atlas.shape[1] // columns
    np.testing.assert_array_equal(atlas[-height:, 2 * width:3 * width], layers[..., 6:9])
    assert f"k < {COUNT}" in files["recipe"].read_text()


def test_light_through_a_surface_fades_slantwise():
    images = [bpy.data.images.new(name, 4, 4, float_buffer=True) for name in "ab"]
    group = relightable_nodes.build("Salt", *images, 4, eta=1.5)
    assert any(node.type == "FRESNEL" and node.inputs[0].default_value == 1.5 for node in group.nodes)
    assert len([node for node in group.nodes if node.type == "TEX_IMAGE"]) == 4 + 2


def test_the_command(tmp_path):
    make_sphere([], segments=16, rings=8, model="lambert")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    process = start(tmp_path / "a.blend", "-o", tmp_path / "b.exr", "--relightable", "--components", 4, "--size", 16,
                    "--samples", 1)
    said, errors = process.communicate()
    assert process.returncode == 0, errors
    assert "4 components of 16 x 16 texels: relative L1" in said and "over 64 directions" in said
    assert sorted(path.name for path in tmp_path.iterdir() if path.name.startswith("b.")) == [
        "b.atlas.exr", "b.blend", "b.exr", "b.glsl", "b.json", "b.lobes.exr"]


def test_lobes_belong_to_the_object(turned):
    """A light told in the object's space is one in the world."""
    lit = surface.Surface(depsgraph(), turned.name, (32, 16)).lit((32, 16), 1)
    direction = lobes.even_directions(5)[3]
    towards = turned.matrix_world.to_3x3() @ Vector(direction)
    sun = next(thing for thing in bpy.data.objects if thing.type == "LIGHT")
    sun.rotation_euler = towards.to_track_quat("Z", "Y").to_euler()
    baked = surface.Surface(depsgraph(), turned.name, (32, 16))
    assert baked.render(1)
    np.testing.assert_allclose(lit(direction)[..., :3], baked.texture()[..., :3], atol=1e-4)
