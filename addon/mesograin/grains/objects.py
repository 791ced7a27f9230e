# Grains and piles as Blender's objects, for operators and scripts alike.
import bpy
import numpy as np

from .. import compat
from ..schema import models
from . import kinds, pile

# What a new grain is made of, in 1/mm: where to start from, not measured.
LOOKS = {
    "sand": {"sigma_s": (9.0, 8.2, 6.6), "sigma_a": (0.09, 0.22, 0.62), "eta": 1.54, "roughness": 0.35},
    "salt": {"sigma_s": (1.2, 1.2, 1.2), "sigma_a": (0.001, 0.001, 0.001), "eta": 1.54, "roughness": 0.15},
    "sugar": {"sigma_s": (1.5, 1.5, 1.5), "sigma_a": (0.001, 0.001, 0.002), "eta": 1.56, "roughness": 0.15},
    "snow": {"sigma_s": (2.0, 2.0, 2.0), "sigma_a": (0.0004, 0.0001, 0.0001), "eta": 1.31, "roughness": 0.2},
    "rounded_snow": {"sigma_s": (2.0, 2.0, 2.0), "sigma_a": (0.0004, 0.0001, 0.0001), "eta": 1.31, "roughness": 0.2},
    "rice": {"sigma_s": (3.0, 2.9, 2.6), "sigma_a": (0.01, 0.02, 0.06), "eta": 1.53, "roughness": 0.4},
    "bead": {"sigma_s": (0.4, 0.4, 0.4), "sigma_a": (0.02, 0.01, 0.015), "eta": 1.52, "roughness": 0.05},
}


def mesh(kind, name=None, size=1.0, **habit):
    """bpy.types.Mesh of a grain as large as a ball of radius `size`, smooth, closed, with UVs. habit: as kinds.make."""
    shape = kinds.make(kind, **habit)
    made = bpy.data.meshes.new(name or kind.replace("_", " ").capitalize())
    made.from_pydata((shape.vertices * size).tolist(), [], shape.faces.tolist())
    made.uv_layers.new(name="UVMap").data.foreach_set("uv", shape.uvs.astype(np.float32).ravel())
    made.polygons.foreach_set("use_smooth", np.ones(len(shape.faces), dtype=bool))
    made.update()
    return made


def material(kind, model=models.AUTO.name):
    """A new bpy.types.Material with the looks of a kind."""
    made = bpy.data.materials.new(kind.replace("_", " ").capitalize())
    made.mesograin.model = model
    for parameter, value in LOOKS[kind].items():
        setattr(made.mesograin, parameter, value)
    return made


def add_grain(kind, name=None, size=1.0, **habit):
    """bpy.types.Object of a new grain with a material, in no collection yet."""
    data = mesh(kind, name, size, **habit)
    data.materials.append(material(kind))
    return bpy.data.objects.new(data.name, data)


def add_pile(placings, shapes, name="Pile"):
    """bpy.types.Object, in no collection yet, that holds an instance of one of the objects `shapes`, each as large as
    the unit sphere, at each of pile.Placings: the vertices of its mesh, instanced by geometry nodes. It has the shapes'
    materials, too: nobody would look for them in the collection."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(placings.middles.tolist(), [], [])
    for each in dict.fromkeys(each for shape in shapes for each in shape.data.materials):
        data.materials.append(each)
    for attribute, kind, values in (("turn", "FLOAT_VECTOR", placings.angles), ("size", "FLOAT", placings.radii),
                                    ("shape", "INT", placings.shapes)):
        layer = data.attributes.new(attribute, kind, "POINT")
        layer.data.foreach_set("vector" if kind == "FLOAT_VECTOR" else "value", np.ravel(values).tolist())
    collection = bpy.data.collections.new(f"{name} grains")
    for shape in shapes:
        collection.objects.link(shape)
    made = bpy.data.objects.new(name, data)
    made.modifiers.new("Grains", "NODES").node_group = _instancing(collection)
    return made


def _instancing(collection):
    """A node group that puts an object of a collection at each point, as its attributes say."""
    tree = bpy.data.node_groups.new(collection.name, "GeometryNodeTree")
    compat.add_group_socket(tree, "Geometry", "INPUT", "NodeSocketGeometry")
    compat.add_group_socket(tree, "Geometry", "OUTPUT", "NodeSocketGeometry")
    nodes, links = tree.nodes, tree.links
    begin, end = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    shapes, instances = nodes.new("GeometryNodeCollectionInfo"), nodes.new("GeometryNodeInstanceOnPoints")
    shapes.inputs["Collection"].default_value = collection
    shapes.inputs["Separate Children"].default_value = True
    shapes.inputs["Reset Children"].default_value = True
    instances.inputs["Pick Instance"].default_value = True
    links.new(begin.outputs[0], instances.inputs["Points"])
    links.new(shapes.outputs[0], instances.inputs["Instance"])
    links.new(instances.outputs[0], end.inputs[0])
    for row, (attribute, kind, socket) in enumerate((("shape", "INT", "Instance Index"),
                                                     ("turn", "FLOAT_VECTOR", "Rotation"), ("size", "FLOAT", "Scale"))):
        named = nodes.new("GeometryNodeInputNamedAttribute")
        named.data_type = kind
        named.inputs["Name"].default_value = attribute
        wanted = {"INT": "INT", "FLOAT_VECTOR": "VECTOR", "FLOAT": "VALUE"}[kind]
        links.new(next(output for output in named.outputs if output.type == wanted and output.name == "Attribute"),
                  instances.inputs[socket])
        named.location = (-400.0, -160.0 * row)
    begin.location, shapes.location, end.location = (-400.0, 320.0), (-400.0, 160.0), (220.0, 0.0)
    return tree


def shapes_of(kinds_of_shapes, seed=0, segments=12, angularity=0.5, roundness=0.3):
    """[bpy.types.Object], in no collection yet: a grain of each kind, such as three times "sand", as large as the unit
    sphere, for many instances; those of one kind share a material."""
    # Not AUTO, which goes by what was measured of grains alone.
    shared = {kind: material(kind, models.PREFERRED) for kind in dict.fromkeys(kinds_of_shapes)}
    shapes = []
    for number, kind in enumerate(kinds_of_shapes):
        data = mesh(kind, seed=seed + number, segments=segments, angularity=angularity, roundness=roundness)
        data.materials.append(shared[kind])
        shapes.append(bpy.data.objects.new(data.name, data))
    return shapes


def pile_of(kinds_of_shapes, count, size, name="Pile", seed=0, segments=12, angularity=0.5, roundness=0.3, **settling):
    """The object of add_pile of `count` grains. kinds_of_shapes: the kind of each shape that it has, such as three
    times "sand". size: radius of a ball as large as the mean grain. settling: as pile.settle takes it."""
    fallen = pile.shapes_of(kinds_of_shapes, seed, segments=segments, angularity=angularity, roundness=roundness)
    placings = pile.settle(fallen, count, size, seed=seed, **settling)
    shapes = shapes_of(kinds_of_shapes, seed, segments, angularity, roundness)
    return add_pile(placings, shapes, name)
