# What metal and coats mirror of other objects, against Cycles with one glossy bounce.
import bpy
import numpy as np
import pytest
from mathutils import Matrix
from test_export import add_object, add_sun

from mesograin import compat

SIZE, BLOCK = 80, 8


def principled(name, colour, **inputs):
    material = bpy.data.materials.new(name)
    compat.use_nodes(material)
    node = next(each for each in material.node_tree.nodes if each.type == "BSDF_PRINCIPLED")
    node.inputs["Base Color"].default_value = (*colour, 1.0)
    for socket, value in inputs.items():
        node.inputs[socket].default_value = value
    return material


def matt(name, colour):
    material = bpy.data.materials.new(name)
    compat.use_nodes(material)
    tree = material.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
    node.inputs["Color"].default_value = (*colour, 1.0)
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


def put(operator, material, place, smooth=True, **size):
    getattr(bpy.ops.mesh, f"primitive_{operator}_add")(location=place, **size)
    made = bpy.context.object
    made.data.polygons.foreach_set("use_smooth", [smooth] * len(made.data.polygons))
    made.data.materials.append(material)
    return made


def checkered(first, second):
    material = matt("Checks", first)
    tree = material.node_tree
    checker = tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Color1"].default_value, checker.inputs["Color2"].default_value = (*first, 1.0), (*second, 1.0)
    checker.inputs["Scale"].default_value = 8.0
    node = next(each for each in tree.nodes if each.type == "BSDF_DIFFUSE")
    tree.links.new(checker.outputs["Color"], node.inputs["Color"])
    return material


def stage(of_ball):
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    put("plane", checkered((0.7, 0.6, 0.5), (0.1, 0.15, 0.3)), (0.0, 0.0, 0.0), smooth=False, size=12.0)
    put("uv_sphere", of_ball, (0.0, 0.0, 1.0), segments=64, ring_count=32, radius=1.0)
    put("cube", matt("Red", (0.8, 0.1, 0.05)), (1.7, -0.6, 0.5), smooth=False, size=1.0)
    add_sun((0.5, -0.4, 1.0), 3.0)
    camera = bpy.data.cameras.new("Camera")
    camera.type, camera.ortho_scale = "ORTHO", 2.4
    turn = Matrix.Rotation(1.15, 4, "X")
    scene.camera = add_object("Camera", camera, Matrix.Translation((0.0, 0.0, 1.0)) @ turn @ Matrix.Translation(
        (0.0, 0.0, 8.0)))
    world = scene.world = bpy.data.worlds.new("World")
    compat.use_nodes(world)
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (0.2, 0.3, 0.5, 1.0)


def error_beside_cycles(render):
    scene = bpy.context.scene
    scene.mesograin.samples, scene.mesograin.exchange = 64, "off"
    ours = render()
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = 128, False, False
    cycles.max_bounces = cycles.glossy_bounces = 1
    cycles.diffuse_bounces = cycles.transmission_bounces = 0
    cycles.pixel_filter_type = "BOX"
    theirs = render()

    def blocks(picture):
        shape = (SIZE // BLOCK, BLOCK, SIZE // BLOCK, BLOCK, 3)
        return picture[..., :3].astype(np.float64).reshape(shape).mean(axis=(1, 3))

    error = np.abs(blocks(ours) - blocks(theirs)).sum() / blocks(theirs).sum()
    print(f"error {error:.5f}")
    return error


@pytest.mark.parametrize(("name", "inputs"), [
    ("smooth metal", {"Metallic": 1.0, "Roughness": 0.1}), ("rough metal", {"Metallic": 1.0, "Roughness": 0.5}),
    ("plastic", {"Roughness": 0.2})])
def test_objects_are_mirrored_as_in_cycles(render, name, inputs):
    stage(principled(name, (0.9, 0.8, 0.6), **inputs))
    assert error_beside_cycles(render) < 0.015


def lamp():
    material = bpy.data.materials.new("Lamp")
    compat.use_nodes(material)
    tree = material.node_tree
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value, emission.inputs["Strength"].default_value = (1.0, 0.6, 0.2, 1.0), 4.0
    tree.links.new(emission.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])
    return material


def test_the_faces_of_a_light_are_not_mirrored_twice(render):
    """A shining rectangle is a light, whose highlight on metal is known already."""
    stage(principled("Metal", (0.9, 0.8, 0.6), Metallic=1.0, Roughness=0.5))
    put("plane", lamp(), (-1.4, -1.4, 2.2), smooth=False, size=1.2, rotation=(0.7, -0.7, 0.0))
    assert error_beside_cycles(render) < 0.02


def test_what_shines_is_seen_in_mirrors(render):
    """A ball that shines is no light to others; a mirror shows it."""
    stage(principled("Metal", (0.9, 0.8, 0.6), Metallic=1.0, Roughness=0.2))
    put("uv_sphere", lamp(), (-1.2, -1.6, 1.6), segments=32, ring_count=16, radius=0.4)
    bpy.context.scene.objects["Cube"].hide_render = True
    ours = render()
    ball = ours[SIZE // 3:, : SIZE // 2, :3]
    # Orange, which nothing else here is, in the left of the metal ball.
    assert ((ball[..., 0] > 1.5) & (ball[..., 2] < 0.7 * ball[..., 0])).mean() > 0.01


def test_a_heap_is_seen_in_a_mirror(render):
    """Arrays are met by the same rays."""
    stage(principled("Metal", (0.9, 0.8, 0.6), Metallic=1.0, Roughness=0.15))
    pebble = put("ico_sphere", matt("Pebble", (0.2, 0.6, 0.2)), (0.0, 0.0, 0.0), subdivisions=2, radius=0.2)
    for index in range(24):
        turn = 2.0 * np.pi * index / 24
        add_object(f"Pebble {index}", pebble.data, Matrix.Translation((1.5 * np.cos(turn), 1.5 * np.sin(turn), 0.2)))
    bpy.data.objects.remove(pebble)
    assert error_beside_cycles(render) < 0.02
