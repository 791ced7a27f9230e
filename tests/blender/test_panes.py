# Light through glass that is thin all over: what stands below a pane has as much of a sun as the glass leaves.
import bpy
import numpy as np
import pytest
from mathutils import Matrix
from test_export import add_camera, add_cube, add_sun
from test_heaps import grid, scatter

from mesograin import compat

CLEAR = (0.0, 0.0, 0.0)
GREEN = (8.0, 1.0, 3.0)
THICK = 0.1


def wear(thing, name, **values):
    """A material, a grain's where it has parameters."""
    material = bpy.data.materials.new(name)
    for parameter, value in values.items():
        setattr(material.mesograin, parameter, value)
    thing.data.materials.append(material)
    return material


def dark(thing):
    """Little of what it sends comes back from the glass."""
    material = wear(thing, "Dark")
    compat.use_nodes(material)
    nodes = material.node_tree.nodes
    nodes.clear()
    shader = nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (0.1, 0.1, 0.1, 1.0)
    material.node_tree.links.new(shader.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])


def ground():
    bpy.ops.mesh.primitive_plane_add(size=4.0)
    dark(bpy.context.object)


def sand():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=0.3)
    bpy.ops.object.shade_smooth()
    wear(bpy.context.object, "Sand", model="model_2", boundary="index_matched", sigma_s=(2.0, 2.0, 2.0),
         sigma_a=(6.0, 6.0, 6.0), scale=1.0, g=0.0)


def heap():
    _, grain = scatter([(0.2 * x, 0.2 * y, z) for x, y, z in grid()])
    wear(grain, "Grains", model="lambert", reflectance=(0.1, 0.1, 0.1))


def sugar():
    _, grain = scatter([(0.2 * x, 0.2 * y, z) for x, y, z in grid()])
    wear(grain, "Sugar", model="model_1", boundary="index_matched", sigma_s=(2.0, 2.0, 2.0), sigma_a=(20.0, 20.0, 20.0),
         scale=1.0, g=0.0)


def shine(z, colour, eta=1.5):
    """A sun from straight above on a black world, a pane at this height, and a camera between it and what is below."""
    pane = add_cube("Pane", matrix=Matrix.Translation((0.0, 0.0, z)) @ Matrix.Diagonal((8.0, 8.0, 0.5 * THICK, 1.0)))
    wear(pane, "Glass", model="transport", boundary="dielectric", sigma_s=CLEAR, sigma_a=colour, scale=1.0, eta=eta,
         roughness=0.0)
    add_sun((0.0, 0.0, 1.0), 3.0)
    add_camera((0.0, 0.0, 1.5), lens=60.0)
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 32
    scene.render.resolution_percentage, scene.mesograin.samples = 100, 64


@pytest.mark.parametrize("colour", [CLEAR, GREEN])
@pytest.mark.parametrize("below", [ground, sand, heap, sugar])
def test_a_sun_shines_through_a_pane(render, below, colour):
    below()
    shine(2.5, colour)
    through = render()[..., :3].mean(axis=(0, 1))
    bpy.data.objects.remove(bpy.data.objects["Pane"])
    alone = render()[..., :3].mean(axis=(0, 1))
    # Straight on, of 4 % that each surface reflects, with all reflections between them.
    left = np.exp(-np.array(colour) * bpy.context.scene.mesograin.millimetres_per_unit * THICK)
    passed = 0.96**2 * left / (1.0 - 0.04**2 * left**2)
    # A shadow map, which models with light maps ask, has no colour.
    expected = passed.mean() if below is sand else passed
    assert through / alone == pytest.approx(expected * np.ones(3), rel=0.03, abs=0.005)


@pytest.mark.parametrize("below, within", [(ground, 0.02), (sugar, 0.02), (heap, 0.08)])
def test_what_hardly_refracts_hides_nothing(render, below, within):
    """Of what is opaque, what others see of it is seen: at the pole of a ball under a sun 1/16 too much (its light to
    the second order)."""
    below()
    shine(1.0, CLEAR, eta=1.001)
    through = render()[..., :3]
    bpy.data.objects.remove(bpy.data.objects["Pane"])
    alone = render()[..., :3]
    blocks = [picture.reshape(8, 4, 8, 4, 3).mean(axis=(1, 3)) for picture in (through, alone)]
    assert np.abs(blocks[0] - blocks[1]).sum() < (0.03 + within) * blocks[1].sum()
    assert through.sum() == pytest.approx(alone.sum(), rel=within)
