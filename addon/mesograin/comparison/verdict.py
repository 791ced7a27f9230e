# What a case's numbers come to, in a few words.
"""See `verdict`."""

from .significance import NO_DIFFERENCE


def verdict(entry):
    """A few words on a case of results.json, such as '2.31% off, in 40.0% of the pixels' or 'no significant difference,
    noise 0.27%'. How far off is `relative_l1_corrected`: without the reference's noise."""
    if entry["status"] != "done":
        return "failed"
    error = entry["metrics"]["relative_l1_corrected"]
    if error is None:
        return "the reference is black"
    test = entry["significance"]
    if test is None:
        return f"{error:.2%} off, noise unknown from one seed"
    if test["verdict"] == NO_DIFFERENCE:
        return f"{NO_DIFFERENCE}, noise {entry['noise_floor']['relative_l1']:.2%}"
    return f"{error:.2%} off, in {test['share']:.1%} of the pixels" if test["significant_pixels"] else (
        f"{error:.2%} off, seen in blocks of pixels")
