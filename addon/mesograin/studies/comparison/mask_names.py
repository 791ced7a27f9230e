# The masks of a comparison as words, readable without Blender.
"""See `parse`."""

import argparse

NAMES = ("silhouette", "crop", "mean_deviation", "otsu")


class MaskError(argparse.ArgumentTypeError):
    """A mask's name is not understood; one sentence."""


def parse(text):
    """(name, numbers) of 'silhouette:4', 'crop:left,top,right,bottom', 'mean_deviation[:deviations]', 'otsu[:size]'.

    Raises MaskError.
    """
    name, colon, rest = text.partition(":")
    needed = {"silhouette": (1, int), "crop": (4, int), "mean_deviation": (1, float), "otsu": (1, int)}
    if name not in needed:
        raise MaskError(f"a mask is one of {', '.join(NAMES)}; '{text}' came")
    count, kind = needed[name]
    try:
        numbers = tuple(kind(number) for number in rest.split(",")) if colon else ()
    except ValueError:
        numbers = (None,)
    optional = name in ("mean_deviation", "otsu") and not colon
    fits = len(numbers) == count and all(number is not None and number >= 0 for number in numbers)
    if not (fits or optional):
        what = "four whole numbers (left, top, right, bottom)" if name == "crop" else "one number that is not negative"
        raise MaskError(f"{name} takes {what} after a colon; '{text}' came")
    return name, numbers
