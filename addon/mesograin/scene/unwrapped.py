# Which place of a mesh each texel over its UVs shows, so that what nodes make of places can be painted there.
import dataclasses

import numpy as np

MOST_AT_ONCE = 1 << 22  # texels that may be in triangles, tried together
MOST_SHARED = 0.01
"""Of the texels, that more than one triangle may show."""


@dataclasses.dataclass(frozen=True)
class Texels:
    """numbers: (n,) of a picture of side x side texels, row by row, the top one first; places: (n, 3), the mesh's own
    space; uvs: (n, 2)."""

    numbers: np.ndarray
    places: np.ndarray
    uvs: np.ndarray


def texels(mesh, side):
    """Texels of a native.Mesh, or None if it has no UVs, or they are not all within the picture, or lie over each
    other."""
    positions, uvs, triangles = mesh.arrays()
    if len(uvs) == 0 or uvs.min() < -1e-4 or uvs.max() > 1.0 + 1e-4:
        return None
    corners = uvs.astype(np.float64)[triangles] * side - 0.5  # texels' middles are whole numbers; up from the bottom
    first = np.clip(np.ceil(corners.min(axis=1)), 0, side).astype(np.int64)
    size = np.maximum(np.clip(np.floor(corners.max(axis=1)), -1, side - 1).astype(np.int64) - first + 1, 0)
    counts = size[:, 0] * size[:, 1]
    found_numbers, found_triangles, found_weights = [], [], []
    start = 0
    while start < len(triangles):
        stop = max(start + 1, int(np.searchsorted(np.cumsum(counts[start:]), MOST_AT_ONCE)) + start)
        of = np.repeat(np.arange(start, stop), counts[start:stop])
        within = np.arange(len(of)) - np.repeat(np.cumsum(counts[start:stop]) - counts[start:stop], counts[start:stop])
        width = size[of, 0]
        at = first[of] + np.stack((within % np.maximum(width, 1), within // np.maximum(width, 1)), axis=1)
        weights = _weights(corners[of], at)
        inside = (weights >= -1e-9).all(axis=1)
        found_numbers.append((side - 1 - at[inside, 1]) * side + at[inside, 0])
        found_triangles.append(of[inside])
        found_weights.append(weights[inside])
        start = stop
    numbers, of, weights = (np.concatenate(each) for each in (found_numbers, found_triangles, found_weights))
    if len(numbers) == 0:
        return None
    well_inside = numbers[(weights > 1e-3).all(axis=1)]
    kept, first_of = np.unique(numbers, return_index=True)
    if len(well_inside) - len(np.unique(well_inside)) > MOST_SHARED * len(kept):
        return None
    weights = weights[first_of, :, None]
    of = triangles[of[first_of]]
    return Texels(kept, (weights * positions[of]).sum(axis=1), (weights * uvs[of]).sum(axis=1))


def _weights(corners, at):
    """(n, 3) barycentric coordinates of places in triangles; NaN where these have no area."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    to = at - corners[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        second = (to[:, 0] * b[:, 1] - to[:, 1] * b[:, 0]) / area
        third = (a[:, 0] * to[:, 1] - a[:, 1] * to[:, 0]) / area
    return np.stack((1.0 - second - third, second, third), axis=1)
