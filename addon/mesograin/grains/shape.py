# What a grain's surface is made of: a grid on a cube's six faces, closed, with a chart of its texture for each face.
import dataclasses

import numpy as np

MARGIN = 0.02
"""Of a chart, on each side: what a bake may spill over."""


@dataclasses.dataclass(frozen=True)
class Shape:
    """vertices: (n, 3) float64. faces: (f, 4) whole numbers, outward. uvs: (f, 4, 2), of each corner."""

    vertices: np.ndarray
    faces: np.ndarray
    uvs: np.ndarray

    def moved(self, vertices):
        return dataclasses.replace(self, vertices=vertices)

    def volume(self):
        a, b, c, d = (self.vertices[self.faces[:, corner]] for corner in range(4))
        return sum(np.einsum("ij,ij->i", p, np.cross(q, r)).sum() for p, q, r in ((a, b, c), (a, c, d))) / 6.0

    def of_unit_volume(self):
        """As large as the unit sphere, its centre of mass at the origin."""
        a, b, c, d = (self.vertices[self.faces[:, corner]] for corner in range(4))
        moment = sum(((p + q + r) / 4.0 * np.einsum("ij,ij->i", p, np.cross(q, r))[:, None]).sum(axis=0) / 6.0
                     for p, q, r in ((a, b, c), (a, c, d)))
        vertices = self.vertices - moment / self.volume()
        return self.moved(vertices * (4.0 * np.pi / 3.0 / self.volume()) ** (1.0 / 3.0))


def cube(steps):
    """The cube from -1 to 1. steps: where its faces are divided, ascending from -1 to 1."""
    steps = np.asarray(steps, dtype=np.float64)
    count = len(steps) - 1
    across = np.arange(count + 1)
    first, second = (grid.ravel() for grid in np.meshgrid(across, across, indexing="ij"))
    i, j = (grid.ravel() for grid in np.meshgrid(across[:-1], across[:-1], indexing="ij"))
    square = np.stack((i, i + 1, i + 1, i)), np.stack((j, j, j + 1, j + 1))
    lattice, faces, uvs = [], [], []
    for chart in range(6):
        axis, positive = chart % 3, chart < 3
        place = np.empty((len(first), 3), dtype=np.int64)
        place[:, axis] = count if positive else 0
        place[:, (axis + 1) % 3], place[:, (axis + 2) % 3] = (first, second) if positive else (second, first)
        faces.append((square[0] * (count + 1) + square[1]).T + chart * len(first))
        lattice.append(place)
        along = np.stack(((steps[square[0]] + 1.0) / 2.0, (steps[square[1]] + 1.0) / 2.0), axis=-1)
        cell = np.array((chart % 3, chart // 3), dtype=np.float64)
        uvs.append(((cell + MARGIN + (1.0 - 2.0 * MARGIN) * along) / (3.0, 2.0)).transpose(1, 0, 2))
    # Faces share the vertices of the edges where they meet.
    lattice, same = np.unique(np.concatenate(lattice), axis=0, return_inverse=True)
    return Shape(steps[lattice], same.reshape(-1)[np.concatenate(faces)], np.concatenate(uvs))


def sphere(segments):
    """The unit sphere; `segments`: along each edge of the cube that it was. Its squares are about equally large."""
    block = cube(np.tan(np.linspace(-np.pi / 4.0, np.pi / 4.0, segments + 1)))
    return block.moved(block.vertices / np.linalg.norm(block.vertices, axis=1)[:, None])
