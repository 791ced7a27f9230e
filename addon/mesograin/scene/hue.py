# Colours told by hue, saturation and value, as Cycles tells them (util/color.h), each 0 to 1 but the value.
import numpy as np


def split(colours):
    """(hue, saturation, value), each (n,), of (n, 3) linear RGB."""
    most, least = colours.max(axis=1), colours.min(axis=1)
    spread = most - least
    saturation = np.divide(spread, most, out=np.zeros_like(most), where=most != 0.0)
    some = np.where(spread != 0.0, spread, 1.0)
    red, green, blue = ((most - channel) / some for channel in colours.T)
    hue = np.select((colours[:, 0] == most, colours[:, 1] == most), (blue - green, 2.0 + red - blue),
                    4.0 + green - red) / 6.0
    hue = np.where(saturation != 0.0, hue % 1.0, 0.0)
    return hue, saturation, most


def join(hue, saturation, value):
    """(n, 3) linear RGB."""
    sixths = (np.array((5.0, 3.0, 1.0)) + 6.0 * hue[:, None]) % 6.0
    missing = np.clip(np.minimum(sixths, 4.0 - sixths), 0.0, 1.0)
    return value[:, None] * (1.0 - saturation[:, None] * missing)
