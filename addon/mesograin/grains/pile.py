# Where the grains of a pile lie and how they are turned: spheres are settled, and each grain takes a sphere's place.
import functools
import typing

import numpy as np

from .. import native_module


class Placings(typing.NamedTuple):
    """Of n grains: middles (n, 3), radii (n,) of their spheres, Euler angles (n, 3) and which shape each has, (n,).
    overlap: the largest of two spheres, in radii of the smaller one."""

    middles: np.ndarray
    radii: np.ndarray
    angles: np.ndarray
    shapes: np.ndarray
    overlap: float


@functools.lru_cache(maxsize=4)
def settle(count, radius, variation=0.2, shapes=1, seed=0, friction=0.6, walls=None, heights=None, corners=None):
    """Placings of `count` grains that fell, z up. radius: of their spheres on average; variation: how far radii differ
    from it, 0 to 1. walls: (x, y) between which they fell, or None for a heap. heights: rows of tuples between
    corners ((x, y), (x, y)), of the ground; None is the plane z = 0. Raises native.Error."""
    random = np.random.default_rng(seed)
    radii = radius * (1.0 + variation * random.uniform(-1.0, 1.0, count))
    ground = None if heights is None else np.array(heights, dtype=np.float64)
    middles, overlap = native_module.get().settle(radii, walls, ground, corners, friction, seed)
    return Placings(middles, radii, _angles(random, count), random.integers(shapes, size=count), overlap)


def _angles(random, count):
    """Euler angles (XYZ) of turns drawn evenly from all there are: R = Rz Ry Rx, whose measure is cos(y) dx dy dz."""
    around = random.uniform(-np.pi, np.pi, (count, 2))
    return np.stack((around[:, 0], np.arcsin(random.uniform(-1.0, 1.0, count)), around[:, 1]), axis=-1)
