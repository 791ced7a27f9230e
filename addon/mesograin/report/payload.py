# Packs linear pictures so small that a page can hold them, for a viewer that exposes them itself.
"""See `pack`; the page's script unpacks."""

import base64
import zlib

import numpy

LARGEST = 65504.0
"""The largest finite half; brighter samples are shown, and read out, as this."""


def pack(pixels):
    """(h, w, c) linear channels to text: half floats, channel by channel, all high bytes before all low ones (which
    compresses better), deflated, in base64. NaN stays NaN."""
    halves = numpy.clip(pixels, -LARGEST, LARGEST).astype(">f2")
    planes = numpy.moveaxis(halves, -1, 0)
    octets = numpy.frombuffer(planes.tobytes(), numpy.uint8).reshape(-1, 2)
    return base64.b64encode(zlib.compress(octets.T.tobytes(), 9)).decode("ascii")
