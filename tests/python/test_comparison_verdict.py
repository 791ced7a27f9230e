"""A case's numbers in a few words, for every way in which a case can end."""

import pytest
from addon_rooms import room

verdict = room("studies.comparison.verdict").verdict


def entry(error=0.05, corrected=0.04, noise=0.01, significance=None, **changes):
    """A case of results.json as far as the words need it."""
    metrics = {"relative_l1": error, "relative_l1_corrected": corrected}
    return {"status": "done", "judged_by": "relative_l1", "metrics": metrics, "noise_floor": {"relative_l1": noise},
            "significance": significance, **changes}


def significant(pixels):
    return {"verdict": "differs", "significant_pixels": pixels, "share": pixels / 1000}


@pytest.mark.parametrize("case, words", [
    (entry(status="failed"), "failed"),
    (entry(error=None, corrected=None, noise=None), "the reference is black"),
    (entry(corrected=None, noise=None), "5.00% off, noise unknown from one seed"),
    (entry(significance={"verdict": "no significant difference"}), "no significant difference, noise 1.00%"),
    (entry(significance=significant(400)), "4.00% off, beyond noise in 40.0% of the pixels"),
    (entry(significance=significant(0)), "4.00% off, beyond noise in blocks of pixels"),
])
def test_words(case, words):
    assert verdict(case) == words
