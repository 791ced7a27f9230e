# Colours that nodes give each instance, against Cycles and against exact colours.
import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector
from test_export import add_camera, add_cube, add_object, add_sun, read_scene

from mesograin import compat

SIZE = 96


def coloured_by(output, ramp=True):
    """A plain material whose colour is made of Object Info's output."""
    material = bpy.data.materials.new("Sand")
    compat.use_nodes(material)
    tree = material.node_tree
    tree.nodes.clear()
    kinds = ("ShaderNodeBsdfDiffuse", "ShaderNodeObjectInfo", "ShaderNodeOutputMaterial")
    diffuse, info, end = map(tree.nodes.new, kinds)
    tree.links.new(diffuse.outputs[0], end.inputs["Surface"])
    source = info.outputs[output]
    if ramp:
        node = tree.nodes.new("ShaderNodeValToRGB")
        node.color_ramp.elements[0].color = (0.8, 0.5, 0.2, 1.0)
        node.color_ramp.elements[1].color = (0.1, 0.2, 0.4, 1.0)
        node.color_ramp.elements.new(0.5).color = (0.7, 0.7, 0.1, 1.0)
        tree.links.new(source, node.inputs["Fac"])
        source = node.outputs["Color"]
    tree.links.new(source, diffuse.inputs["Color"])
    return material


def heap(material, side=16):
    """Cubes at the vertices of a grid, seen from above."""
    row = [(number + 0.5) * 2.0 / side - 1.0 for number in range(side)]
    places = [(x, y, 0.0) for x in row for y in row]
    mesh = bpy.data.meshes.new("Places")
    mesh.from_pydata(places, [], [])
    carrier = add_object("Places", mesh)
    carrier.instance_type = "VERTS"
    cube = add_cube("Grain")
    cube.scale = (0.05,) * 3
    cube.parent = carrier
    cube.data.materials.append(material)
    add_sun((0.2, 0.1, 1.0), 3.0)
    scene = bpy.context.scene
    scene.mesograin.exchange = "off"  # direct light is what colours are compared in
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    add_camera((0.0, 0.0, 5.0), type="ORTHO", ortho_scale=2.0)
    return cube


def as_cycles_has_it(render):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.max_bounces = 32, 0
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.cycles.pixel_filter_type = "BOX"
    return render()


def difference(ours, theirs):
    """Relative L1 in blocks of one cube each."""
    def blocks(picture):
        return picture[..., :3].astype(np.float64).reshape(16, 6, 16, 6, 3).mean(axis=(1, 3))

    return np.abs(blocks(ours) - blocks(theirs)).sum() / blocks(theirs).sum()


def test_random_along_a_ramp_is_each_cubes_own(render):
    heap(coloured_by("Random"))
    bpy.context.scene.mesograin.samples = 32
    [values] = read_scene().heaps
    assert len(values) == 256
    assert not any("Sand" in warning for warning in read_scene().warnings)
    factors = np.frombuffer(dict(values.factors)["reflectance"], dtype=np.float32).reshape(-1, 3)
    assert len(np.unique(factors, axis=0)) > 200
    ours = render()
    error = difference(ours, as_cycles_has_it(render))
    print(f"classes against Cycles {error:.4f}")
    assert error <= 0.03  # of 32 classes of colour, in blocks of one cube each


def test_objects_of_their_own_are_exact(render):
    material = coloured_by("Random")
    cube = heap(material)
    places = [vertex.co.copy() for vertex in cube.parent.data.vertices]
    bpy.data.objects.remove(cube.parent)
    for number, place in enumerate(places[:40]):
        made = bpy.data.objects.new(f"Grain {number}", cube.data)
        made.matrix_world = Matrix.Translation(place) @ Matrix.Diagonal(Vector((0.05, 0.05, 0.05, 1.0)))
        bpy.context.scene.collection.objects.link(made)
    bpy.data.objects.remove(cube)
    bpy.context.scene.mesograin.samples = 32
    ours = render()
    theirs = as_cycles_has_it(render)
    # Amid each cube, where no edge is.
    amid = np.s_[2::6, 2::6, :3]
    assert (theirs[amid] > 0.0).any()
    np.testing.assert_allclose(ours[amid], theirs[amid], rtol=2e-3, atol=1e-4)


def test_an_objects_own_colour():
    material = coloured_by("Color", ramp=False)
    for number, colour in enumerate(((0.1, 0.2, 0.3), (0.7, 0.5, 0.4))):
        cube = add_cube(f"Cube {number}")
        cube.data.materials.append(material)
        cube.color = (*colour, 1.0)
    found = sorted(dict(each.material.values)["reflectance"] for each in read_scene().instances)
    assert found == [pytest.approx((0.1, 0.2, 0.3)), pytest.approx((0.7, 0.5, 0.4))]


def test_grains_take_absorption_from_nodes():
    material = coloured_by("Random")
    material.mesograin.model = "model_2"
    material.mesograin_colours.vary, material.mesograin_colours.source = True, "NODES"
    heap(material)
    [values] = read_scene().heaps
    factors = np.frombuffer(dict(values.factors)["sigma_a"], dtype=np.float32).reshape(-1, 3)
    assert len(factors) == 256 and factors.std(axis=0).min() > 0.05
    assert factors.min() >= 0.1 - 1e-3 and factors.max() <= 0.8 + 1e-3


def test_an_attribute_of_the_geometry_is_said():
    material = bpy.data.materials.new("Painted")
    compat.use_nodes(material)
    tree = material.node_tree
    attribute = tree.nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = "tint"
    principled = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    tree.links.new(attribute.outputs["Color"], principled.inputs["Base Color"])
    add_cube().data.materials.append(material)
    add_sun((0.0, 0.0, 1.0), 3.0)
    [sentence] = read_scene().warnings
    assert "Material 'Painted'" in sentence and "attribute 'tint'" in sentence
