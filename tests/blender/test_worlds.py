# Worlds whose nodes are painted once, against Cycles: as light on a ground and behind it.
import math

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix
from test_export import add_object, read_scene
from test_lights import add_light, assert_as_in_cycles, ground, make_world  # noqa: F401 (a fixture)

from mesograin import compat
from mesograin.scene import surroundings


def look_over(ground):  # noqa: F811
    camera = bpy.data.cameras.new("Wide")
    camera.angle = 2.0
    ground.camera = add_object("Wide", camera, Matrix.LocRotScale((0.0, -3.0, 1.5), Euler((1.2, 0.0, 0.0)), None))


def nodes(tree, *kinds):
    return [tree.nodes.new(f"ShaderNode{kind}") for kind in kinds]


def gradient(tree, kind, turned):
    """Colours over directions; the output of their nodes."""
    places, turn, pattern, ramp = nodes(tree, "TexCoord", "Mapping", "TexGradient", "ValToRGB")
    turn.inputs["Rotation"].default_value = turned
    pattern.gradient_type = kind
    ramp.color_ramp.elements[0].color = (0.9, 0.4, 0.1, 1.0)
    ramp.color_ramp.elements[1].color = (0.05, 0.2, 0.8, 1.0)
    tree.links.new(places.outputs["Generated"], turn.inputs["Vector"])
    tree.links.new(turn.outputs["Vector"], pattern.inputs["Vector"])
    tree.links.new(pattern.outputs["Color"], ramp.inputs["Fac"])
    return ramp.outputs["Color"]


@pytest.mark.parametrize("kind", ["LINEAR", "EASING", "SPHERICAL"])
def test_a_gradient(ground, render, kind):  # noqa: F811
    tree, background = make_world(ground, (0.0, 0.0, 0.0), 1.5)
    tree.links.new(gradient(tree, kind, (0.0, math.radians(90.0), 0.4)), background.inputs["Color"])
    look_over(ground)
    assert_as_in_cycles(ground, render)
    assert read_scene().warnings == ()


def test_a_mix_of_backgrounds_by_a_texture(ground, render):  # noqa: F811
    tree, background = make_world(ground, (0.1, 0.4, 0.2), 2.0)
    other, mix = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeMixShader")
    other.inputs["Color"].default_value = (0.7, 0.2, 0.6, 1.0)
    tree.links.new(gradient(tree, "LINEAR", (0.2, -0.9, 0.1)), mix.inputs["Fac"])
    tree.links.new(background.outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])
    look_over(ground)
    assert_as_in_cycles(ground, render)


def test_an_image_that_nodes_change(ground, render):  # noqa: F811
    """Moved as well as turned, and tinted."""
    image = bpy.data.images.new("Sky", 64, 32, float_buffer=True)
    compat.set_linear(image)
    pixels = np.ones((32, 64, 4), dtype=np.float32)
    pixels[..., :3] = np.random.default_rng(3).random((32, 64, 3))
    image.pixels.foreach_set(pixels.ravel())
    tree, background = make_world(ground, (0.0, 0.0, 0.0), 0.5)
    places, turn, texture, tint = nodes(tree, "TexCoord", "Mapping", "TexEnvironment", "MixRGB")
    texture.image = image
    turn.inputs["Rotation"].default_value, turn.inputs["Scale"].default_value = (0.3, -0.2, 1.1), (1.0, 1.0, 2.0)
    tint.blend_type, tint.inputs["Fac"].default_value = "MULTIPLY", 1.0
    tint.inputs["Color2"].default_value = (1.0, 0.6, 0.3, 1.0)
    for output, inlet in ((places.outputs["Generated"], turn.inputs["Vector"]),
                          (turn.outputs["Vector"], texture.inputs["Vector"]),
                          (texture.outputs["Color"], tint.inputs["Color1"]),
                          (tint.outputs["Color"], background.inputs["Color"])):
        tree.links.new(output, inlet)
    look_over(ground)
    assert_as_in_cycles(ground, render)


def test_a_changed_node_is_a_changed_world(ground):  # noqa: F811
    tree, background = make_world(ground, (0.0, 0.0, 0.0), 1.0)
    tree.links.new(gradient(tree, "LINEAR", (0.0, 0.0, 0.0)), background.inputs["Color"])
    first, again = (surroundings.read(ground)[0] for _ in range(2))
    assert first == again and first.image is again.image
    background.inputs["Strength"].default_value = 2.0
    assert surroundings.read(ground)[0] != first


def sky(scene, kind, **properties):
    """A world that is a Sky Texture, dim enough for a picture."""
    tree, background = make_world(scene, (0.0, 0.0, 0.0), 0.3)
    node = tree.nodes.new("ShaderNodeTexSky")
    if kind not in {item.identifier for item in node.bl_rna.properties["sky_type"].enum_items}:
        pytest.skip(f"this Blender has no {kind}")
    node.sky_type = kind
    for name, value in properties.items():
        setattr(node, name, value)
    tree.links.new(node.outputs["Color"], background.inputs["Color"])
    return node


@pytest.mark.parametrize(("kind", "properties"), [
    ("NISHITA", {"sun_elevation": 0.5, "sun_rotation": 2.0, "sun_disc": False, "dust_density": 2.0}),
    ("PREETHAM", {"sun_direction": (0.3, 0.6, 0.4), "turbidity": 3.0})])
def test_a_sky(ground, render, kind, properties):  # noqa: F811
    sky(ground, kind, **properties)
    look_over(ground)
    assert_as_in_cycles(ground, render)
    assert read_scene().warnings == ()


def test_the_sun_of_a_sky_is_a_light(ground, render):  # noqa: F811
    sky(ground, "NISHITA", sun_elevation=0.6, sun_rotation=0.8, sun_intensity=0.05)
    assert_as_in_cycles(ground, render)
    assert [type(light).__name__ for light in read_scene().lights] == ["SunValues"]


def test_a_sky_with_noise(ground, render):  # noqa: F811
    """Clouds."""
    tree, background = make_world(ground, (0.0, 0.0, 0.0), 1.0)
    clouds, ramp = nodes(tree, "TexNoise", "ValToRGB")
    clouds.inputs["Scale"].default_value = 3.0
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.1, 0.2, 0.6, 1.0), (1.0, 0.9, 0.8, 1.0)
    tree.links.new(clouds.outputs["Fac"], ramp.inputs["Fac"])
    tree.links.new(ramp.outputs["Color"], background.inputs["Color"])
    look_over(ground)
    assert_as_in_cycles(ground, render)


def for_cameras(tree, background, seen):
    """Gives a world's lights `background`, and its cameras a Background node of the colour `seen`."""
    rays, mix, other = nodes(tree, "LightPath", "MixShader", "Background")
    other.inputs["Color"].default_value = (*seen, 1.0)
    tree.links.new(rays.outputs["Is Camera Ray"], mix.inputs["Fac"])
    tree.links.new(background.outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])


@pytest.mark.parametrize("lit", ["by a colour", "by a gradient", "by nothing"])
def test_a_camera_sees_another_world_than_lights(ground, render, lit):  # noqa: F811
    tree, background = make_world(ground, (0.4, 0.1, 0.2), 0.0 if lit == "by nothing" else 2.0)
    if lit == "by a gradient":
        tree.links.new(gradient(tree, "LINEAR", (0.2, -0.9, 0.1)), background.inputs["Color"])
    for_cameras(tree, background, (0.05, 0.6, 0.3))
    look_over(ground)
    theirs = assert_as_in_cycles(ground, render)
    assert not any("World" in sentence for sentence in read_scene().warnings)
    np.testing.assert_allclose(theirs[0, 0, :3], (0.05, 0.6, 0.3), rtol=1e-3)


def test_a_world_that_is_brighter_to_cameras(ground, render):  # noqa: F811
    """Nodes ask whether a camera looks elsewhere than in a mix of all."""
    tree, background = make_world(ground, (0.4, 0.1, 0.2), 1.0)
    rays, brighter = nodes(tree, "LightPath", "Math")
    brighter.operation = "MULTIPLY_ADD"
    brighter.inputs[1].default_value, brighter.inputs[2].default_value = 3.0, 0.5
    tree.links.new(rays.outputs["Is Camera Ray"], brighter.inputs[0])
    tree.links.new(brighter.outputs[0], background.inputs["Strength"])
    look_over(ground)
    theirs = assert_as_in_cycles(ground, render)
    np.testing.assert_allclose(theirs[0, 0, :3], (1.4, 0.35, 0.7), rtol=1e-3)


def test_what_a_world_is_to_other_rays_is_said(ground):  # noqa: F811
    tree, background = make_world(ground, (0.4, 0.1, 0.2), 1.0)
    [rays] = nodes(tree, "LightPath")
    tree.links.new(rays.outputs["Is Glossy Ray"], background.inputs["Strength"])
    [sentence] = read_scene().warnings
    assert "World 'World'" in sentence and "Is Glossy Ray" in sentence


def hidden_from(world, rays):
    if not hasattr(world, "cycles_visibility"):
        pytest.skip("this Blender's worlds are seen by all rays")
    setattr(world.cycles_visibility, rays, False)


def test_a_world_that_cameras_do_not_see(ground, render):  # noqa: F811
    make_world(ground, (0.4, 0.1, 0.2), 1.0)
    hidden_from(ground.world, "camera")
    look_over(ground)
    theirs = assert_as_in_cycles(ground, render)
    assert theirs[0, 0, :3].max() == 0.0


def test_a_world_that_other_rays_do_not_see_is_said(ground):  # noqa: F811
    make_world(ground, (0.4, 0.1, 0.2), 1.0)
    hidden_from(ground.world, "glossy")
    [sentence] = read_scene().warnings
    assert "World 'World'" in sentence and "glossy rays" in sentence and "left out" in sentence


def test_a_muted_background_lights_nothing(ground, render):  # noqa: F811
    add_light("POINT", (0.4, -0.3, 3.0))
    _, background = make_world(ground, (0.4, 0.1, 0.2), 1.0)
    background.mute = True
    ground.camera.data.ortho_scale = 6.0
    theirs = assert_as_in_cycles(ground, render)
    assert theirs[0, 0, :3].max() == 0.0
