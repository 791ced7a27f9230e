# What a case's numbers come to, in a few words.
"""See `verdict`."""

from .significance import NO_DIFFERENCE


def verdict(entry):
    """A few words on a case of results.json, such as '2.31% off, beyond noise in 40.0% of the pixels' or 'no
    significant difference, noise 0.27%'. How far off is the relative L1 that judges this kind of reference, pixel by
    pixel or in blocks, without the reference's noise."""
    if entry["status"] != "done":
        return "failed"
    metric = entry["judged_by"]
    metrics, noise, test = entry["metrics"], entry["noise_floor"][metric], entry["significance"]
    if metrics[metric] is None:
        return "the reference is black"
    if test is None:
        return f"{metrics[metric]:.2%} off, noise unknown from one seed"
    if test["verdict"] == NO_DIFFERENCE:
        return f"{NO_DIFFERENCE}, noise {noise:.2%}"
    where = f"{test['share']:.1%} of the pixels" if test["significant_pixels"] else "blocks of pixels"
    return f"{metrics[f'{metric}_corrected']:.2%} off, beyond noise in {where}"
