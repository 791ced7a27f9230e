# Whether a case differs from its reference by more than the noise of both: the test's outcome for results.json.
"""See `test`. docs/metrics.md defines the numbers, native/image/significance.h the test."""

import numpy

from .. import native_module

DIFFERS = "differs"
NO_DIFFERENCE = "no significant difference"


def test(ours, theirs, mask):
    """(entry of results.json, (h, w, 3) float32 map of scores), or (None, None) with one reference.

    ours, theirs: lists of (h, w, 4) float32 images of independent noise. mask: (h, w) bool.
    """
    if len(theirs) < 2:
        return None, None
    found = native_module.get().test_significance(ours, theirs, mask)
    entry = {
        "verdict": DIFFERS if found["differs"] else NO_DIFFERENCE,
        "pixels": found["pixels"],
        "tests": found["tests"],
        "significant_pixels": found["significant_pixels"],
        "share": found["significant_pixels"] / found["pixels"],
        "false_alarm_rate": found["false_alarm_rate"],
        "threshold": found["threshold"],
        "score_threshold": found["score_threshold"],
        "relative_tolerance": found["relative_tolerance"],
        "reference_seeds": len(theirs),
        "our_seeds": len(ours),
    }
    return entry, found["score"]


def largest_score(scores):
    """(h, w): of each pixel's channels the score farthest from 0, with its sign."""
    at = numpy.abs(scores).argmax(axis=-1)
    return numpy.take_along_axis(scores, at[..., None], axis=-1)[..., 0]
