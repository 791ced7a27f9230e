# What Attribute nodes find of an object and of each of an instancer's instances, in the order in which Cycles looks.
import bpy
import numpy as np

from .. import compat

KINDS = ("INSTANCER", "OBJECT")
"""Of Attribute nodes, those that ask for what is the same on all of an instance."""

READER = "mesograin_reads_instances"
"""The custom property of an object that tells, as vertices of its mesh, what geometry nodes gave each instance of
another: Blender tells scripts nothing of it, but its nodes do."""

TELLS = "mesograin_tells_of_instance"
"""The attribute of those vertices of an instancer's own mesh, one for each of its instances, in their order and where
they stand, that bear the same attributes: nodes that leave these need no reader."""

NEITHER = 1.0
"""What stands for an attribute that Blender does not tell."""

SAME_PLACE = 1e-4
"""How far from each other a reader's vertex and an instance's may be, beside how far out the farthest is."""


def key(kind, name):
    """What an attribute is called among node_colours.Places' coordinates."""
    return f"attribute '{name}' of {kind.lower()}s"


def of_datablocks(datablocks, name):
    """RGBA of the first datablock that has a number or up to four of that name, its own or Blender's, else None: as
    BKE_object_dupli_find_rgba_attribute has it."""
    for each in datablocks:
        if each is not None:
            found = _rgba(each.get(name) if name in each.keys() else _resolved(each, name))
            if found is not None:
                return found
    return None


def _resolved(datablock, path):
    try:
        return datablock.path_resolve(path)
    except (ValueError, TypeError):
        return None


def _rgba(value):
    if isinstance(value, bool) or isinstance(value, str) or value is None:
        return None
    if isinstance(value, (int, float)):
        return (float(value),) * 3 + (1.0,)
    try:
        numbers = tuple(value)
    except TypeError:
        return None
    if not 0 < len(numbers) <= 4 or not all(isinstance(number, float) for number in numbers):
        return None
    return numbers + (0.0, 0.0, 0.0, 1.0)[len(numbers):]


def of_object(thing, names):
    """{key: RGBA} of an evaluated object that is no instance. names: (kind, name) pairs."""
    return {key(kind, name): of_datablocks((thing, thing.data), name) or (0.0,) * 4 for kind, name in names}


class Worn:
    """An evaluated shape that is instanced. names: of the attributes of instancers that its materials ask for."""

    def __init__(self, shape, names):
        self.names = frozenset(names)
        data = shape.data
        is_mesh = shape.type == "MESH" and len(data.vertices) > 0
        self.first_vertex = tuple(data.vertices[0].co) if is_mesh else None
        self.own = {name: of_datablocks((shape, data), name) for name in self.names}
        self.hides = frozenset(name for name in self.names if is_mesh and name in data.attributes)


class _Table:
    """What a mesh tells. rows: which instances of the dependency graph its `vertices`, (n,), are, in order."""

    def __init__(self, rows, layers, vertices):
        self.rows, self.layers, self.vertices = rows, layers, vertices

    def values(self, rows, name):
        """(rows that it tells, (n, 4) of these), or None without such an attribute."""
        if name not in self.layers or self.layers[name].data_type not in _FIELDS:
            return None
        told = rows[np.isin(rows, self.rows)]
        return told, _layer(self.layers[name])[self.vertices][np.searchsorted(self.rows, told)]


def of_each(depsgraph, numbers, matrices, shapes, readers):
    """({key: (n, 4) float32}, sentences) of a dependency graph's instances. numbers: which of `shapes`, Worn, each is,
    or a number below 0; matrices: (n, 4, 4) float32; readers: evaluated objects of which `instancer_of` knows one."""
    found = {name: np.zeros((len(numbers), 4), dtype=np.float32) for shape in shapes for name in shape.names}
    readers, sentences = {instancer_of(each): each for each in readers}, []
    parents, of_parent = _parents(depsgraph, numbers, readers)
    asking = _which(shapes, lambda shape: shape.names)
    for number, parent in enumerate(parents):
        rows = np.flatnonzero(of_parent == number)
        if not np.isin(numbers[rows], asking).any():
            continue
        reader = readers.get(parent.original)
        table = (_read(reader, parent, rows, numbers, matrices, shapes) if reader
                 else _told_by_itself(parent, rows, matrices))
        if reader is not None and table is None:
            sentences.append(f"'{reader.name}' tells of other instances than '{parent.name}' shows, so their "
                             "attributes are not known.")
        for name, values in found.items():
            worn = rows[np.isin(numbers[rows], _which(shapes, lambda shape: name in shape.names))]
            if len(worn) and not _fill(values, name, worn, numbers, parent, table, shapes) and reader is None:
                sentences.append(f"Attribute '{name}' of instances of '{parent.name}' is told by a reader alone: add "
                                 "one (Material Properties > Vary Grains > Add Attribute Reader).")
    return {key("INSTANCER", name): values for name, values in found.items()}, sentences


def _parents(depsgraph, numbers, readers):
    """([instancer], (n,) which of these each instance has, or -1). readers: {instancer: reader}."""
    able = [each for each in depsgraph.ids if _may_instance(each) and each not in readers.values()]
    if len(able) == 1:  # asking each instance takes longer than all else
        return able, np.where(numbers >= 0, 0, -1)
    parents, of_parent = {}, np.full(len(numbers), -1, dtype=np.int32)
    for row, each in enumerate(depsgraph.object_instances):
        if numbers[row] >= 0:
            of_parent[row] = parents.setdefault(each.parent, len(parents))
    return list(parents), of_parent


def _may_instance(datablock):
    return isinstance(datablock, bpy.types.Object) and bool(
        datablock.is_instancer or datablock.instance_type != "NONE" or datablock.particle_systems
        or _has_nodes(datablock))


def _which(shapes, are):
    return [number for number, shape in enumerate(shapes) if are(shape)]


def _read(reader, parent, rows, numbers, matrices, shapes):
    """The _Table of an instancer's rows, or None if the reader's vertices lie elsewhere."""
    rows = rows[np.isin(numbers[rows], _which(shapes, lambda shape: shape.first_vertex))]
    mesh = reader.data
    # A mesh of the instancer's own comes before its instances.
    before = int(parent.type == "MESH" and len(parent.data.vertices) > 0)
    if not len(rows) or len(mesh.vertices) != before + len(rows):
        return None
    first = np.array([shape.first_vertex or (0.0,) * 3 for shape in shapes], dtype=np.float32)[numbers[rows]]
    ours = np.einsum("nij,nj->ni", matrices[rows, :3, :3], first) + matrices[rows, :3, 3]
    return _table(rows, mesh, np.arange(before, len(mesh.vertices)), parent, ours)


def _told_by_itself(parent, rows, matrices):
    """The _Table of an instancer whose mesh has vertices that bear TELLS, or None."""
    mesh = parent.data
    if parent.type != "MESH" or TELLS not in mesh.attributes or mesh.attributes[TELLS].domain != "POINT":
        return None
    vertices = np.flatnonzero(_layer(mesh.attributes[TELLS])[:, 0])
    return _table(rows, mesh, vertices, parent, matrices[rows, :3, 3]) if len(vertices) == len(rows) else None


def _table(rows, mesh, vertices, parent, places):
    """The _Table of a mesh in an instancer's coordinates, or None if these vertices lie elsewhere in the world."""
    local = np.empty((len(mesh.vertices), 3), dtype=np.float32)
    mesh.vertices.foreach_get("co", local.ravel())
    to_world = np.array(parent.matrix_world, dtype=np.float32)
    found = local[vertices] @ to_world[:3, :3].T + to_world[:3, 3]
    if not np.allclose(found, places, rtol=0.0, atol=SAME_PLACE * np.abs(places).max()):
        return None
    return _Table(rows, mesh.attributes, vertices)


_FIELDS = {
    "FLOAT": ("value", 1), "INT": ("value", 1), "INT8": ("value", 1), "BOOLEAN": ("value", 1), "FLOAT2": ("vector", 2),
    "FLOAT_VECTOR": ("vector", 3), "FLOAT_COLOR": ("color", 4), "BYTE_COLOR": ("color", 4),
}


def _layer(attribute):
    """(n, 4) float32 of an attribute, as Blender makes colours of it."""
    field, width = _FIELDS[attribute.data_type]
    kind = {"INT": np.int32, "INT8": np.int32, "BOOLEAN": bool}.get(attribute.data_type, np.float32)
    values = np.empty((len(attribute.data), width), dtype=kind)
    attribute.data.foreach_get(field, values.ravel())
    found = np.zeros((len(values), 4), dtype=np.float32)
    found[:, 3] = 1.0
    found[:, :3 if width == 1 else width] = values
    return found


def _fill(values, name, rows, numbers, parent, table, shapes):
    """Writes an attribute of an instancer's rows; False if some may have one that is not known."""
    told = table and table.values(rows, name)
    if told is not None:
        values[told[0]] = told[1]
        rows = np.setdiff1d(rows, told[0])
    own = of_datablocks((parent,), name)
    known = told is not None or table is not None or not _has_nodes(parent)
    for number in set(numbers[rows].tolist()):
        found = own or shapes[number].own[name] or ((0.0,) * 4 if known else (NEITHER,) * 4)
        values[rows[numbers[rows] == number]] = found
    return known


def _has_nodes(thing):
    return any(modifier.type == "NODES" for modifier in thing.modifiers)


def instancer_of(thing):
    """The original object of whose instances an evaluated object tells, or None if it is no reader."""
    if not thing.get(READER):
        return None
    told = next((modifier.node_group for modifier in thing.modifiers if modifier.type == "NODES"), None)
    asked = told and next((node for node in told.nodes if node.type == "OBJECT_INFO"), None)
    about = asked and asked.inputs["Object"].default_value
    return about.original if about is not None else None


def add_reader(instancer):
    """bpy.types.Object, in no collection yet, that tells of an object's instances: a vertex for each mesh among them,
    with the attributes of whatever instances it, the innermost first. It is seen in no render."""
    tree = bpy.data.node_groups.new(f"Attributes of {instancer.name}", "GeometryNodeTree")
    compat.add_group_socket(tree, "Geometry", "OUTPUT", "NodeSocketGeometry")
    kinds = ("GeometryNodeObjectInfo", "GeometryNodeInputIndex", "FunctionNodeBooleanMath",
             "GeometryNodeSeparateGeometry", "GeometryNodeRealizeInstances", "GeometryNodeSeparateComponents",
             "NodeGroupOutput")
    instances, index, is_first, first, realized, meshes, end = map(tree.nodes.new, kinds)
    instances.inputs["Object"].default_value = instancer
    instances.transform_space = "ORIGINAL"
    is_first.operation = "NOT"  # of a vertex's number
    first.domain = "POINT"
    for start, to in ((instances.outputs["Geometry"], first.inputs[0]), (index.outputs[0], is_first.inputs[0]),
                      (is_first.outputs[0], first.inputs["Selection"]), (first.outputs[0], realized.inputs[0]),
                      (realized.outputs[0], meshes.inputs[0]), (meshes.outputs["Mesh"], end.inputs[0])):
        tree.links.new(start, to)
    made = bpy.data.objects.new(tree.name, bpy.data.meshes.new(tree.name))
    made.modifiers.new("Attributes", "NODES").node_group = tree
    made[READER] = True
    made.hide_select = True
    return made
