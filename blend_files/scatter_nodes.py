# The node group of the asset library that strews grains over a surface, each turned, sized and coloured by a seed.
"""See `make`. It is made with the oldest Blender served; later ones convert it as they open the file."""
import math

import bpy
from mesograin.scene.instance_attributes import TELLS

COLOUR = "grain_colour"
"""The attribute of each instance by which materials tell grains apart: factors around 1."""

# Name, kind of socket, default, least, most, what it does.
INPUTS = (
    ("Grains", "NodeSocketCollection", None, None, None, "The shapes that are strewn; a Mesograin collection of the "
                                                         "asset library, or one of your own"),
    ("Density", "NodeSocketFloat", 200.0, 0.0, 1e6, "How many grains lie on a square of one unit, at most"),
    ("Size", "NodeSocketFloatDistance", 0.05, 0.0, 1e4, "The mean grain's radius, of shapes like a unit ball"),
    ("Size Spread", "NodeSocketFloatFactor", 0.3, 0.0, 0.95, "How far sizes differ from the mean one"),
    ("Spacing", "NodeSocketFloat", 0.9, 0.0, 100.0, "How near grains come to each other; at 1 two mean ones touch"),
    ("Lift", "NodeSocketFloat", 0.7, -10.0, 10.0, "How far above the surface a grain's middle is, in its own radii"),
    ("Turn", "NodeSocketFloatFactor", 1.0, 0.0, 1.0, "How far grains are turned, all ways alike; at 0 none is"),
    ("Colour Spread", "NodeSocketFloatFactor", 0.5, 0.0, 1.0, "How far the colours of grains differ, as the attribute "
                                                              f"{COLOUR} of each: what absorption is multiplied by"),
    ("Seed", "NodeSocketInt", 0, 0, 1 << 20, "Another seed is another day on the beach"),
    ("Show Surface", "NodeSocketBool", True, None, None, "Whether the surface itself is seen below its grains"),
)
SHARE_OF_ALL = 0.75
"""Of the spread of colours, what a grain's three channels have in common: it is lighter or darker; the rest is hue."""


class _Tree:
    """Nodes by their types, linked by names; the first output or input of that name that is in use."""

    def __init__(self, name):
        self.tree = bpy.data.node_groups.new(name, "GeometryNodeTree")
        self.columns = 0

    def node(self, kind, inputs=None, **properties):
        made = self.tree.nodes.new(kind)
        made.location = (220.0 * self.columns, 0.0)
        self.columns += 1
        for name, value in properties.items():
            setattr(made, name, value)
        for name, value in (inputs or {}).items():
            socket = name if not isinstance(name, (str, int)) else self.socket(made.inputs, name)
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            else:
                socket.default_value = value
        return made

    @staticmethod
    def socket(sockets, name):
        return sockets[name] if isinstance(name, int) else next(
            socket for socket in sockets if socket.name == name and socket.enabled)

    def out(self, kind, inputs=None, output=0, **properties):
        made = self.node(kind, inputs, **properties)
        used = [socket for socket in made.outputs if socket.enabled]
        return used[output] if isinstance(output, int) else self.socket(made.outputs, output)

    def math(self, operation, *values):
        return self.out("ShaderNodeMath", dict(enumerate(values)), operation=operation)

    def random(self, seed, least, most, kind="FLOAT"):
        return self.out("FunctionNodeRandomValue", {"Min": least, "Max": most, "Seed": seed}, data_type=kind)

    def vector(self, x, y, z):
        return self.out("ShaderNodeCombineXYZ", {0: x, 1: y, 2: z})

    def vector_math(self, operation, *values):
        return self.out("ShaderNodeVectorMath", dict(enumerate(values)), operation=operation)


def make(name, collection):
    """The node group. collection: that it strews if nobody chooses another."""
    t = _Tree(name)
    t.tree.inputs.new("NodeSocketGeometry", "Surface")
    t.tree.outputs.new("NodeSocketGeometry", "Geometry")
    for title, kind, default, least, most, sentence in INPUTS:
        socket = t.tree.inputs.new(kind, title)
        socket.description = sentence
        socket.default_value = collection if kind == "NodeSocketCollection" else default
        if least is not None:
            socket.min_value, socket.max_value = least, most
    given = t.node("NodeGroupInput").outputs

    def seed(number):
        return t.math("ADD", given["Seed"], float(number))

    apart = t.math("MULTIPLY", t.math("MULTIPLY", given["Size"], given["Spacing"]), 2.0)
    # What was strewn on the surface before is left alone: else grains were strewn on each of those grains.
    before = t.node("GeometryNodeSeparateComponents", {"Geometry": given["Surface"]}).outputs
    strewn = t.node("GeometryNodeDistributePointsOnFaces", {
        "Mesh": before["Mesh"], "Distance Min": apart, "Density Max": given["Density"], "Seed": given["Seed"]},
        distribute_method="POISSON")
    spread = given["Size Spread"]
    size = t.math("MULTIPLY", given["Size"], t.random(seed(1), t.math("SUBTRACT", 1.0, spread),
                                                      t.math("ADD", 1.0, spread)))
    lift = t.out("ShaderNodeVectorMath", {
        0: strewn.outputs["Normal"], "Scale": t.math("MULTIPLY", size, given["Lift"])}, operation="SCALE")
    # What a field says of random numbers goes by points, and is the same before and after they move.
    lifted = t.out("GeometryNodeSetPosition", {"Geometry": strewn.outputs["Points"], "Offset": lift})
    coloured = t.out("GeometryNodeStoreNamedAttribute", {
        "Geometry": lifted, "Name": COLOUR, "Value": _colour(t, given["Colour Spread"], seed)},
        data_type="FLOAT_COLOR", domain="POINT")
    shapes = t.out("GeometryNodeCollectionInfo", {
        "Collection": given["Grains"], "Separate Children": True, "Reset Children": True})
    # Numbers beyond the last shape begin anew.
    which = t.random(seed(5), 0, 1 << 16, "INT")
    grains = t.out("GeometryNodeInstanceOnPoints", {
        "Points": coloured, "Instance": shapes, "Pick Instance": True, "Instance Index": which,
        "Rotation": _turned(t, given["Turn"], seed), "Scale": size})
    surface = t.node("GeometryNodeSwitch", input_type="GEOMETRY")
    t.tree.links.new(given["Show Surface"], next(each for each in surface.inputs if each.enabled))
    t.tree.links.new(given["Surface"], t.socket(surface.inputs, "True"))
    faceless = t.out("GeometryNodeDeleteGeometry", {"Geometry": before["Mesh"]}, domain="FACE", mode="EDGE_FACE")
    hidden = t.node("GeometryNodeJoinGeometry")
    for part in (before["Instances"], faceless):
        t.tree.links.new(part, hidden.inputs[0])
    t.tree.links.new(hidden.outputs[0], t.socket(surface.inputs, "False"))
    joined = t.node("GeometryNodeJoinGeometry")
    end = t.node("NodeGroupOutput")
    # Scripts are told the attributes of vertices, not of instances.
    telling = t.out("GeometryNodeStoreNamedAttribute", {
        "Geometry": t.out("GeometryNodePointsToVertices", {"Points": coloured}), "Name": TELLS, "Value": True},
        data_type="BOOLEAN", domain="POINT")
    for part in (grains, telling, t.socket(surface.outputs, "Output")):
        t.tree.links.new(part, joined.inputs[0])
    t.tree.links.new(joined.outputs[0], end.inputs[0])
    return t.tree


def _turned(t, turn, seed):
    """Euler angles of rotations that are evenly spread: the sine of the middle one is."""
    whole = t.math("MULTIPLY", turn, 2.0 * math.pi)
    middle = t.math("MULTIPLY", turn, t.math("ARCSINE", t.random(seed(3), -1.0, 1.0), 0.0))
    return t.vector(t.random(seed(2), 0.0, whole), middle, t.random(seed(4), 0.0, whole))


def _colour(t, spread, seed):
    """Three factors around 1, within `spread` of it."""
    all_alike = t.math("MULTIPLY", spread, SHARE_OF_ALL)
    own = t.math("MULTIPLY", spread, 1.0 - SHARE_OF_ALL)
    shade = t.random(seed(6), t.math("SUBTRACT", 1.0, all_alike), t.math("ADD", 1.0, all_alike))
    least, most = t.math("MULTIPLY", own, -1.0), own
    hue = t.random(seed(7), t.vector(least, least, least), t.vector(most, most, most), "FLOAT_VECTOR")
    return t.vector_math("ADD", hue, t.vector(shade, shade, shade))
