# What every number of a result means, in one sentence each, kept with the numbers themselves.
"""`i` is a sample of our image, `r` of the reference, the mean of its seeds: masked linear radiance."""

METRICS = {
    "relative_l1": "sum |i - r| / sum r; 0 is perfect, no unit",
    "bias": "sum i / sum r: how much light in all; 1 is perfect, no unit",
    "rse_mean": (
        "mean of (i - r)^2 / (r^2 + 0.01), per channel, without a square root, as in the image viewer tev; no unit"
    ),
    "rse_max": "largest (i - r)^2 / (r^2 + 0.01); no unit",
    "rse_max_at": "where the largest RSE is: [x, y, channel], y = 0 at the top",
    "rse_root_mean": (
        "mean of |i - r| / sqrt(r^2 + 0.01), the root of RSE; published figures called RSE are sometimes this"
    ),
    "rae_mean": "mean of |i - r| / (r + 0.01); no unit",
    "ae_mean": "mean of |i - r|; radiance",
    "e_mean": "mean of i - r; radiance, positive where we are too bright",
    "se_mean": "mean of (i - r)^2; radiance squared, the same number as MSE",
    "mse": "mean of (i - r)^2; radiance squared",
    "rmse": "root of MSE; radiance",
    "max_error": "largest |i - r|; radiance",
    "max_error_at": "where the largest |i - r| is: [x, y, channel], y = 0 at the top",
    "ae_p50": "half of all samples have an |i - r| below this; radiance",
    "ae_p95": "95 % of all samples have an |i - r| below this; radiance",
    "ae_p99": "99 % of all samples have an |i - r| below this; radiance",
    "rse_p50": "half of all samples have an RSE below this",
    "rse_p95": "95 % of all samples have an RSE below this",
    "rse_p99": "99 % of all samples have an RSE below this",
}

SUFFIXES = {
    "_corrected": (
        "with the reference's noise taken off in quadrature: sqrt(max(0, v^2 - floor^2)), or max(0, v - floor) for"
        " squares"
    ),
    "_blocks": (
        "after averaging both images over squares of 8 x 8 pixels: noise falls eightfold, an error of shape stays"
    ),
}

OTHERS = {
    "noise_floor": (
        "what a perfect image would score against this reference: the metric with |s - r| / sqrt(K - 1) in the place of"
        " |i - r|, s one of the K seeds whose mean is r, averaged over the seeds; with two seeds that is |a - b| / 2"
    ),
    "our_noise": "the same of our picture: what it would score against itself, had it all samples that there are",
    "significance.verdict": (
        "whether some pixel or block of 8 x 8 pixels differs by more than the noise of both sides explains, and by"
        " more than 0.2 %: t-tests of every masked pixel, block and channel, corrected after Sidak; an image without"
        " error is called different with a probability of the false-alarm rate or less"
    ),
    "significance.share": "significant pixels / pixels tested",
    "controls": (
        "the same test where the truth is known: the reference's own renderer stands in our place, with other seeds,"
        " once with the same material (not to be called different), once with a deliberately wrong one (to be)"
    ),
    "until": (
        "seeds were added until the noise floor was at most the share asked for of the error, noise taken off, or there"
        " were as many seeds as allowed"
    ),
    "mask.pixels": (
        "pixels compared: coverage 1 in the reference, less those within 2 pixels (or as many as asked for) of one"
        " whose coverage is not, less those that further masks took away"
    ),
    "mask_steps": "what each mask kept (pixels) and took away (removed), in order",
    "unfiltered": "the numbers of the silhouette alone, before any other mask",
    "judged_by": "the metric to read first; in blocks where the reference's single pixels are too noisy",
    "channels": "bias and relative L1 of red, green and blue apart: a shift of colour",
    "profile": "means over the masked pixels in 20 equal bins of cos(normal, direction to the strongest sun); radiance",
    "mask.nan": "masked pixels with a NaN in our image or the reference; they are in no sum",
    "mask.inf": "masked pixels with an Inf and no NaN; they are in no sum",
    "frame_ms": (
        "milliseconds of all passes of one frame (one sample a pixel) on the device named, the median of several"
        " frames after a first one that prepared the device"
    ),
    "reference_seconds": (
        "wall-clock seconds that Cycles took for all seeds, on all cores of the CPU, when the reference was rendered"
    ),
    "exposure_stops": "the PNG pictures show radiance times 2 to this power, encoded as sRGB",
}


def definition(name):
    """The sentence for a metric's name with or without suffixes; None for a name that has none."""
    if name in METRICS:
        return METRICS[name]
    for suffix, meaning in SUFFIXES.items():
        if name.endswith(suffix):
            plain = definition(name[: -len(suffix)])
            return plain and f"{plain}; {meaning}"
    return OTHERS.get(name)


def all_definitions(names):
    """{name: sentence} for the metrics named and everything else that a result holds."""
    return {**{name: definition(name) for name in names if definition(name)}, **OTHERS}
