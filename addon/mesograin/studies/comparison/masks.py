# Which pixels are compared: the silhouette, and masks by name, each with the count of what it took away.
"""See `select`. docs/metrics.md defines the masks."""

import numpy

from ... import native_module

SILHOUETTE_RIM = 2
"""Pixels by which the silhouette is shrunk, if no other number is asked for."""

MIRROR_MARGIN = 0.05
"""Radians beyond the sun's disc within which its mirror image on a smooth interface is left out."""


def silhouette(coverage, masks=()):
    """(h, w) bool: covered wholly, less a rim of 2 pixels, or of n if 'silhouette:n' is among `masks`."""
    rims = [numbers[0] for name, numbers in masks if name == "silhouette"]
    return native_module.get().default_mask(coverage, erode=rims[-1] if rims else SILHOUETTE_RIM)


def select(masks, image, theirs, mirror=None):
    """(mask, what the silhouette alone keeps, [{'name', 'pixels', 'removed'}, ...]): masks applied one after another.

    masks: of `mask_names.parse`. image: ours. theirs: Reference. mirror: (h, w) bool, where the sun is seen in a smooth
    interface, or None. The masks that look at the error look at `rse`. Raises native.Error for a crop outside and
    if no pixel is left.
    """
    native = native_module.get()
    coverage = numpy.min([each[..., 3] for each in theirs.images], axis=0)
    whole = silhouette(coverage, masks)
    rim = [numbers[0] for name, numbers in masks if name == "silhouette"] or [SILHOUETTE_RIM]
    steps = [_step(f"silhouette:{rim[-1]}", coverage > 0.0, whole)]
    mask = whole
    if mirror is not None:
        kept = mask & ~mirror
        steps.append(_step("mirror", mask, kept))
        mask = kept
    for name, numbers in masks:
        if name == "silhouette":
            continue
        if name == "crop":
            kept = native.crop_mask(mask, numbers)
        else:
            error = native.error_image(image, theirs.mean, metric="rse")
            kept = (native.mean_deviation_mask if name == "mean_deviation" else native.otsu_mask)(
                error, mask, *numbers
            )
        text = ",".join(f"{number:g}" for number in numbers)
        steps.append(_step(f"{name}:{text}" if text else name, mask, kept))
        mask = kept
    if not mask.any():
        raise native.Error(_nothing_left(coverage, steps))
    return mask, whole, steps


def _nothing_left(coverage, steps):
    """One sentence: which mask took what, and what to do."""
    touched, wholly = int((coverage > 0.0).sum()), int((coverage == 1.0).sum())
    if not touched:
        return "There is no pixel to compare, because the reference shows no grain: point the camera at one."
    took = [f"{step['name']} took {step['removed']}" for step in steps if step["removed"]]
    last = next(step["name"] for step in steps if not step["pixels"])
    if last.startswith("silhouette"):
        cure = "choose a larger picture or a smaller rim, such as silhouette:0, or move the camera nearer"
    else:
        cure = f"widen {last} or leave it out" if last != "mirror" else "turn the sun or the camera"
    return (f"No pixel is left to compare: of {touched} that the grain touches, {wholly} of them wholly, "
            f"{', '.join(took)}: {cure}.")


def _step(name, before, after):
    return {"name": name, "pixels": int(after.sum()), "removed": int(before.sum() - after.sum())}


def mirror_patch(mirrored, suns):
    """(h, w) bool: where the sun's disc is seen mirrored. mirrored: (h, w, 3), the way to the viewer mirrored at the
    normal. suns: [(direction to the light, full angle in radians)]."""
    length = numpy.linalg.norm(mirrored, axis=-1)
    patch = numpy.zeros(mirrored.shape[:2], bool)
    for direction, angle in suns:
        cosine = mirrored @ (numpy.asarray(direction) / numpy.linalg.norm(direction))
        patch |= cosine > numpy.cos(0.5 * angle + MIRROR_MARGIN) * length
    return patch
