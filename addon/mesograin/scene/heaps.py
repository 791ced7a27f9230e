# Instances by the ten thousands: for each mesh and material the places where it stands, and nothing more.
import array
import dataclasses

import numpy as np

from .. import native_module
from . import meshes


MANY = 64
"""From so many placings on, a shape is a heap."""


@dataclasses.dataclass(frozen=True)
class HeapValues:
    """Many placings of one part of a mesh. placings: bytes of (n, 4, 4) float32, row by row, equal by content."""

    name: str
    mesh: object  # native.Mesh, equal by identity
    material: object  # export.MaterialValues
    placings: bytes

    def __len__(self):
        return len(self.placings) // 64

    def each(self):
        """Tuples of 16 numbers, row by row."""
        return map(tuple, np.frombuffer(self.placings, dtype=np.float32).reshape(-1, 16).tolist())

    def to_native(self, native, material):
        """native.InstanceArray."""
        placings = np.frombuffer(self.placings, dtype=np.float32).reshape(-1, 4, 4)
        return native.InstanceArray(self.mesh, material, placings)


class Group:
    """Where one shape stands: 16 numbers a placing, row by row, collected in one pass over a dependency graph.
    parts: (native.Mesh, material) of each of the shape's material slots; none if it is not drawn."""

    def __init__(self, name, parts):
        self.name, self._parts = name, parts
        self._rows = array.array("f")
        # One call a row: slices are the fastest way out of a Blender matrix.
        self.extend = self._rows.extend

    def values(self):
        """([HeapValues], how many placings have no extent or are no numbers)."""
        placings = np.frombuffer(self._rows, dtype=np.float32).reshape(-1, 4, 4)
        drawn = _drawable(placings)
        kept = placings if drawn.all() else placings[drawn]
        content = kept.tobytes()
        heaps = [HeapValues(self.name, mesh, material, content) for mesh, material in self._parts if len(kept)]
        return heaps, len(placings) - len(kept)


def _drawable(placings):
    """Which of (n, 4, 4) matrices meshes.has_extent and meshes.is_finite let through."""
    with np.errstate(invalid="ignore", over="ignore"):
        linear = placings[:, :3, :3].astype(np.float64)
        lengths = np.sqrt((linear * linear).sum(axis=1))
        volume = np.linalg.det(np.where(np.isfinite(linear), linear, 0.0))
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
    """array of floats, as a Group holds them: a unit sphere for each point of a point cloud, of the point's radius."""
    count = len(cloud.points)
    places, radii = np.empty((count, 3), dtype=np.float32), np.empty(count, dtype=np.float32)
    cloud.points.foreach_get("co", places.ravel())
    cloud.points.foreach_get("radius", radii)
    local = np.zeros((count, 4, 4), dtype=np.float32)
    local[:, (0, 1, 2), (0, 1, 2)] = radii[:, None]
    local[:, :3, 3] = places
    local[:, 3, 3] = 1.0
    return array.array("f", (np.array(matrix_world, dtype=np.float32) @ local).tobytes())
