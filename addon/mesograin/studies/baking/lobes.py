# Functions of a light's direction as small octahedral maps, and the few of them that tell a surface's light best.
"""Maps are those of Cigolle et al., "A survey of efficient representations for independent unit vectors", JCGT 2014:
(side, side) with z up in the middle and down in the corners, row 0 at y = -1."""

import numpy

SIDE = 24
"""Texels along each side of a map: some 8 degrees each."""


def even_directions(count, turn=0.0):
    """(count, 3) unit vectors all around (the spiral of Swinbank and Purser, "Fibonacci grids", QJRMS 2006, eq. 1).
    turn: about z, in radians, for others that are as even."""
    number = numpy.arange(count) + 0.5
    z = 1.0 - 2.0 * number / count
    azimuth = number * numpy.pi * (3.0 - numpy.sqrt(5.0)) + turn
    across = numpy.sqrt(1.0 - z * z)
    return numpy.stack((across * numpy.cos(azimuth), across * numpy.sin(azimuth), z), axis=-1)


def map_directions(side=SIDE):
    """(side * side, 3): the direction in the middle of each texel, row by row."""
    directions = _unfolded(side).reshape(-1, 3)
    return directions / numpy.linalg.norm(directions, axis=1)[:, None]


def solid_angles(side=SIDE):
    """(side * side,): of the texels, 4 pi together; a piece of the octahedron is seen as dA cos / r^2 ~ 1 / r^3."""
    finer = 8
    x, y, z = numpy.moveaxis(_unfolded(side * finer), -1, 0)
    seen = (x * x + y * y + z * z) ** -1.5
    angles = seen.reshape(side, finer, side, finer).sum(axis=(1, 3)).ravel()
    return angles * (4.0 * numpy.pi / angles.sum())


def _unfolded(side):
    """(side, side, 3): the octahedron's own points."""
    y, x = numpy.meshgrid(*2 * [2.0 * (numpy.arange(side) + 0.5) / side - 1.0], indexing="ij")
    z = 1.0 - numpy.abs(x) - numpy.abs(y)
    fold = numpy.maximum(-z, 0.0)
    return numpy.stack((x - numpy.copysign(fold, x), y - numpy.copysign(fold, y), z), axis=-1)


def framed(maps):
    """(..., side + 2, side + 2): with a texel more on each side, so that what is read between texels goes on across the
    edges, where a map is mirrored about the edge's middle."""
    wide = numpy.zeros((*maps.shape[:-2], maps.shape[-2] + 2, maps.shape[-1] + 2), maps.dtype)
    wide[..., 1:-1, 1:-1] = maps
    wide[..., 0, 1:-1] = maps[..., 0, ::-1]
    wide[..., -1, 1:-1] = maps[..., -1, ::-1]
    wide[..., 1:-1, 0] = maps[..., ::-1, 0]
    wide[..., 1:-1, -1] = maps[..., ::-1, -1]
    for row, column in ((0, 0), (0, -1), (-1, 0), (-1, -1)):
        wide[..., row, column] = maps[..., -1 - row, -1 - column]
    return wide


def look_up(maps, directions):
    """(directions, maps): what maps of (count, side, side) say, linear between texels."""
    side = maps.shape[-1]
    directions = numpy.asarray(directions, dtype=float)
    square = directions[:, :2] / numpy.abs(directions).sum(axis=1)[:, None]
    below = directions[:, 2] < 0.0
    square[below] = (1.0 - numpy.abs(square[below, ::-1])) * numpy.where(square[below] < 0.0, -1.0, 1.0)
    place = 0.5 + (0.5 + 0.5 * square) * side  # in texels of the framed map, whose first middle is at 0
    first = numpy.clip(place.astype(int), 0, side)
    x, y = (place - first).T
    wide = framed(maps)
    column, row = first.T
    return ((1 - y) * ((1 - x) * wide[:, row, column] + x * wide[:, row, column + 1])
            + y * ((1 - x) * wide[:, row + 1, column] + x * wide[:, row + 1, column + 1])).T


def principal_maps(seen, count):
    """(count, side, side): the maps that tell most of `seen`, (side * side, values): what each direction of
    `map_directions` makes of some values (principal components, directions weighed by their solid angles)."""
    side = round(len(seen) ** 0.5)
    weights = numpy.sqrt(solid_angles(side))
    weighed = weights[:, None] * seen.astype(numpy.float64)
    _, vectors = numpy.linalg.eigh(weighed @ weighed.T)
    leading = vectors[:, ::-1][:, :count] / weights[:, None]
    leading /= numpy.abs(leading).max(axis=0)
    return leading.T.reshape(count, side, side)
