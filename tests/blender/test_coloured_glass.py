# Glass of a colour, beside Cycles: on average as much of it is left.
import bpy
import numpy as np
import pytest
from mathutils import Vector
from test_export import add_camera, read_scene

from mesograin import compat
from mesograin.scene import coloured_glass

COLOUR = (0.6, 0.85, 1.0)


@pytest.fixture
def glass():
    """Called with what adds an object, which wears it before a camera in an even white world; returns its node."""

    def wear(add, kind="ShaderNodeBsdfGlass"):
        add()
        material = bpy.data.materials.new("Bottle")
        compat.use_nodes(material)
        tree = material.node_tree
        tree.nodes.clear()
        node = tree.nodes.new(kind)
        colour = node.inputs["Color" if "Color" in node.inputs else "Base Color"]
        colour.default_value, node.inputs["IOR"].default_value = (*COLOUR, 1.0), 1.5
        node.inputs["Roughness"].default_value = 0.0
        for name in ("Transmission", "Transmission Weight"):
            if name in node.inputs:
                node.inputs[name].default_value = 1.0
        tree.links.new(node.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
        bpy.context.object.data.materials.append(material)
        scene = bpy.context.scene
        scene.world = bpy.data.worlds.new("White")
        compat.use_nodes(scene.world)
        background = next(each for each in scene.world.node_tree.nodes if each.type == "BACKGROUND")
        background.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        scene.render.resolution_x = scene.render.resolution_y = 32
        scene.render.resolution_percentage, scene.mesograin.samples = 100, 64
        add_camera((0.0, 0.0, 12.0), lens=150.0)
        return node

    return wear


def slab():
    bpy.ops.mesh.primitive_cube_add(size=1.0, scale=(2.0, 2.0, 0.2), rotation=(0.3, 0.2, 0.0))


def ball():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=0.8)


def crystal():
    bpy.ops.mesh.primitive_cube_add(size=1.0, rotation=(0.5, 0.4, 0.3))


@pytest.mark.parametrize("add, kind, within", [
    (slab, "ShaderNodeBsdfGlass", 0.03), (slab, "ShaderNodeBsdfPrincipled", 0.03),
    (slab, "ShaderNodeBsdfRefraction", 0.03), (ball, "ShaderNodeBsdfGlass", 0.03),
    (crystal, "ShaderNodeBsdfGlass", 0.06)])
def test_as_much_is_left_as_in_cycles(glass, render, add, kind, within):
    glass(add, kind)
    ours = render()[..., :3]
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.blur_glossy = 64, False, 0.0
    cycles.max_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 64
    assert ours.mean(axis=(0, 1)) == pytest.approx(render()[..., :3].mean(axis=(0, 1)), rel=within)
    assert ours[16, 16, 0] < 0.7 * ours[16, 16, 2]


def sigma_a():
    return np.array(dict(read_scene().instances[0].material.values)["sigma_a"])


def test_a_larger_ball_absorbs_less_by_the_way(glass):
    glass(ball)
    small = sigma_a()
    bpy.context.object.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    assert sigma_a() == pytest.approx(0.5 * small) and small[0] > small[1] > small[2] == 0.0


def test_instances_absorb_as_objects_do(glass):
    glass(ball)
    alone = sigma_a()
    ball_object = bpy.context.object
    bpy.ops.mesh.primitive_plane_add(size=10.0)
    ground = bpy.context.object
    ball_object.parent = ground
    ground.instance_type = "VERTS"
    bpy.context.view_layer.update()
    found = [dict(each.material.values)["sigma_a"] for each in read_scene().instances if each.name == ball_object.name]
    assert len(found) >= 4 and all(each == pytest.approx(alone) for each in found)


def test_an_open_one_has_no_colour_and_says_so(glass):
    glass(lambda: bpy.ops.mesh.primitive_plane_add(size=2.0))
    assert sigma_a() == pytest.approx(0.0)
    assert any(warning == f"Object '{bpy.context.object.name}' is not closed, so its glass is drawn without its colour."
               for warning in read_scene().warnings)


def test_a_texture_is_said(glass):
    node = glass(ball)
    tree = node.id_data
    tree.links.new(tree.nodes.new("ShaderNodeTexChecker").outputs[0], node.inputs["Color"])
    assert "the texture of its glass" in read_scene().warnings[0]


def test_ways_through_a_slab_go_across_it(glass):
    glass(lambda: bpy.ops.mesh.primitive_cube_add(size=1.0))
    for vertex in bpy.context.object.data.vertices:
        vertex.co *= Vector((100.0, 100.0, 0.1))
    ways = coloured_glass.chords(bpy.context.object, 1.5)
    thick = 0.1 / np.sqrt(1.0 - (1.0 / 1.5)**2)
    assert len(ways) == coloured_glass.RAYS and 0.0999 < np.percentile(ways, 5) and np.percentile(ways, 95) < thick
