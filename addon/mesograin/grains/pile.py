# Where the grains of a pile lie and how they are turned: they fall, and come to rest on each other.
import typing

import numpy as np

from .. import native_module
from . import kinds


class Placings(typing.NamedTuple):
    """Of n grains, fewer than asked for where no more fit inside a mesh: middles (n, 3), radii (n,) of balls as large,
    Euler angles (n, 3) and which shape each has, (n,). overlap: the largest of two grains, in radii of the smaller."""

    middles: np.ndarray
    radii: np.ndarray
    angles: np.ndarray
    shapes: np.ndarray
    overlap: float


class Surface(typing.NamedTuple):
    """What grains fall on or into: vertices (n, 3) float64 and triangles (t, 3) of them."""

    vertices: np.ndarray
    triangles: np.ndarray


class Settling:
    """A pile that settles beside Blender, as `settle` describes it, in a thread that knows nothing of Python."""

    def __init__(self, shapes, count, radius, variation=0.2, seed=0, friction=0.6, walls=None, surface=None,
                 inside=False):
        self._key = _key(shapes, count, radius, variation, seed, friction, walls, surface, inside)
        random = np.random.default_rng(seed)
        self._radii = radius * (1.0 + variation * random.uniform(-1.0, 1.0, count))
        self._shapes = random.integers(len(shapes), size=count)
        floor = 0.0 if surface is None else float(np.min(surface.vertices[surface.triangles.ravel(), 2]))
        self._work = native_module.get().start_settling(
            self._radii, self._shapes.astype(np.uint32), [_arrays(shape) for shape in shapes], walls,
            None if surface is None else tuple(surface), floor, friction, seed, inside)

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
        middles, turns, overlap, numbers = self._work.result()
        found = Placings(middles, self._radii[numbers], _angles(turns), self._shapes[numbers], overlap)
        _remember(self._key, found)
        return found


_settled = {}
MOST_SETTLED = 4


def _key(shapes, count, radius, variation, seed, friction, walls, surface, inside):
    arrays = [array for shape in shapes for array in _arrays(shape)] + list(surface or ())
    return (count, radius, variation, seed, friction, walls, inside, len(shapes),
            *(array.tobytes() for array in arrays))


def _remember(key, placings):
    while len(_settled) >= MOST_SETTLED:
        del _settled[next(iter(_settled))]
    _settled[key] = placings


def shapes_of(kinds_of_shapes, seed=0, **habit):
    """A shape.Shape of each kind, such as three times "sand", of seeds one after the other. habit: as kinds.make."""
    return [kinds.make(kind, seed=seed + number, **habit) for number, kind in enumerate(kinds_of_shapes)]


def settle(shapes, count, radius, variation=0.2, seed=0, friction=0.6, walls=None, surface=None,
           inside=False):
    """Placings of `count` grains that fell, z up, each one of these shape.Shapes. radius: of balls as large as they are
    on average; variation: how far radii differ from it, 0 to 1. walls: (x, y) between which they fell, or None for a
    heap. surface: a Surface; None is the plane z = 0. inside: they fall in the room that the surface encloses, as many
    as fit there, so that there may be fewer than asked for. Raises native.Error."""
    arguments = (shapes, count, radius, variation, seed, friction, walls, surface, inside)
    known = _settled.get(_key(*arguments))
    return Settling(*arguments).result() if known is None else known


def _arrays(shape):
    """(vertices, triangles). The last bits of vertices may differ from one making to the next."""
    triangles = np.concatenate((shape.faces[:, [0, 1, 2]], shape.faces[:, [0, 2, 3]]))
    return np.round(shape.vertices, 9) + 0.0, triangles.astype(np.uint32)


def _angles(turns):
    """Euler angles (XYZ), R = Rz Ry Rx, of quaternions (w, x, y, z)."""
    w, x, y, z = turns.T
    return np.stack((np.arctan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
                     np.arcsin(np.clip(2.0 * (w * y - z * x), -1.0, 1.0)),
                     np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))), axis=-1)
