# Every kind of light and the world against Cycles' Diffuse BSDF: a ground near a light, and far from it.
import math

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix
from test_export import add_mesh_object, add_object, read_scene

from mesograin import compat

SIZE = 16


@pytest.fixture
def ground():
    """A white ground, 4 by 4, seen straight from above; the picture shows 3 by 3 of it."""
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    white = bpy.data.materials.new("White")
    white.mesograin.model, white.mesograin.reflectance = "lambert", (0.8, 0.8, 0.8)
    compat.use_nodes(white)
    tree = white.node_tree
    tree.nodes.clear()
    diffuse, output = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = (0.8, 0.8, 0.8, 1.0)
    tree.links.new(diffuse.outputs["BSDF"], output.inputs["Surface"])
    made = add_mesh_object("Ground", [(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)], [(0, 1, 2, 3)])
    made.data.materials.append(white)
    camera = bpy.data.cameras.new("Camera")
    camera.type, camera.ortho_scale = "ORTHO", 3.0
    scene.camera = add_object("Camera", camera, Matrix.Translation((0.0, 0.0, 8.0)))
    return scene


def add_light(kind, place, turned=(0.0, 0.0, 0.0), scale=(1.0, 1.0, 1.0), **properties):
    light = bpy.data.lights.new(kind.title(), kind)
    light.energy, light.color = 30.0, (1.0, 0.5, 0.25)
    for name, value in properties.items():
        setattr(light, name, value)
    return add_object(kind.title(), light, Matrix.LocRotScale(place, Euler(turned), scale))


def assert_as_in_cycles(scene, render, tolerance=0.01, samples=1024):
    """Relative L1 in blocks of 4 x 4 pixels."""
    scene.mesograin.samples = 256
    ours = render()
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.max_bounces = samples, 0
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.cycles.pixel_filter_type = "BOX"
    theirs = render()

    def blocks(picture):
        return picture[..., :3].astype(np.float64).reshape(SIZE // 4, 4, SIZE // 4, 4, 3).mean(axis=(1, 3))

    error = np.abs(blocks(ours) - blocks(theirs)).sum() / blocks(theirs).sum()
    assert blocks(theirs).sum() > 0.0
    assert error <= tolerance, f"{error:.4f}: {blocks(ours)[..., 0]} {blocks(theirs)[..., 0]}"
    return theirs


@pytest.mark.parametrize("degrees, tolerance", [
    (5.0, 0.002), (30.0, 0.005), (90.0, 0.01), (150.0, 0.01), (175.0, 0.01)])
def test_a_wide_sun(ground, render, degrees, tolerance):
    add_light("SUN", (0.0, 0.0, 3.0), (0.6, 0.2, 0.0), angle=math.radians(degrees))
    assert_as_in_cycles(ground, render, tolerance)


NEAR_AND_FAR = pytest.mark.parametrize("height", [1.0, 6.0])


@NEAR_AND_FAR
@pytest.mark.parametrize("radius", [0.0, 0.5, 1.2])
def test_point(ground, render, height, radius):
    add_light("POINT", (0.4, -0.3, height), shadow_soft_size=radius)
    assert_as_in_cycles(ground, render)


@pytest.mark.skipif("use_soft_falloff" not in bpy.types.PointLight.bl_rna.properties,
                    reason="this Blender's lights fade softly or not at all")
def test_sphere(ground, render):
    add_light("POINT", (0.4, -0.3, 1.0), shadow_soft_size=0.8, use_soft_falloff=False)
    assert_as_in_cycles(ground, render)


@NEAR_AND_FAR
@pytest.mark.parametrize("blend", [0.0, 0.15, 1.0])
def test_spot(ground, render, height, blend):
    add_light("SPOT", (0.4, -0.3, height), (0.1, -0.2, 0.0), (1.0, 1.5, 1.0), shadow_soft_size=0.3, spot_blend=blend,
              spot_size=math.radians(70))
    assert_as_in_cycles(ground, render, 0.02 if blend == 0.0 else 0.01)


@NEAR_AND_FAR
@pytest.mark.parametrize("shape", ["SQUARE", "RECTANGLE", "DISK", "ELLIPSE"])
def test_area(ground, render, height, shape):
    add_light("AREA", (0.4, -0.3, height), (0.3, -0.2, 0.4), (1.0, 2.0, 1.5), shape=shape, size=1.0, size_y=0.4)
    assert_as_in_cycles(ground, render)


def test_area_with_spread_and_mirrored(ground, render):
    add_light("AREA", (0.4, -0.3, 1.0), scale=(-1.0, 1.0, 1.0), size=1.0, spread=math.radians(80))
    assert_as_in_cycles(ground, render)


def test_emission_of_nodes_counts_and_textures_are_told(ground, render):
    light = add_light("POINT", (0.4, -0.3, 2.0)).data
    compat.use_nodes(light)
    emission = next(node for node in light.node_tree.nodes if node.type == "EMISSION")
    emission.inputs["Color"].default_value[:3] = (0.2, 0.7, 1.0)
    emission.inputs["Strength"].default_value = 3.0
    assert_as_in_cycles(ground, render)


@pytest.mark.parametrize("kelvin", [1500.0, 3000.0, 6500.0])
def test_a_light_of_a_temperature(ground, render, kelvin):
    light = add_light("POINT", (0.4, -0.3, 2.0), color=(1.0, 1.0, 1.0)).data
    compat.use_nodes(light)
    tree = light.node_tree
    emission = next(node for node in tree.nodes if node.type == "EMISSION")
    glow = tree.nodes.new("ShaderNodeBlackbody")
    glow.inputs["Temperature"].default_value = kelvin
    tree.links.new(glow.outputs["Color"], emission.inputs["Color"])
    theirs = assert_as_in_cycles(ground, render)[..., :3].mean(axis=(0, 1))
    ours = np.array(read_scene().lights[0].values[1][1])
    np.testing.assert_allclose(ours / ours[1], theirs / theirs[1], atol=0.01)


def test_a_muted_emission_gives_no_light(ground, render):
    add_light("POINT", (0.4, -0.3, 2.0))
    muted = add_light("POINT", (-0.4, 0.3, 2.0)).data
    compat.use_nodes(muted)
    next(node for node in muted.node_tree.nodes if node.type == "EMISSION").mute = True
    assert_as_in_cycles(ground, render)


def test_nodes_that_vary_nothing_are_followed(ground, render):
    light = add_light("POINT", (0.4, -0.3, 2.0)).data
    compat.use_nodes(light)
    tree = light.node_tree
    emission = next(node for node in tree.nodes if node.type == "EMISSION")
    ramp, product = tree.nodes.new("ShaderNodeValToRGB"), tree.nodes.new("ShaderNodeMath")
    ramp.color_ramp.elements[1].color = (0.2, 0.7, 1.0, 1.0)
    ramp.inputs["Fac"].default_value = 0.6
    product.operation = "MULTIPLY"
    product.inputs[0].default_value, product.inputs[1].default_value = 3.0, 1.5
    tree.links.new(ramp.outputs["Color"], emission.inputs["Color"])
    tree.links.new(product.outputs["Value"], emission.inputs["Strength"])
    assert_as_in_cycles(ground, render)
    assert read_scene().warnings == ()
    places = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(places.outputs["Normal"], ramp.inputs["Fac"])
    [sentence] = read_scene().warnings
    assert "Light 'Point'" in sentence and "vary its color" in sentence


@pytest.mark.parametrize("kind", ["SUN", "SPOT", "AREA"])
@pytest.mark.parametrize("axes", [(0.0, 0.0, 0.0), (1.0, 1.0, 0.0), (1.0, 0.0, 1.0)])
def test_a_light_without_a_direction_is_left_out_and_said(ground, render, kind, axes):
    # A sun needs its own axis alone, and a sheet of light is one that has no thickness.
    alone = render()
    add_light("POINT", (0.0, 0.0, 1.0))
    with_a_lamp = render()
    assert with_a_lamp.sum() > alone.sum()
    flat = add_light(kind, (0.0, 0.0, 1.0), turned=(math.pi, 0.0, 0.0), scale=axes, energy=0.0)
    there = [flat.name] if {"SUN": axes[2], "SPOT": min(axes), "AREA": min(axes[:2])}[kind] else []
    values = read_scene()
    assert [light.name for light in values.lights if light.name == flat.name] == there
    sentences = [sentence for sentence in values.warnings if flat.name in sentence]
    assert sentences == ([] if there else [f"Light '{flat.name}' is scaled to nothing, so it is left out."])
    assert np.array_equal(render(), with_a_lamp), "the other lights are as they were"


def make_world(scene, colour, strength):
    scene.world = bpy.data.worlds.new("World")
    compat.use_nodes(scene.world)
    background = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value[:3] = colour
    background.inputs["Strength"].default_value = strength
    return scene.world.node_tree, background


def test_world_of_one_colour_is_light_and_background(ground, render):
    ground.camera.data.ortho_scale = 6.0
    make_world(ground, (0.1, 0.4, 0.2), 2.0)
    theirs = assert_as_in_cycles(ground, render)
    np.testing.assert_allclose(theirs[0, 0, :3], (0.2, 0.8, 0.4), rtol=1e-3)


@pytest.mark.parametrize("mapping", ["POINT", "TEXTURE"])
def test_world_with_an_image(ground, render, mapping):
    """Dim noise and one bright place, turned; seen beside the ground by a camera that looks at the horizon."""
    random = np.random.default_rng(3)
    pixels = np.ones((32, 64, 4), dtype=np.float32)
    pixels[..., :3] = 0.2 * random.random((32, 64, 3))
    pixels[22:25, 40:44, :3] = (30.0, 20.0, 10.0)
    image = bpy.data.images.new("Sky", 64, 32, float_buffer=True)
    compat.set_linear(image)
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    tree, background = make_world(ground, (0.0, 0.0, 0.0), 0.5)
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    turn = tree.nodes.new("ShaderNodeMapping")
    turn.vector_type = mapping
    turn.inputs["Rotation"].default_value = (0.3, -0.2, 1.1)
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["Generated"], turn.inputs["Vector"])
    tree.links.new(turn.outputs["Vector"], texture.inputs["Vector"])
    camera = bpy.data.cameras.new("Wide")
    camera.angle = 2.0
    ground.camera = add_object("Wide", camera, Matrix.LocRotScale((0.0, -3.0, 1.5), Euler((1.2, 0.0, 0.0)), None))
    assert_as_in_cycles(ground, render, 0.02)


def test_a_transparent_film_hides_the_world(ground, render):
    ground.camera.data.ortho_scale = 6.0
    make_world(ground, (0.1, 0.4, 0.2), 2.0)
    assert render()[0, 0, 3] == 1.0
    ground.render.film_transparent = True
    picture = render()
    assert picture[0, 0].max() == 0.0 and picture[SIZE // 2, SIZE // 2, 3] == 1.0


@pytest.mark.parametrize("turned", [(0.0, 0.0, 0.0), (math.pi, 0.0, 0.0), (0.6, 0.3, 0.0)])
def test_a_shining_rectangle_lights_others(ground, render, turned):
    """On both its sides."""
    shining = bpy.data.materials.new("Shining")
    compat.use_nodes(shining)
    tree = shining.node_tree
    tree.nodes.clear()
    emission, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputMaterial")
    emission.inputs["Color"].default_value = (1.0, 0.5, 0.25, 1.0)
    emission.inputs["Strength"].default_value = 6.0
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    lamp = add_mesh_object("Lamp", [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 1, 2, 3)],
                           matrix=Matrix.LocRotScale((1.2, 0.3, 1.3), Euler(turned), (0.5, 0.8, 1.0)))
    lamp.data.materials.append(shining)
    assert_as_in_cycles(ground, render)


def test_what_shines_and_is_no_rectangle_is_said(ground):
    bpy.ops.mesh.primitive_ico_sphere_add(location=(0.0, 0.0, 1.0))
    shining = bpy.data.materials.new("Shining")
    compat.use_nodes(shining)
    tree = shining.node_tree
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(emission.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])
    bpy.context.object.data.materials.append(shining)
    [sentence, _] = read_scene().warnings
    assert "'Icosphere' shines, but on nothing" in sentence
