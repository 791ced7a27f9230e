# Blender's images as the native module's pictures: read once, as long as anybody holds them, equal by content.
import hashlib
import weakref

import numpy as np

from .. import native_module

_by_image = weakref.WeakValueDictionary()
_by_content = weakref.WeakValueDictionary()
_means = weakref.WeakKeyDictionary()
_grey = weakref.WeakSet()


def picture(image):
    """native.Picture of a bpy.types.Image, or None if it has no pixels. Bytes stay bytes, as Cycles keeps them: they
    are made linear where they are looked up."""
    image = image.original
    width, height = image.size
    if width == 0 or height == 0 or image.channels == 0:
        return None
    # What is painted may change at any time and has no number that says so.
    key = None if image.is_dirty else (image.name_full, image.filepath, width, height, image.source, image.alpha_mode,
                                       image.colorspace_settings.name, tuple(getattr(image, "generated_color", ())),
                                       getattr(image, "generated_type", ""))
    found = key and _by_image.get(key)
    if found is None:
        pixels = _pixels(image, width, height)
        found = made(pixels if image.is_float else np.rint(pixels * 255.0).astype(np.uint8), is_encoded(image))
        if key:
            _by_image[key] = found
    return found


def made(pixels, srgb=False):
    """native.Picture of (h, w, 4) uint8 or float32, row 0 at the top."""
    digest = hashlib.blake2b(np.ascontiguousarray(pixels), digest_size=16)
    digest.update(repr((pixels.shape, pixels.dtype.str, srgb)).encode())
    key = digest.digest()
    found = _by_content.get(key)
    if found is None:
        found = native_module.get().Picture(pixels, srgb)
        _by_content[key] = found
        _means[found] = _mean(pixels, srgb)
        if (pixels[..., :1] == pixels[..., :3]).all():
            _grey.add(found)
    return found


def texels(image):
    """(h, w, 4) float32 of a bpy.types.Image, row 0 at the bottom, or None if it has no pixels."""
    image = image.original
    width, height = image.size
    if width == 0 or height == 0 or image.channels == 0:
        return None
    return _pixels(image, width, height)[::-1]


def is_encoded(image):
    """Whether its numbers are sRGB's: they are interpolated as they are, as Cycles does."""
    return not image.is_float and image.colorspace_settings.name == "sRGB"


def mean(found):
    """Linear RGB of a picture that came from here."""
    return _means[found]


def is_grey(found):
    """Whether R, G and B of a picture that came from here are the same everywhere."""
    return found in _grey


def linear(encoded):
    """sRGB's numbers as linear ones."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((np.maximum(encoded, 0.0) + 0.055) / 1.055) ** 2.4)


def _mean(pixels, srgb):
    colours = pixels.reshape(-1, 4)[:, :3].astype(np.float64)
    if pixels.dtype == np.uint8:
        colours /= 255.0
    return tuple(float(channel) for channel in (linear(colours) if srgb else colours).mean(axis=0))


def _pixels(image, width, height):
    """(h, w, 4) float32, row 0 at the top, as the image holds them; what is transparent is dark, as Cycles has it."""
    pixels = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    pixels = np.nan_to_num(pixels, nan=0.0, posinf=3e38, neginf=0.0).reshape(height, width, image.channels)[::-1]
    colours = np.ones((height, width, 4), dtype=np.float32)
    colours[..., :3] = pixels[..., :3] if image.channels >= 3 else pixels[..., :1]
    if image.channels in (2, 4):
        colours[..., 3] = pixels[..., -1]
        if not image.is_float and image.alpha_mode == "STRAIGHT" and image.colorspace_settings.name == "sRGB":
            colours[..., :3] *= colours[..., 3:]
    return np.clip(colours, 0.0, 1.0) if not image.is_float else colours
