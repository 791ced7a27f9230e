# Evaluated Blender geometry as native meshes, one for each material; what did not change is neither read nor sent.
import hashlib
import math
import typing
import weakref

import numpy as np

from .. import compat, native_module
from . import smooth_normals

DRAWABLE_TYPES = ("MESH", "CURVE", "SURFACE", "FONT", "META")


def is_shape(thing):
    """Whether an object among a dependency graph's instances is to be drawn. Blender lists text, curves and metaballs
    twice, as themselves and as the mesh that they become, and Blender 3.4 crashes where it is to copy the latter."""
    return thing.type in DRAWABLE_TYPES and (thing.type != "MESH" or thing.original.type not in DRAWABLE_TYPES[1:])


def is_drawn(thing, matrix_world):
    """Whether one of a dependency graph's instances is drawn where its matrix puts it, if it has faces."""
    return is_shape(thing) and has_extent(matrix_world) and is_finite(matrix_world)


def used_slots(shape, count):
    """Numbers of the slots, of so many that an object has, that faces of its data have: those beyond the last have the
    last. Of what has no faces to ask (curves, text, metaballs), all."""
    polygons = getattr(shape, "polygons", None)
    if polygons is None:
        return list(range(max(count, 1)))
    slots = np.empty(len(polygons), dtype=np.int32)
    polygons.foreach_get("material_index", slots)
    return np.unique(np.clip(slots, 0, max(count - 1, 0))).tolist()


def slots_worn(evaluated_object, override=None):
    """For each slot of an object, the first one with the same material, so that what looks the same is one body; () if
    it has none. override: a bpy.types.Material that a view layer puts in place of all."""
    first = {}
    return tuple(first.setdefault(override or slot.material, number)
                 for number, slot in enumerate(evaluated_object.material_slots))


def slots_of_faces(named, worn):
    """What faces that name slots, integers (n,), have of `slots_worn`; those beyond the last have the last, as in
    Blender and Cycles."""
    return np.array(worn or (0,), dtype=np.int32)[np.clip(named, 0, max(len(worn) - 1, 0))]


THINNEST = 1e-7
"""How short an object's shortest axis may be beside its longest: single precision tells no more apart."""


def has_extent(matrix_world):
    """Whether an object is not scaled to nothing along any axis; Cycles ends Blender at one that is."""
    lengths = [abs(length) for length in matrix_world.to_scale()]
    return matrix_world.determinant() != 0.0 and not min(lengths) < THINNEST * max(lengths)


def scale(matrix_world):
    """How many times as large an object is as its mesh, on average over its axes."""
    return abs(matrix_world.determinant()) ** (1.0 / 3.0)


def is_finite(matrix_world):
    """Whether an object's place, rotation and scale are numbers."""
    return math.isfinite(sum(sum(row) for row in matrix_world))


class MeshPart(typing.NamedTuple):
    """The triangles of one material; `slot` is the first that has it, `mesh` a native Mesh, which equal parts share.
    has_area: of any triangle. broken_uvs: whether there were UVs, but some that are no numbers; the mesh then has none.
    is_cut: whether it goes on in another part. vertices: (n,) uint32, of each of the mesh's positions the number of its
    vertex."""

    slot: int
    mesh: object
    has_area: bool
    broken_uvs: bool
    is_cut: bool
    vertices: object

    def bodies(self, copies=True):
        """[(native.Mesh, (m, 4, 4) float64)] of a mesh of many grains, or of one that is inside out, as
        native.Mesh.bodies has it."""
        known = _bodies.setdefault(self.mesh, {})
        if copies not in known:
            known[copies] = self.mesh.bodies(self.vertices, copies)
        return known[copies]


# Equal content is one native mesh, wherever it comes from: undo, a second viewport or a final render resend nothing.
# Blender sums normals in any order of its threads, so their last digits differ from one evaluation to the next.
NORMAL_TOLERANCE = 1e-5
_by_content = weakref.WeakValueDictionary()
_normals = weakref.WeakKeyDictionary()
_bodies = weakref.WeakKeyDictionary()  # {native.Mesh: {copies: MeshPart.bodies}}


class MeshCache:
    """What one engine has read. Addresses of evaluated data serve as keys, so `forget` must be called whenever Blender
    may have replaced any of it: on a geometry update, on undo and redo, and when a file is loaded."""

    def __init__(self):
        self._by_address = {}

    def forget(self):
        self._by_address.clear()

    def parts(self, evaluated_object, override=None):
        """The MeshParts of an evaluated object, none if it has no faces. override: as of `slots_worn`. Raises
        native.Error naming the object if its coordinates are not finite."""
        worn = slots_worn(evaluated_object, override)
        key = (*_address(evaluated_object), worn)
        if key not in self._by_address:
            self._by_address[key] = _read_object(evaluated_object, worn)
        return self._by_address[key]


def _address(evaluated_object):
    # A mesh carries its modifiers' result; curves, text and metaballs are turned into one object by object.
    data = evaluated_object.data.as_pointer()
    return (data,) if evaluated_object.type == "MESH" else (data, evaluated_object.original.as_pointer())


def _read_object(evaluated_object, worn):
    mesh = evaluated_object.to_mesh()
    if mesh is None:
        return ()
    try:
        return _read_mesh(mesh, evaluated_object.name, worn)
    finally:
        evaluated_object.to_mesh_clear()


def _read_mesh(mesh, name, worn):
    if not mesh.polygons:
        return ()
    compat.calculate_corners(mesh)
    corners, vertices, of_loop, broken_uvs = _corners(mesh)
    triangles = np.empty((len(mesh.loop_triangles), 3), dtype=np.int32)
    mesh.loop_triangles.foreach_get("loops", triangles.ravel())
    triangles = of_loop[triangles]
    slots = np.empty(len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("material_index", slots)
    slots = slots_of_faces(slots, worn)
    used = np.unique(slots)
    if len(used) == 1:
        return (_part(name, used[0], corners, vertices, triangles, broken_uvs),)
    parts = []
    for slot, is_cut in zip(used, _are_cut(mesh, slots, used)):
        kept, compact = np.unique(triangles[slots == slot], return_inverse=True)
        kept_corners = [None if array is None else array[kept] for array in corners]
        parts.append(_part(name, slot, kept_corners, vertices[kept], compact.reshape(-1, 3), broken_uvs, is_cut))
    return tuple(parts)


def _part(name, slot, corners, vertices, triangles, broken_uvs, is_cut=False):
    mesh = _native_mesh(name, corners, vertices, triangles)
    return MeshPart(int(slot), mesh, _has_area(corners[0], triangles), broken_uvs, is_cut, vertices)


def _are_cut(mesh, slots, used):
    """Of each slot in use, whether its triangles share vertices with another's."""
    vertices = np.empty((len(mesh.loop_triangles), 3), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", vertices.ravel())
    of_slots = [np.unique(vertices[slots == slot]) for slot in used]
    shared = np.bincount(np.concatenate(of_slots)) > 1
    return [bool(shared[each].any()) for each in of_slots]


def _has_area(positions, triangles):
    # Nearly always one of the first has, so that the rest need not be looked at.
    for some in (triangles[:64], triangles[64:]):
        first, second, third = (positions[some[:, corner]].astype(np.float64) for corner in range(3))
        if np.cross(second - first, third - first).any():
            return True
    return False


def _corners(mesh):
    """((positions, normals, UVs or None), vertices, rows, broken), one row for each corner that differs from its
    vertex' first one: flat faces and UV seams share no rows. vertices: which one each row is of. rows: which one each
    loop has. broken: as a MeshPart's `broken_uvs`."""
    positions = np.empty((len(mesh.vertices), 3), dtype=np.float32)
    mesh.vertices.foreach_get("co", positions.ravel())
    vertex_of_corner = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", vertex_of_corner)
    layer = next((layer for layer in mesh.uv_layers if layer.active_render), None)
    uvs = None
    if layer is not None:
        uvs = np.empty((len(mesh.loops), 2), dtype=np.float32)
        layer.data.foreach_get("uv", uvs.ravel())
    # Only a bake needs them, and says so; a picture does not.
    broken = uvs is not None and not np.isfinite(uvs).all()
    if broken:
        uvs = None
    normals = smooth_normals.settle(mesh, compat.corner_normals(mesh))
    kept, of_loop = _weld(vertex_of_corner, normals, uvs)
    vertices = vertex_of_corner[kept]
    corners = (positions[vertices], normals[kept], None if uvs is None else uvs[kept])
    return corners, vertices.astype(np.uint32), of_loop, broken


def _weld(vertex, *values):
    """(the corners to keep, which of these each corner is). vertex: of each corner. values: arrays with a row for each
    corner, or None."""
    numbers = np.arange(len(vertex), dtype=np.int32)
    first = np.zeros(vertex.max() + 1, dtype=np.int32)
    first[vertex[::-1]] = numbers[::-1]  # the last one written stays
    twin = first[vertex]
    same = np.ones(len(vertex), dtype=bool)
    for array in values:
        if array is not None:
            same &= (array == array[twin]).all(axis=1)
    same &= twin != numbers
    position = np.cumsum(~same, dtype=np.int32) - 1
    return np.flatnonzero(~same), position[np.where(same, twin, numbers)]


def _native_mesh(name, corners, vertices, triangles):
    native = native_module.get()
    positions, normals, uvs = corners
    triangles = np.ascontiguousarray(triangles, dtype=np.uint32)
    digest = hashlib.blake2b(digest_size=16)
    for array in (positions, uvs, vertices, triangles):
        digest.update(b"none" if array is None else np.ascontiguousarray(array))
    key = digest.digest()
    mesh = _by_content.get(key)
    if mesh is None or not np.allclose(_normals[mesh], normals, rtol=0.0, atol=NORMAL_TOLERANCE):
        try:
            mesh = native.Mesh(positions, normals, triangles, uvs)
        except native.Error as error:
            raise native.Error(f"Object '{name}' cannot be drawn: {error}") from error
        _by_content[key] = mesh
        _normals[mesh] = normals
    return mesh
