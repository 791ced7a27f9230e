# A picture as means over blocks of pixels, each with what it is worth: what is fitted.
"""See `Blocks`."""

import numpy

SIDE = 8
"""Pixels, as where pictures are compared in blocks: noise falls eightfold, an error of shape stays."""
LEAST_SHARE = 0.125
"""Of a block's pixels, that it must have."""
TOLERANCE = 0.02
"""What a model may be off by itself, as a part of the radiance: noise below that makes no block more exact."""
DARKEST = 0.1
"""Of the mean radiance: what is darker is no better known."""
TILES = 4
"""Along each side, of those that are left out in turn."""

# Immerkaer, "Fast noise variance estimation", 1996, eq. 1: blind to whatever is straight along either axis.
NOISE_MASK = ((1, -2, 1), (-2, 4, -2), (1, -2, 1))
NOISE_GAIN = 36.0


class Blocks:
    """mask: (h, w) bool, the pixels that count. target: (h, w, 3), linear radiance.

    counts: pixels of each block; weights: (3, n), by which a difference of means is multiplied; tiles: of each block,
    the number of a larger part of the picture.
    """

    def __init__(self, mask, target):
        height, width = mask.shape
        rows, columns = numpy.nonzero(mask)
        across = -(-width // SIDE)
        names, self._of_pixel, counts = numpy.unique(rows // SIDE * across + columns // SIDE, return_inverse=True,
                                                     return_counts=True)
        self._mask, self._places = mask, (rows, columns)
        self._kept = counts >= LEAST_SHARE * SIDE**2
        self._all_counts = counts
        self.counts = counts[self._kept]
        self.means = self.of(target)
        self._variance = self._noise(target)
        self.weights = self._weights(self._variance)
        self.tiles = _tiles(names[self._kept] // across, names[self._kept] % across)

    def of(self, picture):
        """(3, n): the means over each block of a picture, (h, w, 3 or more)."""
        return self._mean(picture[..., :3])[:, self._kept]

    def residuals(self, means):
        """(3, n): differences from the target's means, in units of what they may be off."""
        return (means - self.means) * self.weights

    def noise(self, target, picture):
        """(3, n): what noise alone makes of the square of a residual in the mean. Whatever of the target the picture
        shows, too, is no noise: each of many small grains is as rough as that."""
        return self.weights**2 * numpy.minimum(self._variance, self._noise(target[..., :3] - picture[..., :3]))

    def _mean(self, values):
        rows, columns = self._places
        sums = [numpy.bincount(self._of_pixel, weights=values[rows, columns, channel].astype(float))
                for channel in range(3)]
        return numpy.array(sums) / self._all_counts

    def _weights(self, variance):
        typical = numpy.average(self.means, axis=1, weights=self.counts)[:, None]
        allowed = TOLERANCE**2 * (self.means**2 + (DARKEST * typical) ** 2 + 1e-30)
        return numpy.sqrt(self.counts / SIDE**2 / (allowed + variance))

    def _noise(self, target):
        """(3, n): the variance of each mean; that of a block without a whole neighbourhood is the others' mean."""
        mask, inside = self._mask, self._mask.copy()
        inside[[0, -1]] = inside[:, [0, -1]] = False
        seen = numpy.zeros((*mask.shape, 3))
        for y, row in enumerate(NOISE_MASK):
            for x, factor in enumerate(row):
                seen += factor * numpy.roll(target[..., :3], (1 - y, 1 - x), axis=(0, 1))
                inside &= numpy.roll(mask, (1 - y, 1 - x), axis=(0, 1))
        share = numpy.repeat(inside[..., None], 3, axis=-1).astype(float)
        squares = self._mean(share * seen**2 / NOISE_GAIN)
        known = self._mean(share)
        if not known.any():
            return numpy.zeros_like(self.means)
        usual = squares.sum(axis=1, keepdims=True) / known.sum(axis=1, keepdims=True)
        variance = numpy.where(known > 0.0, squares / numpy.maximum(known, 1e-9), usual)
        return (variance / self._all_counts)[:, self._kept]


def _tiles(rows, columns):
    def part(places):
        first, length = places.min(), numpy.ptp(places) + 1
        return (places - first) * TILES // length

    return part(rows) * TILES + part(columns)
