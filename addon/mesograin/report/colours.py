# From radiance and error to colours on a screen: one definition for the PNG files and for the page.
"""Arrays of float in, sRGB-encoded values in [0, 1] out. Needs numpy alone."""

import numpy

ERROR_RANGE = (1e-3, 1.0)
"""Relative error at the two ends of the false colours, which are logarithmic; the same in every picture."""

SIGNED_RANGE = 0.5
"""Relative error at either end of the signed colours, which are linear."""

# Perceptually even, from dark to bright (the 'inferno' map of matplotlib, at ninths); read by eye and by a grey printer
# alike.
_SEQUENTIAL = (
    (0, 0, 4),
    (27, 12, 66),
    (75, 12, 107),
    (120, 28, 109),
    (165, 45, 96),
    (207, 68, 70),
    (237, 105, 37),
    (251, 155, 6),
    (247, 209, 61),
    (252, 255, 164),
)
# Too dark is blue, too bright is red, right is the grey between them.
_DIVERGING = (
    (8, 48, 107),
    (33, 102, 172),
    (67, 147, 195),
    (146, 197, 222),
    (232, 232, 232),
    (244, 165, 130),
    (214, 96, 77),
    (178, 24, 43),
    (103, 0, 31),
)


NOT_FINITE = (0.0, 1.0, 0.6)
"""The false colour of a pixel that holds a NaN or an Inf; no error has it."""


def table(stops, size=256):
    """(size, 3) float table in [0, 1] through evenly spaced stops."""
    stops = numpy.asarray(stops, dtype=float) / 255.0
    at = numpy.linspace(0.0, len(stops) - 1.0, size)
    return numpy.stack([numpy.interp(at, numpy.arange(len(stops)), stops[:, channel]) for channel in range(3)], axis=-1)


SEQUENTIAL = table(_SEQUENTIAL)
DIVERGING = table(_DIVERGING)


def encode_srgb(linear):
    """IEC 61966-2-1, clamped to [0, 1]; NaN is shown black, Inf white."""
    linear = numpy.clip(numpy.nan_to_num(linear, nan=0.0, posinf=1.0, neginf=0.0), 0.0, 1.0)
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)


def expose(pixels, stops):
    """(h, w, 3 or 4) linear radiance, shown at an exposure in stops: (h, w, 3)."""
    return encode_srgb(pixels[..., :3] * 2.0**stops)


def exposure_for(reference, mask=None):
    """Stops, to a tenth, that bring the brightest 0.5 % of the reference's samples to white."""
    samples = reference[..., :3][mask] if mask is not None else reference[..., :3]
    samples = samples[numpy.isfinite(samples)]
    bright = float(numpy.percentile(samples, 99.5)) if samples.size else 0.0
    return round(-float(numpy.log2(bright)), 1) if bright > 1e-12 else 0.0


def relative_error(image, reference, epsilon=0.01):
    """Signed (i - r) / (r + epsilon) of each channel: (h, w, 3) float64."""
    with numpy.errstate(invalid="ignore"):
        difference = image[..., :3].astype(numpy.float64) - reference[..., :3]
        return difference / (numpy.maximum(reference[..., :3], 0.0) + epsilon)


def false_colour(relative):
    """Colours of the channels' mean |relative error|, logarithmic over ERROR_RANGE: (h, w, 3) to (h, w, 3). The size
    is taken before the mean, so that too red and too little blue do not cancel. NaN and Inf get NOT_FINITE."""
    low, high = numpy.log10(ERROR_RANGE)
    size = numpy.abs(relative).mean(axis=-1)
    return _look_up(SEQUENTIAL, (numpy.log10(numpy.maximum(size, 1e-30)) - low) / (high - low))


def signed_colour(relative):
    """Colours of the channels' mean signed relative error, linear over +-SIGNED_RANGE: (h, w, 3) to (h, w, 3). NaN and
    Inf get NOT_FINITE."""
    with numpy.errstate(invalid="ignore"):
        return _look_up(DIVERGING, 0.5 + 0.5 * relative.mean(axis=-1) / SIGNED_RANGE)


def score_colour(score, threshold):
    """Colours of a significance test's scores, linear: strong from the threshold up, pale below it. (h, w) to (h, w,
    3)."""
    relative = score / threshold
    strong = numpy.sign(relative) * (0.5 + 0.2 * numpy.abs(relative))
    return _look_up(DIVERGING, 0.5 + 0.5 * numpy.where(numpy.abs(relative) >= 1.0, strong, 0.2 * relative))


def _look_up(colours, at):
    finite = numpy.isfinite(at)
    index = numpy.rint(numpy.where(finite, at, 0.0) * (len(colours) - 1))
    found = colours[numpy.clip(index, 0, len(colours) - 1).astype(int)]
    return numpy.where(finite[..., None], found, NOT_FINITE)
