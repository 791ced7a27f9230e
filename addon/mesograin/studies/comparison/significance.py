# Whether a case differs from its reference by more than the noise of both: the test's outcome for results.json.
"""See `test`. docs/metrics.md defines the numbers, native/image/significance.h the test."""

import numpy

from ... import native_module

DIFFERS = "differs"
NO_DIFFERENCE = "no significant difference"


FALSE_ALARM_RATE = 0.01
"""Of the whole verdict: half of it goes to the pixels, half to the blocks."""

BLOCK = 8
"""Pixels a side of a block: an error of shape that each pixel's noise hides stands out in their averages."""


def test(ours, theirs, mask, rate=FALSE_ALARM_RATE):
    """(entry of results.json, (h, w, 3) float32 map of scores), or (None, None) with one reference.

    ours, theirs: lists of (h, w, 4) float32 images of independent noise. mask: (h, w) bool. rate: of false alarms.
    """
    if len(theirs) < 2:
        return None, None
    half = 1.0 - (1.0 - rate) ** 0.5
    native = native_module.get()
    pixels = native.test_significance(ours, theirs, mask, false_alarm_rate=half)
    full = _full_blocks(mask)
    blocks = None
    if full.any():
        in_blocks = [[_block_means(image, mask) for image in images] for images in (ours, theirs)]
        blocks = native.test_significance(*in_blocks, full, false_alarm_rate=half)
    differs = pixels["differs"] or (blocks is not None and blocks["differs"])
    entry = {
        "verdict": DIFFERS if differs else NO_DIFFERENCE,
        "pixels": pixels["pixels"],
        "tests": pixels["tests"],
        "significant_pixels": pixels["significant_pixels"],
        "share": pixels["significant_pixels"] / pixels["pixels"],
        "threshold": pixels["threshold"],
        "score_threshold": pixels["score_threshold"],
        "blocks": blocks["pixels"] if blocks else 0,
        "significant_blocks": blocks["significant_pixels"] if blocks else 0,
        "share_blocks": blocks["significant_pixels"] / blocks["pixels"] if blocks else None,
        "threshold_blocks": blocks["threshold"] if blocks else None,
        "false_alarm_rate": rate,
        "relative_tolerance": pixels["relative_tolerance"],
        "reference_seeds": len(theirs),
        "our_seeds": len(ours),
    }
    return entry, pixels["score"]


def _full_blocks(mask):
    """(h / 8, w / 8) bool: blocks of which at least half is masked, so that their noise is comparable."""
    return _block_sums(mask[..., None].astype(numpy.float64))[..., 0] >= BLOCK * BLOCK / 2


def _block_means(image, mask):
    """(h / 8, w / 8, 3) float32 means over the masked pixels of each block; 0 where there is none."""
    weight = mask[..., None].astype(numpy.float64)
    # A NaN outside the mask is nobody's business; inside, it makes its block NaN, which is not tested.
    colours = numpy.where(mask[..., None], image[..., :3], 0.0)
    return (_block_sums(colours) / numpy.maximum(_block_sums(weight), 1.0)).astype(numpy.float32)


def _block_sums(values):
    height, width, channels = values.shape
    rows, columns = -(-height // BLOCK), -(-width // BLOCK)
    padded = numpy.zeros((rows * BLOCK, columns * BLOCK, channels))
    padded[:height, :width] = values
    return padded.reshape(rows, BLOCK, columns, BLOCK, channels).sum(axis=(1, 3))


def largest_score(scores):
    """(h, w): of each pixel's channels the score farthest from 0, with its sign."""
    at = numpy.abs(scores).argmax(axis=-1)
    return numpy.take_along_axis(scores, at[..., None], axis=-1)[..., 0]
