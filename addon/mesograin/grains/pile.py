# Where the grains of a pile lie and how they are turned: spheres are settled, and each grain takes a sphere's place.
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


class Settling:
    """A pile that settles beside Blender, as `settle` describes it, in a thread that knows nothing of Python."""

    def __init__(self, count, radius, variation=0.2, shapes=1, seed=0, friction=0.6, walls=None, heights=None,
                 corners=None):
        self._key = (count, radius, variation, shapes, seed, friction, walls, heights, corners)
        self._random = np.random.default_rng(seed)
        self._shapes = shapes
        self._radii = radius * (1.0 + variation * self._random.uniform(-1.0, 1.0, count))
        ground = None if heights is None else np.array(heights, dtype=np.float64)
        self._work = native_module.get().start_settling(self._radii, walls, ground, corners, friction, seed)

    @property
    def share(self):
        """How far it is, 0 to 1."""
        return self._work.share

    @property
    def done(self):
        return self._work.done

    def cancel(self):
        self._work.cancel()

    def result(self):
        """Placings, which `settle` then knows. Waits. Raises native.Error."""
        middles, overlap = self._work.result()
        count = len(middles)
        angles = _angles(self._random, count)
        found = Placings(middles, self._radii, angles, self._random.integers(self._shapes, size=count), overlap)
        _remember(self._key, found)
        return found


_settled = {}
MOST_SETTLED = 4


def _remember(key, placings):
    while len(_settled) >= MOST_SETTLED:
        del _settled[next(iter(_settled))]
    _settled[key] = placings


def settle(count, radius, variation=0.2, shapes=1, seed=0, friction=0.6, walls=None, heights=None, corners=None):
    """Placings of `count` grains that fell, z up. radius: of their spheres on average; variation: how far radii differ
    from it, 0 to 1. walls: (x, y) between which they fell, or None for a heap. heights: rows of tuples between
    corners ((x, y), (x, y)), of the ground; None is the plane z = 0. Raises native.Error."""
    key = (count, radius, variation, shapes, seed, friction, walls, heights, corners)
    return _settled[key] if key in _settled else Settling(*key).result()


def _angles(random, count):
    """Euler angles (XYZ) of turns drawn evenly from all there are: R = Rz Ry Rx, whose measure is cos(y) dx dy dz."""
    around = random.uniform(-np.pi, np.pi, (count, 2))
    return np.stack((around[:, 0], np.arcsin(random.uniform(-1.0, 1.0, count)), around[:, 1]), axis=-1)
