"""What stands in the places of a heap's balls: a mesh in the unit sphere for each kind of grain, and its turn."""
import math

import numpy
import shape_pictures
from frame import sphere

# Of a side of a cube that is blown up to a grain: no more than is seen of one that is ten pixels wide.
SEGMENTS = 10
RESHAPED = {"flakes": lambda: shape_pictures.cubed_sphere(lambda places: places * (1.0, 1.0, 0.2), SEGMENTS),
            "rice": lambda: shape_pictures.cubed_sphere(lambda places: places * (0.333, 0.333, 1.0), SEGMENTS),
            "peanuts": lambda: shape_pictures.peanut(SEGMENTS), "sand": lambda: shape_pictures.sand(SEGMENTS)}
GRAINS = ["balls", "cubes", *RESHAPED]


def mesh(native, grains):
    """The native.Mesh of one of GRAINS."""
    if grains == "balls":
        _, normals, triangles = sphere()
        return native.Mesh(normals, normals, triangles)
    return native.Mesh(*(cube() if grains == "cubes" else faceted(*RESHAPED[grains]())))


def faceted(vertices, triangles):
    """As far out as the unit sphere, of flat triangles, as the referee sees them."""
    corners = (vertices / numpy.linalg.norm(vertices, axis=1).max())[triangles]
    normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = numpy.repeat(normals / numpy.linalg.norm(normals, axis=1, keepdims=True), 3, axis=0)
    return (corners.reshape(-1, 3).astype(numpy.float32), normals.astype(numpy.float32),
            numpy.arange(len(normals), dtype=numpy.uint32).reshape(-1, 3))


def turns(count):
    """(count, 3, 3): any way round, the same ever again."""
    quaternions = numpy.random.default_rng(1).normal(size=(4, count))
    w, x, y, z = quaternions / numpy.linalg.norm(quaternions, axis=0)
    return numpy.stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w),
                        2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w),
                        2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
                       -1).reshape(count, 3, 3)


def cube():
    """Corners in the unit sphere, normals and triangles, of flat faces."""
    corners, normals, triangles = [], [], []
    for axis in range(3):
        for side in (-1.0, 1.0):
            normal, along = side * numpy.eye(3)[axis], numpy.eye(3)[(axis + 1) % 3]
            across = numpy.cross(normal, along)
            first = len(corners)
            corners += [(normal + a * along + b * across) / math.sqrt(3.0)
                        for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            normals += [normal] * 4
            triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return (numpy.array(corners, numpy.float32), numpy.array(normals, numpy.float32),
            numpy.array(triangles, numpy.uint32))
