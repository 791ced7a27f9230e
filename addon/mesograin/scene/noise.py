# Gradient noise (Perlin, "Improving Noise", 2002) and what fractals make of it (Musgrave, in Ebert et al., "Texturing
# and Modeling", 2003, chapter 16), with Blender's hashes, gradients and scales.
import itertools

import numpy as np

from . import hashes

# By how much it must be multiplied to fill -1 to 1, of one to four dimensions.
_SCALES = (0.25, 0.6616, 0.9820, 0.8344)


def signed(places):
    """(n,) of (n, 1 to 4) places, about -1 to 1."""
    dimensions = places.shape[1]
    cells = np.floor(places)
    within = places - cells
    faded = within ** 3 * (within * (within * 6.0 - 15.0) + 10.0)
    words_at = _words_of(cells.astype(np.int64))
    total = np.zeros(len(places))
    for corner in itertools.product((0, 1), repeat=dimensions):
        weight = np.ones(len(places))
        for axis, far in enumerate(corner):
            weight *= faded[:, axis] if far else 1.0 - faded[:, axis]
        total += weight * _slope(words_at(corner), within - corner)
    return _SCALES[dimensions - 1] * total


def _words_of(cells):
    """A function that tells the hashes of a corner of each of (n, d) cells; where many places share few cells, those
    are hashed once."""
    lower, upper = cells.min(axis=0), cells.max(axis=0) + 1
    shape = upper - lower + 1
    if np.prod(shape.astype(np.float64)) > len(cells):
        return lambda corner: hashes.of_whole(*(cells + corner).T)
    axes = np.meshgrid(*(np.arange(first, last + 1) for first, last in zip(lower, upper)), indexing="ij")
    known = hashes.of_whole(*(axis.ravel() for axis in axes))
    strides = np.append(np.cumprod(shape[:0:-1])[::-1], 1)
    flat = (cells - lower) @ strides
    return lambda corner: known[flat + np.array(corner) @ strides]


def _slope(words, offsets):
    """The dot product with one of a few gradients, which a hash chooses."""
    def flipped(value, bit):
        return np.where(words & bit, -value, value)

    axes = offsets.T
    if len(axes) == 1:
        return flipped(axes[0] * (1.0 + (words & 7)), 8)
    if len(axes) == 2:
        low = (words & 7) < 4
        return flipped(np.where(low, axes[0], axes[1]), 1) + flipped(2.0 * np.where(low, axes[1], axes[0]), 2)
    if len(axes) == 3:
        few = words & 15
        first = np.where(few < 8, axes[0], axes[1])
        other = np.where((few == 12) | (few == 14), axes[0], axes[2])
        return flipped(first, 1) + flipped(np.where(few < 4, axes[1], other), 2)
    few = words & 31
    return (flipped(np.where(few < 24, axes[0], axes[1]), 1) + flipped(np.where(few < 16, axes[1], axes[2]), 2)
            + flipped(np.where(few < 8, axes[2], axes[3]), 4))


def _octaves(places, count, lacunarity):
    """(number, places, share) of each octave; the last may count in part."""
    whole = int(count)
    for octave in range(whole):
        yield octave, places * lacunarity ** octave, 1.0
    if count != whole:
        yield whole, places * lacunarity ** whole, count - whole


def fbm(places, count, roughness, lacunarity, normalised):
    """Fractional Brownian motion of so many octaves, from 0 to 1 if normalised."""
    total, size = np.zeros(len(places)), 0.0
    for octave, scaled, share in _octaves(places, count, lacunarity):
        loud = roughness ** octave
        more = total + loud * signed(scaled)
        if not normalised:
            total = total + share * (more - total)
        elif share == 1.0:
            total, size = more, size + loud
        else:
            return 0.5 + 0.5 * (total / size + share * (more / (size + loud) - total / size))
    return 0.5 + 0.5 * total / size if normalised else total


def multifractal(places, count, roughness, lacunarity):
    value = np.ones(len(places))
    for octave, scaled, share in _octaves(places, count, lacunarity):
        value *= share * roughness ** octave * signed(scaled) + 1.0
    return value


def hetero_terrain(places, count, roughness, lacunarity, offset):
    value = None
    for octave, scaled, share in _octaves(places, count, lacunarity):
        risen = signed(scaled) + offset
        value = risen if value is None else value + share * risen * roughness ** octave * value
    return value


def hybrid_multifractal(places, count, roughness, lacunarity, offset, gain):
    value, weight = np.zeros(len(places)), np.ones(len(places))
    for octave, scaled, share in _octaves(places, count, lacunarity):
        # Where next to nothing is left the fractal ends.
        going_on = weight > 0.001
        weight = np.minimum(weight, 1.0)
        signal = (signed(scaled) + offset) * roughness ** octave
        value = np.where(going_on, value + share * weight * signal, value)
        weight = np.where(going_on, weight * gain * signal, 0.0)
    return value


def ridged_multifractal(places, count, roughness, lacunarity, offset, gain):
    value = signal = None
    for octave, scaled, share in _octaves(places, count, lacunarity):
        if share < 1.0:
            break
        ridge = (offset - np.abs(signed(scaled))) ** 2
        if signal is None:
            value = signal = ridge
            continue
        signal = ridge * np.clip(signal * gain, 0.0, 1.0)
        value = value + signal * roughness ** octave
    return value


def elsewhere(seed, dimensions):
    """(dimensions,): an offset from 100 to 200 that makes another noise of the same."""
    if dimensions == 1:
        return 100.0 + 100.0 * hashes.share_of_numbers(seed)
    return 100.0 + 100.0 * np.array([hashes.share_of_numbers(seed, axis)[0] for axis in range(dimensions)])
