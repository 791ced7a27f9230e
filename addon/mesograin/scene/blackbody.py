# The colour of what glows as hot as it is told, as Cycles' Blackbody node has it: of luminance 1.
import numpy as np

COLDEST, HOTTEST = 800.0, 12000.0
"""Kelvin between which Cycles tells colours apart."""

# Linear RGB that Cycles 3.4.1 shows, evenly from the hottest to the coldest by the inverse of the temperature, by which
# colours change about evenly: between two they are within 0.006 of straight.
_SHOWN = np.array((
    (0.8263, 0.9945, 1.5663), (0.9309, 0.9926, 1.2763), (1.0507, 0.9833, 1.0197), (1.1850, 0.9653, 0.8012),
    (1.3288, 0.9403, 0.6211), (1.4791, 0.9104, 0.4745), (1.6339, 0.8764, 0.3551), (1.7938, 0.8387, 0.2598),
    (1.9557, 0.7983, 0.1829), (2.1191, 0.7558, 0.1217), (2.2836, 0.7118, 0.0731), (2.4490, 0.6665, 0.0345),
    (2.6151, 0.6204, 0.0036), (2.7789, 0.5739, 0.0000), (2.9423, 0.5272, 0.0000), (3.1040, 0.4806, 0.0000),
    (3.2643, 0.4340, 0.0000), (3.4223, 0.3879, 0.0000), (3.5783, 0.3422, 0.0000), (3.7310, 0.2972, 0.0000),
    (3.8809, 0.2529, 0.0000), (4.0285, 0.2092, 0.0000), (4.1722, 0.1667, 0.0000), (4.3126, 0.1249, 0.0000),
    (4.4493, 0.0843, 0.0000), (4.5826, 0.0446, 0.0000), (4.7129, 0.0058, 0.0000), (4.8387, 0.0000, 0.0000),
    (4.9611, 0.0000, 0.0000), (5.0795, 0.0000, 0.0000), (5.1942, 0.0000, 0.0000), (5.3056, 0.0000, 0.0000),
    (5.4139, 0.0000, 0.0000),
))


def colour(kelvin):
    """(n, 3) linear RGB of (n,) temperatures."""
    inverse = 1.0 / np.clip(kelvin, COLDEST, HOTTEST)
    at = np.linspace(1.0 / HOTTEST, 1.0 / COLDEST, len(_SHOWN))
    return np.stack([np.interp(inverse, at, channel) for channel in _SHOWN.T], axis=1)
