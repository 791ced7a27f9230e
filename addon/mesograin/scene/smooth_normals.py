# Normals of smooth vertices, summed in one order: Blender sums them in threads, so that its last digit comes and goes.
"""See `settle`."""
import numpy as np

SAME = 1e-4
"""A corner's normal this near to its vertex' is the vertex'. Blender's threads move it by some 1e-7."""


CHUNK = 1 << 17
"""Faces at a time: what is computed of a corner takes twenty times the memory of what is kept."""


def settle(mesh, normals):
    """The corner normals of a mesh with those of smooth vertices replaced by equal ones that are the same every time;
    normals of flat faces, of sharp edges and the user's own stay. normals: (loops, 3) float32."""
    if not len(mesh.loops):
        return normals
    settled = _of_vertices(mesh)
    same = np.abs(settled - normals).max(axis=1) < SAME
    found = np.where(same[:, None], settled, normals)
    # Where faces fold back on each other their normals cancel, and Blender 5 has none for the vertex.
    lost = ~found.any(axis=1)
    if lost.any():
        found[lost] = _of_faces(mesh)[lost]
    return found


def _of_faces(mesh):
    """(loops, 3) float32: for each corner the normal of its face."""
    first, count, normals = _faces(mesh)
    found = np.empty((len(mesh.loops), 3), dtype=np.float32)
    found[np.repeat(first, count) + _numbers(count)] = np.repeat(normals, count, axis=0)
    return found


def _of_vertices(mesh):
    """(loops, 3) float32: for each corner the normal of its vertex, the mean of the faces' weighted by their angles
    there, as Blender defines it."""
    positions = _read(mesh.vertices, "co", (len(mesh.vertices), 3), np.float32).astype(np.float64)
    vertex = _read(mesh.loops, "vertex_index", len(mesh.loops), np.int32)
    first, count, face_normals = _faces(mesh)

    sums = np.zeros_like(positions)
    for start in range(0, len(first), CHUNK):
        faces = slice(start, start + CHUNK)
        _add_faces(sums, positions, vertex, first[faces], count[faces], face_normals[faces])
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    return (sums / np.where(length > 0.0, length, 1.0)).astype(np.float32)[vertex]


def _add_faces(sums, positions, vertex, first, count, face_normals):
    """Adds the faces' normals, weighted by their angles there, to the sums of their vertices."""
    # Faces in the order of their corners, so that corners can be counted on.
    face = np.repeat(np.arange(len(first)), count)
    corner = _numbers(count)
    loop, size = first[face] + corner, count[face]
    here = positions[vertex[loop]]
    after = positions[vertex[first[face] + (corner + 1) % size]] - here
    before = positions[vertex[first[face] + (corner - 1) % size]] - here
    sine = np.linalg.norm(np.cross(after, before), axis=1)
    angle = np.arctan2(sine, np.einsum("ij,ij->i", after, before))

    at = vertex[loop]
    for axis in range(3):
        sums[:, axis] += np.bincount(at, angle * face_normals[face, axis], len(positions))


def _faces(mesh):
    """(first loops, numbers of loops, normals)."""
    size = len(mesh.polygons)
    return (_read(mesh.polygons, "loop_start", size, np.int32), _read(mesh.polygons, "loop_total", size, np.int32),
            _read(mesh.polygons, "normal", (size, 3), np.float32))


def _numbers(count):
    """Of the corners of faces of so many, each from 0 on."""
    return np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)


def _read(collection, attribute, shape, dtype):
    values = np.empty(shape, dtype=dtype)
    collection.foreach_get(attribute, values.ravel())
    return values
