# Both sides as a function of the angle to the light: what a noisy reference can tell of the shape of an error.
"""See `profile`."""

import numpy

BINS = 20


def profile(image, references, mask, normals, direction):
    """Means over the masked pixels in equal bins of cos(n, l), for results.json; empty bins are left out.

    image: (h, w, 4). references: images of independent noise. normals: (h, w, 3). direction: to the strongest sun.
    Returns {'direction_to_light', 'cosine' (of the bin's middle), 'pixels', 'ours', 'reference', 'noise'}; the last
    three are radiance, [r, g, b] for each bin; noise: standard error of the reference, None with one seed.
    """
    direction = numpy.asarray(direction, dtype=float) / numpy.linalg.norm(direction)
    cosine = normals @ direction / numpy.maximum(numpy.linalg.norm(normals, axis=-1), 1e-6)
    bins = numpy.clip(((cosine + 1.0) * (0.5 * BINS)).astype(int), 0, BINS - 1)
    finite = mask & numpy.isfinite(image).all(axis=-1) & numpy.isfinite(references).all(axis=(0, -1))
    found = {"cosine": [], "pixels": [], "ours": [], "reference": [], "noise": []}
    for number in range(BINS):
        inside = finite & (bins == number)
        if not inside.any():
            continue
        seeds = numpy.array([each[inside][:, :3].mean(axis=0, dtype=numpy.float64) for each in references])
        found["cosine"].append(round((number + 0.5) * 2.0 / BINS - 1.0, 6))
        found["pixels"].append(int(inside.sum()))
        found["ours"].append(image[inside][:, :3].mean(axis=0, dtype=numpy.float64).tolist())
        found["reference"].append(seeds.mean(axis=0).tolist())
        noise = seeds.std(axis=0, ddof=1) / len(seeds) ** 0.5 if len(seeds) > 1 else None
        found["noise"].append(None if noise is None else noise.tolist())
    return {"direction_to_light": direction.tolist(), **found}
