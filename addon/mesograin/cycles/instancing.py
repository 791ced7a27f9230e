# Many placings of one mesh as a single object that geometry nodes instance: Blender needs a time that grows with the
# square of their number to remove as many objects.
"""See `Heap`."""

import bpy
import numpy

from .. import compat

FROM = 256
"""So many placings of one mesh are a Heap; fewer are objects, which any Blender shows alike to the last bit."""

RIGHT_ANGLE = 1e-5
"""How far the cosine of an angle between axes may be from 0: single precision, in which Blender keeps a matrix."""


class Heap:
    """matrices: (n, 4, 4), object to world, of which geometry nodes can express those that `expressible` tells.
    made: called with each datablock that is new, which belongs to the caller. object: to be linked to a scene."""

    def __init__(self, mesh, matrices, made):
        self.mesh = mesh
        self.matrices = numpy.asarray(matrices, dtype=numpy.float32)
        self._made = made
        prototype = self._own(bpy.data.objects.new("Mesograin prototype", mesh))  # in no scene, so not seen itself
        self.object = self._own(bpy.data.objects.new("Mesograin heap", self._points()))
        modifier = self.object.modifiers.new("Mesograin heap", "NODES")
        modifier.node_group = self._nodes(prototype)

    def _own(self, datablock):
        self._made(datablock)
        return datablock

    def _points(self):
        """A mesh with a vertex for each placing, and its rotation and scale as attributes."""
        rotations, scales = decompose(self.matrices)
        points = self._own(bpy.data.meshes.new("Mesograin heap"))
        points.vertices.add(len(self.matrices))
        points.vertices.foreach_set("co", numpy.ascontiguousarray(self.matrices[:, :3, 3]).ravel())
        for name, vectors in (("rotation", rotations), ("scale", scales)):
            attribute = points.attributes.new(name, "FLOAT_VECTOR", "POINT")
            attribute.data.foreach_set("vector", vectors.astype(numpy.float32).ravel())
        return points

    def _nodes(self, prototype):
        tree = self._own(bpy.data.node_groups.new("Mesograin heap", "GeometryNodeTree"))
        compat.add_group_socket(tree, "Geometry", "INPUT", "NodeSocketGeometry")
        compat.add_group_socket(tree, "Geometry", "OUTPUT", "NodeSocketGeometry")
        points, instances = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
        place, shape = tree.nodes.new("GeometryNodeInstanceOnPoints"), tree.nodes.new("GeometryNodeObjectInfo")
        shape.transform_space = "ORIGINAL"
        shape.inputs["Object"].default_value = prototype
        tree.links.new(points.outputs[0], place.inputs["Points"])
        tree.links.new(shape.outputs["Geometry"], place.inputs["Instance"])
        for name in ("rotation", "scale"):
            attribute = tree.nodes.new("GeometryNodeInputNamedAttribute")
            attribute.data_type = "FLOAT_VECTOR"
            attribute.inputs["Name"].default_value = name
            vector = next(socket for socket in attribute.outputs if socket.enabled and socket.name == "Attribute")
            tree.links.new(vector, place.inputs[name.capitalize()])
        tree.links.new(place.outputs["Instances"], instances.inputs[0])
        return tree


def expressible(matrices):
    """Whether each of (n, 4, 4) matrices is a rotation after a scale along the axes, without shear: (n,) bool."""
    axes = numpy.asarray(matrices, dtype=numpy.float64)[:, :3, :3]
    lengths = numpy.linalg.norm(axes, axis=1)
    cosines = numpy.einsum("nij,nik->njk", axes, axes)[:, (0, 0, 1), (1, 2, 2)]
    products = lengths[:, (0, 0, 1)] * lengths[:, (1, 2, 2)]
    return (lengths > 0.0).all(axis=1) & (numpy.abs(cosines) <= RIGHT_ANGLE * products).all(axis=1)


def decompose(matrices):
    """(rotations, scales), (n, 3) each, of (n, 4, 4) matrices that are `expressible`: R_z R_y R_x diag(scale), as
    Blender's Euler angles of order XYZ have it. A mirrored one has a negative scale along x."""
    axes = numpy.asarray(matrices, dtype=numpy.float64)[:, :3, :3]
    scales = numpy.linalg.norm(axes, axis=1)
    scales[numpy.linalg.det(axes) < 0.0, 0] *= -1.0
    turned = axes / scales[:, None, :]
    across = numpy.hypot(turned[:, 0, 0], turned[:, 1, 0])  # cos y
    locked = across < 1e-6  # x and z turn about the same axis: all of it is x's
    x = numpy.where(locked, numpy.arctan2(-turned[:, 1, 2], turned[:, 1, 1]),
                    numpy.arctan2(turned[:, 2, 1], turned[:, 2, 2]))
    y = numpy.arctan2(-turned[:, 2, 0], across)
    z = numpy.where(locked, 0.0, numpy.arctan2(turned[:, 1, 0], turned[:, 0, 0]))
    return numpy.stack([x, y, z], axis=1), scales
