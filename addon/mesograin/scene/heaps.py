# Instances by the ten thousands: for each mesh and material the places where it stands, and nothing more.
import array
import dataclasses

import numpy as np

from .. import compat, native_module
from . import instance_attributes, meshes


MANY = 64
"""From so many placings on, a shape is a heap."""

ITSELF, HIDDEN = -1, -2
"""In place of a group's number: an object that is no instance; an instance that is not shown."""


@dataclasses.dataclass(frozen=True)
class HeapValues:
    """Many placings of one part of a mesh, which the native scenes made of them share. factors: (parameter, bytes of
    (n, 3) float32) pairs, by which each placing's differs from the material's."""

    name: str
    mesh: object  # native.Mesh, equal by identity
    material: object  # export.MaterialValues
    placings: object  # native.Transforms of (n, 4, 4) float32, equal by content
    factors: tuple = ()

    def __len__(self):
        return len(self.placings)

    def each(self):
        """Tuples of 16 numbers, row by row."""
        return map(tuple, self.placings.matrices().reshape(-1, 16).tolist())

    def typical(self):
        """The placing of the middle size, 16 numbers row by row."""
        placings = self.placings.matrices()
        sizes = np.abs(np.linalg.det(placings[:, :3, :3].astype(np.float64)))
        middle = np.argpartition(sizes, len(sizes) // 2)[len(sizes) // 2]
        return tuple(placings[middle].ravel().tolist())

    def materials(self):
        """The material of each placing."""
        factors = [(name, np.frombuffer(numbers, dtype=np.float32).reshape(-1, 3)) for name, numbers in self.factors]
        for number in range(len(self)):
            yield self.material.multiplied({name: rows[number].tolist() for name, rows in factors})

    def to_native(self, native, material):
        """native.InstanceArray."""
        factors = {name: np.frombuffer(numbers, dtype=np.float32).reshape(-1, 3) for name, numbers in self.factors}
        return native.InstanceArray(self.mesh, material, self.placings, factors)


@dataclasses.dataclass(frozen=True)
class Part:
    """The faces of a shape that wear one material, or one of the bodies that they are. variation: colours.Variation of
    its material, or None. placings: (m, 4, 4) float64, where a body stands in the shape; None for what is no body."""

    mesh: object  # native.Mesh
    material: object  # export.MaterialValues
    variation: object = None
    placings: object = None


class Group:
    """Where one shape stands. parts: Parts that make it up; none if it is not drawn.
    varies: whether a part's colours differ from placing to placing; at_random: by the random number of each, perhaps;
    attributes: names of those of instancers by which they do."""

    def __init__(self, name, parts):
        self.name, self._parts = name, parts
        self.varies = any(part.variation for part in parts)
        self.at_random = any(part.variation.at_random for part in parts if part.variation)
        self.attributes = frozenset().union(*(part.variation.attributes for part in parts if part.variation))
        self._placings = np.empty((0, 4, 4), dtype=np.float32)
        self._each = None

    def place(self, placings, each=None):
        """placings: (n, 4, 4) float32, row by row. each: {name: (n, ...)} of groups that vary, as colours.py has it."""
        self._placings, self._each = placings, each

    def values(self):
        """([HeapValues] of parts, [HeapValues] of bodies, how many placings have no extent or are no numbers)."""
        placings = self._placings
        drawn = _drawable(placings)
        kept = placings if drawn.all() else placings[drawn]
        left_out = len(placings) - len(kept)
        if len(kept) == 0:
            return [], [], left_out
        parts, bodies = [], []
        native = native_module.get()
        shared = native.Transforms(kept)
        for number, part in enumerate(self._parts):
            material, factors = _at_mean_scale(part.material, kept), self._factors(number, part, drawn)
            if part.placings is None:
                parts.append(HeapValues(self.name, part.mesh, material, shared, factors))
            else:
                each = (kept[:, None].astype(np.float64) @ part.placings).reshape(-1, 4, 4).astype(np.float32)
                bodies.append(HeapValues(self.name, part.mesh, material, native.Transforms(each), factors))
        return parts, bodies, left_out

    def _factors(self, number, part, drawn):
        if part.variation is None or self._each is None:
            return ()
        each = {name: values[drawn] for name, values in self._each.items()}
        if part.placings is not None:
            times = len(part.placings)
            each = {name: values.repeat(times, axis=0) for name, values in each.items()}
            if part.variation.of_bodies:
                # As many numbers however many follow: a pile that grows by a grain keeps its colours.
                own = np.random.default_rng(number).random(times, dtype=np.float32)
                each["random"] = (each["random"] + np.tile(own, np.count_nonzero(drawn))) % np.float32(1.0)
        return part.variation.factors(each)


def _at_mean_scale(material, placings):
    if material.absorption is None:
        return material
    return material.at_scale(float(np.cbrt(np.abs(np.linalg.det(placings[:, :3, :3].astype(float)))).mean()))


def place(depsgraph, numbers, groups, shapes, readers):
    """Gives groups their placings; returns sentences on what is not known of them. numbers: of each of the dependency
    graph's instances the number of its group in `groups`, a list of Groups and None, or ITSELF or HIDDEN; shapes:
    instance_attributes.Worn of each group; readers: as instance_attributes.of_each has them."""
    instances = depsgraph.object_instances
    at_once = compat.frees_first_instances() or (numbers[:2] == ITSELF).all()
    matrices = (_all_matrices if at_once else _each_matrix)(instances, len(numbers))
    known, sentences = {}, []
    if any(group is not None and group.at_random for group in groups):
        numbers_of_each = np.fromiter((each.random_id for each in instances), dtype=np.int32).view(np.uint32)
        # As Cycles' Object Info has it: the whole range of 32 bits is from 0 to 1.
        known["random"] = (numbers_of_each / np.float32(0xFFFFFFFF)).astype(np.float32)
    if any(shape.names for shape in shapes):
        attributes, sentences = instance_attributes.of_each(depsgraph, numbers, matrices, shapes, readers)
        known.update(attributes)
    in_order = np.argsort(numbers, kind="stable")
    ends = np.searchsorted(numbers[in_order], np.arange(len(groups) + 1))
    for group, first, end in zip(groups, ends, ends[1:]):
        if group is not None:
            rows = in_order[first:end]
            each = {name: values[rows] for name, values in known.items()} if group.varies else None
            group.place(matrices[rows], each)
    return sentences


def _all_matrices(instances, count):
    columns = np.empty((count, 4, 4), dtype=np.float32)
    instances.foreach_get("matrix_world", columns.ravel())
    return columns.transpose(0, 2, 1)


def _each_matrix(instances, count):
    numbers = array.array("f")
    extend = numbers.extend
    for instance in instances:
        # A copy is read once; each row of the original would be read anew. Slices are the fastest way out of it.
        first, second, third, fourth = instance.matrix_world.copy()
        extend(first[:])
        extend(second[:])
        extend(third[:])
        extend(fourth[:])
    return np.frombuffer(numbers, dtype=np.float32).reshape(count, 4, 4)


def _drawable(placings):
    """Which of (n, 4, 4) matrices meshes.has_extent and meshes.is_finite let through."""
    with np.errstate(invalid="ignore", over="ignore"):
        linear = placings[:, :3, :3].astype(np.float64)
        lengths = np.sqrt((linear * linear).sum(axis=1))
        volume = np.einsum("ij,ij->i", linear[:, 0], np.cross(linear[:, 1], linear[:, 2]))
        finite = np.isfinite(placings).all(axis=(1, 2))
        return finite & (volume != 0.0) & (lengths.min(axis=1) >= meshes.THINNEST * lengths.max(axis=1))


_sphere = None


def sphere():
    """native.Mesh of the unit sphere that a point of a point cloud is drawn as."""
    global _sphere
    if _sphere is None:
        _sphere = _unit_sphere(48, 24)
    return _sphere


def _unit_sphere(segments, rings):
    """Latitudes and longitudes; the volume of the polyhedron is the sphere's."""
    polar = np.linspace(0.0, np.pi, rings + 1)
    azimuth = np.linspace(0.0, 2.0 * np.pi, segments, endpoint=False)
    across, up = np.sin(polar)[:, None], np.cos(polar)[:, None]
    normals = np.stack((across * np.cos(azimuth), across * np.sin(azimuth), up * np.ones_like(azimuth)), axis=-1)
    corner = np.arange((rings + 1) * segments).reshape(rings + 1, segments)
    a, b = corner[:-1], corner[1:]
    c, d = np.roll(b, -1, axis=1), np.roll(a, -1, axis=1)
    lower, upper = np.stack((a, b, c), axis=-1)[:-1], np.stack((a, c, d), axis=-1)[1:]
    triangles = np.concatenate((lower.reshape(-1, 3), upper.reshape(-1, 3))).astype(np.uint32)
    normals = normals.reshape(-1, 3)
    first, second, third = (normals[triangles[:, number]] for number in range(3))
    volume = np.einsum("ij,ij->i", first, np.cross(second, third)).sum() / 6.0
    positions = normals * (4.0 * np.pi / 3.0 / volume) ** (1.0 / 3.0)
    return native_module.get().Mesh(positions.astype(np.float32), normals.astype(np.float32), triangles)


def point_placings(cloud, matrix_world):
    """Placings of a Group: a unit sphere for each point of a point cloud, of the point's radius."""
    count = len(cloud.points)
    places, radii = np.empty((count, 3), dtype=np.float32), np.empty(count, dtype=np.float32)
    cloud.points.foreach_get("co", places.ravel())
    cloud.points.foreach_get("radius", radii)
    local = np.zeros((count, 4, 4), dtype=np.float32)
    local[:, (0, 1, 2), (0, 1, 2)] = radii[:, None]
    local[:, :3, 3] = places
    local[:, 3, 3] = 1.0
    return np.array(matrix_world, dtype=np.float32) @ local
