# What of a target counts, by the masks that were asked for.
"""See `keep`."""

import numpy

from .target import TargetError


def keep(masks, whole, small, factor, read):
    """(h, w) bool of `small`, a target.Target made of `whole` by `factor`; None without masks.

    masks: [('crop', (left, top, right, bottom)) or ('file', path)]. read(path, size): (h, w) bool of a picture file.
    Raises TargetError.
    """
    if not masks:
        return None
    kept = numpy.ones(whole.pixels.shape[:2], bool)
    for kind, what in masks:
        kept &= _crop(what, whole.size) if kind == "crop" else read(what, whole.size)
    height, width = small.pixels.shape[:2]
    return kept[:height * factor, :width * factor].reshape(height, factor, width, factor).all(axis=(1, 3))


def _crop(numbers, size):
    left, top, right, bottom = numbers
    if not (left < right <= size[0] and top < bottom <= size[1]):
        raise TargetError(f"crop takes a rectangle within the picture's {size[0]} x {size[1]} pixels, left to right and"
                          f" top to bottom; {left},{top},{right},{bottom} came.")
    kept = numpy.zeros((size[1], size[0]), bool)
    kept[top:bottom, left:right] = True
    return kept
