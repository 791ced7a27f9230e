# The picture that is to be matched: read, made linear, made small.
"""See `Target`, `read` and `of_codes`."""

from dataclasses import dataclass

import numpy

WHITE_CODE = 254.0 / 255.0
"""From here on a code says no more than how much light there was at least."""
LEAST_SIDE = 16
BRIGHT = 0.2


class TargetError(Exception):
    """There is no picture to match; one sentence."""


@dataclass(frozen=True)
class Target:
    """name: for people. pixels: (h, w, 3) float32, linear radiance, row 0 at the top. usable: (h, w) bool, where it
    says something."""

    name: str
    pixels: numpy.ndarray
    usable: numpy.ndarray

    @property
    def size(self):
        """(width, height)."""
        return self.pixels.shape[1], self.pixels.shape[0]

    def reduced(self, longest):
        """(Target, factor): the picture with a whole number of its pixels a side in each, so that none of its sides is
        longer than `longest`. What is left over at its right and lower edges is cut off."""
        factor = -(-max(self.size) // longest)
        height, width = (side // factor for side in self.pixels.shape[:2])
        shape = height, factor, width, factor
        cut = self.pixels[:height * factor, :width * factor].reshape(*shape, 3)
        usable = self.usable[:height * factor, :width * factor].reshape(shape)
        with numpy.errstate(invalid="ignore"):
            means = cut.mean(axis=(1, 3), dtype=numpy.float64).astype(numpy.float32)
        return Target(self.name, means, usable.all(axis=(1, 3))), factor


def _target(name, pixels, usable):
    if min(pixels.shape[:2]) < LEAST_SIDE:
        raise TargetError(f"{name} is {pixels.shape[1]} x {pixels.shape[0]} pixels; at least {LEAST_SIDE} a side are"
                          " needed to match it.")
    return Target(name, numpy.ascontiguousarray(pixels, numpy.float32), usable & numpy.isfinite(pixels).all(axis=-1))


def linear(name, pixels):
    """The Target of linear radiance, (h, w, 3) or, premultiplied by coverage, (h, w, 4). Raises TargetError."""
    pixels = numpy.asarray(pixels)
    if pixels.ndim != 3 or pixels.shape[2] not in (3, 4):
        raise TargetError(f"{name} must be a picture of 3 or 4 channels; its shape is {pixels.shape}.")
    return _target(name, pixels[..., :3], numpy.ones(pixels.shape[:2], bool))


def of_codes(name, codes):
    """The Target of sRGB codes in [0, 1], (h, w, 3 or 4), as photographs have them (IEC 61966-2-1); what is white is
    not usable, for nobody knows how white. Raises TargetError."""
    codes = numpy.asarray(codes)[..., :3].astype(numpy.float64)
    straight = codes <= 0.04045
    pixels = numpy.where(straight, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    return _target(name, pixels, (codes < WHITE_CODE).all(axis=-1))


def read(native, path):
    """The Target of an EXR file: its channels R, G, B, or the combined pass of a layer. Raises TargetError."""
    try:
        pixels, channels, _ = native.read_exr(str(path))
    except native.Error as error:
        raise TargetError(str(error)) from error
    chosen = _combined([str(name) for name in channels])
    if chosen is None:
        raise TargetError(f"{path} needs the channels R, G and B, alone or of a Combined pass; it has"
                          f" {', '.join(channels)}.")
    return linear(path.name, pixels[..., chosen])


def bright(target, size):
    """(h, w) bool of a mask that was read as a Target: what is bright counts. size: (width, height) that it must have.
    Raises TargetError."""
    if target.size != size:
        raise TargetError(f"The mask {target.name} is {target.size[0]} x {target.size[1]} pixels; the picture is"
                          f" {size[0]} x {size[1]}.")
    return target.pixels.max(axis=-1) > BRIGHT


def _combined(channels):
    """Indices of R, G and B; None if there are none."""
    if {"R", "G", "B"} <= set(channels):
        return [channels.index(letter) for letter in "RGB"]
    for red, name in enumerate(channels):
        layer = name.removesuffix("R")
        if name.endswith("Combined.R") and {f"{layer}G", f"{layer}B"} <= set(channels):
            return [red, channels.index(f"{layer}G"), channels.index(f"{layer}B")]
    return None
