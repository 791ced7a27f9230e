# Attributes of objects and of instances, through nested geometry nodes: each grain's colour against Cycles' own.
import bpy
import numpy as np
import pytest
from mathutils import Matrix
from test_colours_of_instances import as_cycles_has_it
from test_export import add_camera, add_cube, add_object, add_sun, read_scene

from mesograin import compat
from mesograin.scene import instance_attributes

SIDE, PIXELS = 10, 6  # grains along each side of the picture, pixels along each side of a grain's place
SIZE = SIDE * PIXELS
SUN = 3.0


def coloured_by(attribute, kind="INSTANCER", output="Color"):
    """A plain material whose colour is an attribute."""
    material = bpy.data.materials.new("Tinted")
    compat.use_nodes(material)
    tree = material.node_tree
    tree.nodes.clear()
    kinds = ("ShaderNodeBsdfDiffuse", "ShaderNodeAttribute", "ShaderNodeOutputMaterial")
    diffuse, node, end = map(tree.nodes.new, kinds)
    node.attribute_type, node.attribute_name = kind, attribute
    tree.links.new(node.outputs[output], diffuse.inputs["Color"])
    tree.links.new(diffuse.outputs[0], end.inputs["Surface"])
    return material


def group(name):
    tree = bpy.data.node_groups.new(name, "GeometryNodeTree")
    compat.add_group_socket(tree, "Geometry", "OUTPUT", "NodeSocketGeometry")
    return tree


def grid(tree, side, width):
    """The geometry of the middles of the places of a square."""
    made = tree.nodes.new("GeometryNodeMeshGrid")
    for axis in "XY":
        made.inputs[f"Vertices {axis}"].default_value = side
        made.inputs[f"Size {axis}"].default_value = width * (side - 1) / side
    return made.outputs[0]


def instanced(tree, points, instance, attribute=None, seed=0):
    """The geometry of instances on points, each with a random colour as its attribute."""
    node = tree.nodes.new("GeometryNodeInstanceOnPoints")
    tree.links.new(points, node.inputs["Points"])
    tree.links.new(instance, node.inputs["Instance"])
    if attribute is None:
        return node.outputs[0]
    store, random = tree.nodes.new("GeometryNodeStoreNamedAttribute"), tree.nodes.new("FunctionNodeRandomValue")
    store.domain, store.data_type, random.data_type = "INSTANCE", "FLOAT_COLOR", "FLOAT_VECTOR"
    store.inputs["Name"].default_value = attribute
    next(each for each in random.inputs if each.name == "Seed").default_value = seed
    value = next(each for each in store.inputs if each.name == "Value" and each.type == "RGBA")
    tree.links.new(next(each for each in random.outputs if each.type == "VECTOR"), value)
    tree.links.new(node.outputs[0], store.inputs["Geometry"])
    return store.outputs[0]


def shape(tree, thing, as_instance):
    node = tree.nodes.new("GeometryNodeObjectInfo")
    node.inputs["Object"].default_value, node.inputs["As Instance"].default_value = thing, as_instance
    return node.outputs["Geometry"]


def scatter(material, levels, as_instance=True, beside=False):
    """Small cubes that fill a picture seen from above, in one level of instances or two. levels: the name of the
    attribute of each, the outermost first, or None. beside: the instancer shows a mesh of its own, too."""
    cube = add_cube("Grain", matrix=Matrix.Diagonal((0.1, 0.1, 0.1, 1.0)) @ Matrix.Translation((90.0, 0.0, 0.0)))
    cube.data.transform(Matrix.Scale(0.8, 4))
    cube.data.materials.append(material)
    tree = group("Scatter")
    last = shape(tree, cube, as_instance)
    scale = tree.nodes.new("GeometryNodeTransform")
    scale.inputs["Scale"].default_value = (0.1,) * 3
    tree.links.new(last, scale.inputs[0])
    last = scale.outputs[0]
    if len(levels) == 2:
        last = instanced(tree, grid(tree, 2, 0.4), last, levels[1], 1)
    last = instanced(tree, grid(tree, SIDE // len(levels), 2.0), last, levels[0])
    join, end = tree.nodes.new("GeometryNodeJoinGeometry"), tree.nodes.new("NodeGroupOutput")
    if beside:
        ground = tree.nodes.new("GeometryNodeMeshGrid")
        tree.links.new(ground.outputs[0], join.inputs[0])
    tree.links.new(last, join.inputs[0])
    tree.links.new(join.outputs[0], end.inputs[0])
    carrier = add_object("Carrier", bpy.data.meshes.new("Carrier"))
    carrier.modifiers.new("Scatter", "NODES").node_group = tree
    add_sun((0.0, 0.0, 1.0), SUN)
    scene = bpy.context.scene
    scene.mesograin.exchange, scene.mesograin.samples = "off", 8
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    add_camera((0.0, 0.0, 5.0), type="ORTHO", ortho_scale=2.0)
    return carrier


def amid_grains(picture):
    """(SIDE, SIDE, 3) of a picture, where no edge is."""
    return picture.reshape(SIDE, PIXELS, SIDE, PIXELS, -1)[:, 2:4, :, 2:4, :3].astype(np.float64).mean(axis=(1, 3))


def factors(parameter="reflectance"):
    """Of the grains of the only heap, laid out as amid_grains."""
    [heap] = read_scene().heaps
    numbers = np.frombuffer(dict(heap.factors)[parameter], dtype=np.float32).reshape(-1, 3)
    places = heap.placings.matrices()[:, :2, 3]
    column, row = ((0.5 * places * (1.0, -1.0) + 0.5) * SIDE).astype(int).T
    found = np.full((SIDE, SIDE, 3), np.nan)
    found[row, column] = numbers
    return found


# How many colours there are: the inner four instances are the same ones wherever they are put.
@pytest.mark.parametrize("levels, colours", [(("tint",), 100), (("tint", None), 25), ((None, "tint"), 4),
                                             (("tint", "tint"), 4)])
@pytest.mark.parametrize("as_instance", [False, True])
def test_each_instance_has_its_own_as_in_cycles(render, levels, colours, as_instance):
    scatter(coloured_by("tint"), levels, as_instance)
    [sentence] = read_scene().warnings
    assert "Add Attribute Reader" in sentence and "'tint'" in sentence
    assert (factors() == 1.0).all()
    assert bpy.ops.mesograin.add_attribute_reader() == {"FINISHED"}
    assert bpy.ops.mesograin.add_attribute_reader() == {"CANCELLED"}, "there is one"
    assert read_scene().warnings == ()
    found = factors()
    assert len(np.unique(found.reshape(-1, 3), axis=0)) == colours
    np.testing.assert_allclose(found * SUN / np.pi, amid_grains(as_cycles_has_it(render)), rtol=2e-3, atol=1e-4)


def test_they_are_drawn_beside_a_mesh_of_the_instancers_own(render):
    carrier = scatter(coloured_by("tint"), ("tint", None), beside=True)
    carrier.matrix_world = Matrix.Rotation(0.5 * np.pi, 4, "Z")
    bpy.ops.mesograin.add_attribute_reader()
    assert read_scene().warnings == ()
    np.testing.assert_allclose(amid_grains(render()), factors() * SUN / np.pi, rtol=5e-3, atol=1e-3)


def test_numbers_are_grey_and_grains_take_them_for_absorption_and_scattering():
    material = bpy.data.materials.new("Sand")
    material.mesograin.model = "model_2"
    settings = material.mesograin_colours
    settings.vary, settings.source = True, "ATTRIBUTE"
    settings.colour_attribute, settings.scattering_attribute = "tint", "density"
    carrier = scatter(material, ("tint",))
    bpy.ops.mesograin.add_attribute_reader()
    carrier["density"] = 2.0
    carrier.update_tag()
    assert factors("sigma_a").std(axis=(0, 1)).min() > 0.1
    assert (factors("sigma_s") == 2.0).all(), "a property of the instancer stands for what instances lack"


def test_a_reader_that_tells_of_others_is_said():
    carrier = scatter(coloured_by("tint"), ("tint",))
    bpy.ops.mesograin.add_attribute_reader()
    reader = next(each for each in bpy.data.objects if instance_attributes.READER in each)
    nodes = reader.modifiers[0].node_group.nodes
    nodes.remove(next(each for each in nodes if each.type == "SEPARATE_GEOMETRY"))
    assert carrier.modifiers and any(reader.name in sentence for sentence in read_scene().warnings)


@pytest.mark.parametrize("output, expected", [("Color", (0.2, 0.4, 0.6)), ("Fac", (0.4, 0.4, 0.4))])
@pytest.mark.parametrize("kind", ["INSTANCER", "OBJECT"])
@pytest.mark.parametrize("of_data", [False, True])
def test_an_objects_property_as_in_cycles(render, kind, of_data, output, expected):
    cube = add_cube("Grain")
    cube.data.materials.append(coloured_by("tint", kind, output))
    (cube.data if of_data else cube)["tint"] = [0.2, 0.4, 0.6]
    [found] = read_scene().instances
    assert dict(found.material.values)["reflectance"] == pytest.approx(expected)
    add_sun((0.0, 0.0, 1.0), SUN)
    add_camera((0.0, 0.0, 5.0), type="ORTHO", ortho_scale=1.0)
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 8
    np.testing.assert_allclose(as_cycles_has_it(render)[4, 4, :3], np.array(expected) * SUN / np.pi, rtol=2e-3)


def test_what_an_object_lacks_is_black_as_in_cycles():
    add_cube("Grain").data.materials.append(coloured_by("tint"))
    [found] = read_scene().instances
    assert dict(found.material.values)["reflectance"] == (0.0, 0.0, 0.0)
