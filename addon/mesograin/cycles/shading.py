# Faces that are smooth and others that are flat: Cycles tells those of one material apart, so that light which has come
# into a volume by one kind never leaves it by the other.
import numpy

from .. import compat


def both_ways(mesh):
    """Whether a bpy.types.Mesh has faces of both kinds."""
    smooth = _smooth(mesh)
    return bool(smooth.any() and not smooth.all())


def shade_alike(mesh):
    """Makes all faces of a bpy.types.Mesh smooth if it has both kinds, with the normals that they had."""
    if not both_ways(mesh):
        return
    compat.calculate_corners(mesh)
    normals = compat.corner_normals(mesh)
    mesh.polygons.foreach_set("use_smooth", numpy.ones(len(mesh.polygons), dtype=bool))
    compat.bend_corner_normals(mesh, normals)


def _smooth(mesh):
    smooth = numpy.empty(len(mesh.polygons), dtype=bool)
    mesh.polygons.foreach_get("use_smooth", smooth)
    return smooth
