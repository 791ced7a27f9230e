# Cells around points that lie at random (Worley, "A Cellular Texture Basis Function", 1996), as Blender has them; edges
# by Quilez, "Voronoi Edges", 2012.
import itertools

import numpy as np

from . import hashes

METRICS = {
    "EUCLIDEAN": lambda apart, _exponent: np.sqrt((apart ** 2).sum(axis=1)),
    "MANHATTAN": lambda apart, _exponent: np.abs(apart).sum(axis=1),
    "CHEBYCHEV": lambda apart, _exponent: np.abs(apart).max(axis=1),
    "MINKOWSKI": lambda apart, exponent: (np.abs(apart) ** exponent).sum(axis=1) ** (1.0 / exponent),
}


class Cells:
    """The points around (n, 1 to 4) places. randomness: 0 to 1, how far from its cell's corner each may be."""

    def __init__(self, places, randomness):
        self.corners = np.floor(places)
        self.within = places - self.corners
        self.dimensions = places.shape[1]
        self._randomness = randomness

    def point(self, offset):
        """Of the cells at this offset from each place's own, from the corner of that."""
        offset = np.broadcast_to(np.asarray(offset, dtype=np.float64), self.corners.shape)
        return offset + hashes.shares_of_cell(self.corners + offset)[:, :self.dimensions] * self._randomness

    def colour(self, offset):
        return hashes.colours_of_cell(self.corners + offset)

    def around(self, reach=1):
        """Offsets of the cells around, the first axis running fastest."""
        for backwards in itertools.product(range(-reach, reach + 1), repeat=self.dimensions):
            yield np.array(backwards[::-1], dtype=np.float64)


def nearest(cells, metric, exponent, rank):
    """(distance, colour (n, 3), place (n, d)) of the point that is nearest, rank 0, or second nearest, rank 1."""
    count = len(cells.within)
    distances = [np.full(count, np.inf) for _ in range(2)]
    offsets = [np.zeros_like(cells.within) for _ in range(2)]
    points = [np.zeros_like(cells.within) for _ in range(2)]
    for offset in cells.around():
        point = cells.point(offset)
        distance = METRICS[metric](point - cells.within, exponent)
        first, second = distance < distances[0], distance < distances[1]
        for known, new in ((distances, distance), (offsets, offset), (points, point)):
            wide = (lambda mask: mask) if known is distances else (lambda mask: mask[:, None])
            known[1] = np.where(wide(first), known[0], np.where(wide(second), new, known[1]))
            known[0] = np.where(wide(first), new, known[0])
    return distances[rank], cells.colour(offsets[rank]), points[rank] + cells.corners


def smooth_nearest(cells, metric, exponent, smoothness):
    """The same of the nearest, one point going over into the next."""
    distance = colour = place = None
    for offset in cells.around(2):
        point = cells.point(offset)
        own, tint = METRICS[metric](point - cells.within, exponent), cells.colour(offset)
        if distance is None:
            distance, colour, place = own, tint, point
            continue
        share = np.clip(0.5 + 0.5 * (distance - own) / smoothness, 0.0, 1.0)
        share = share * share * (3.0 - 2.0 * share)
        dip = smoothness * share * (1.0 - share)
        distance = distance + share * (own - distance) - dip
        dip = (dip / (1.0 + 3.0 * smoothness))[:, None]
        colour = colour + share[:, None] * (tint - colour) - dip
        place = place + share[:, None] * (point - place) - dip
    return distance, colour, place + cells.corners


def distance_to_edge(cells):
    """(n,): how far it is to where the nearest point changes."""
    closest, least = np.zeros_like(cells.within), np.full(len(cells.within), np.inf)
    ways = [cells.point(offset) - cells.within for offset in cells.around()]
    for way in ways:
        squared = (way ** 2).sum(axis=1)
        closest = np.where((squared < least)[:, None], way, closest)
        least = np.minimum(squared, least)
    edge = np.full(len(cells.within), np.inf)
    for way in ways:
        apart = way - closest
        length = np.sqrt((apart ** 2).sum(axis=1))
        distance = (0.5 * (closest + way) * apart).sum(axis=1) / np.maximum(length, 1e-30)
        edge = np.where(length ** 2 > 0.0001, np.minimum(edge, distance), edge)
    return edge


def ball_radius(cells):
    """(n,): of the largest ball around the nearest point that meets no other's."""
    least, closest, home = np.full(len(cells.within), np.inf), np.zeros_like(cells.within), np.zeros_like(cells.within)
    for offset in cells.around():
        point = cells.point(offset)
        distance = METRICS["EUCLIDEAN"](point - cells.within, 0.0)
        nearer = distance < least
        closest, home = (np.where(nearer[:, None], new, known) for new, known in ((point, closest), (offset, home)))
        least = np.minimum(distance, least)
    apart = np.full(len(cells.within), np.inf)
    for offset in cells.around():
        if offset.any():
            apart = np.minimum(apart, METRICS["EUCLIDEAN"](cells.point(home + offset) - closest, 0.0))
    return 0.5 * apart
