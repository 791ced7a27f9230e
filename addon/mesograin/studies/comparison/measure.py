# One case from its reference to its numbers: seeds on both sides, the errors, the verdict.
"""See `Measurement` and `measure`."""

import math
import os
import time
from dataclasses import dataclass

import numpy

from ... import native_module
from ...cycles import kinds, reference
from ...schema import labels
from . import controls, masks, profile, significance


@dataclass(frozen=True)
class Measurement:
    """ours: images of independent noise, theirs: the reference, mask: (h, w) bool, the pixels compared.
    numbers: the entry of results.json. scores: (h, w, 3) of the significance test, or None."""

    ours: list
    theirs: reference.Reference
    mask: numpy.ndarray
    numbers: dict
    scores: numpy.ndarray

    @property
    def image(self):
        """Our picture, (h, w, 4) float32: the mean of its parts."""
        return numpy.mean(self.ours, axis=0, dtype=numpy.float64).astype(numpy.float32)


def steps(case, request, size):
    """What `measure` will begin, as `Progress.plan` takes it: (what, kind, guessed seconds) each."""
    model, against = labels.of_model(case.model), case.kind.label
    yield f"{model}: reference ({against})", case.kind.recipe, _guess(case.kind, request, size, request.seeds)
    million = size[0] * size[1] * 1e-6
    yield f"{model}: our picture", case.model, 0.3 * request.samples * million / (os.cpu_count() or 1)
    if request.controls:
        guess = _guess(case.kind, request, size, 2 * request.seeds)
        yield f"{model}: controls of the test ({against})", case.kind.recipe, guess


def _guess(kind, request, size, seeds):
    """Seconds for that many seeds of a reference, before anything was rendered."""
    samples = request.reference_samples or kind.samples
    rendered = kind.cost * samples * seeds
    if kind.coverage_pass:
        rendered += kinds.COVERAGE.cost * kinds.COVERAGE.samples
    return rendered * size[0] * size[1] * 1e-6 / (os.cpu_count() or 1)


def measure(case, chosen, request, depsgraph, size, overrides, ours, progress):
    """A Measurement. chosen: {parameter: value} that make our side solve what the reference solves. ours: `ours.Ours`.

    Raises ReferenceError, StageError, native.Error or progress.Cancelled.
    """
    sampling = reference.Sampling(
        depsgraph, case.reference, size, request.reference_samples, request.cache, overrides, part=case.part
    )
    progress.begin()
    sampling.add(range(1, request.seeds + 1), progress.update)
    theirs = sampling.result()
    progress.end(learn=not theirs.cached)
    progress.begin()
    started = time.monotonic()
    ours.begin(chosen, sampling.kind.least_sun, direct=sampling.kind.direct)
    images = ours.refine(request.samples)
    our_samples = ours.samples
    our_seconds = time.monotonic() - started
    frame_ms, passes = ours.time_frames(request.frames)
    progress.end()
    image = numpy.mean(images, axis=0, dtype=numpy.float64).astype(numpy.float32)
    suns = ours.suns(sampling.kind.least_sun)
    mirror = shape = None
    if sampling.kind.smooth_interface:
        normals, mirrored = sampling.geometry()
        if sampling.kind.light == "all":
            mirror = masks.mirror_patch(mirrored, [(direction, angle) for direction, angle, _ in suns])
    until = None
    if request.until is not None:
        theirs, until = _until(case, request, size, sampling, image, mirror, progress)

    mask, whole, mask_steps = masks.select(request.masks, image, theirs, mirror)
    verdict, scores = significance.test(images, theirs.images, mask)
    control = None
    if request.controls:
        materials = ours.parameters(chosen, sampling.kind.direct)
        control = controls.test(case, request, depsgraph, size, overrides, materials, theirs, mask, progress)
    if sampling.kind.smooth_interface:
        shape = profile.profile(image, theirs.images, mask, normals, suns[0][0])
    numbers = {
        **compare(image, theirs.images, mask),
        "mask_steps": mask_steps,
        "unfiltered": compare(image, theirs.images, whole) if len(mask_steps) > 1 else None,
        "judged_by": sampling.kind.judged_by,
        "channels": _channels(image, theirs.images, mask),
        "profile": shape,
        "our_noise": compare(theirs.mean, images, mask)["noise_floor"],
        "significance": verdict,
        "controls": control,
        "until": until,
        "samples": our_samples,
        "our_seeds": len(images),
        "our_seconds": round(our_seconds, 4),
        "frame_ms": round(frame_ms, 4),
        "frames_timed": request.frames,
        "passes_ms": {name: round(milliseconds, 4) for name, milliseconds in passes.items()},
        "reference_samples": sampling.samples,
        "reference_seeds": list(theirs.seeds),
        "reference_seconds": round(theirs.seconds, 3),
        "reference_cached": theirs.cached,
        "reference_bounces": sampling.kind.longest_path,
        "notes": list(theirs.notes),
    }
    return Measurement(images, theirs, mask, numbers, scores)


def compare(image, references, mask):
    """{'metrics', 'noise_floor', 'mask', 'epsilon', 'block_size'} of docs/metrics.md."""
    metrics = native_module.get().compare(image, *references, mask=mask)
    apart = {name: metrics.pop(name) for name in ("noise_floor", "mask", "epsilon", "block_size")}
    return {"metrics": metrics, **apart}


def _channels(image, references, mask):
    """{'bias', 'relative_l1'} of red, green and blue apart: a shift of colour."""
    parts = [
        compare(image[..., [number]], [each[..., [number]] for each in references], mask)["metrics"]
        for number in range(3)
    ]
    return {name: [part[name] for part in parts] for name in ("bias", "relative_l1")}


def _until(case, request, size, sampling, image, mirror, progress):
    """Adds seeds until the reference's noise is small beside the error; (the reference, entry of results.json)."""
    metric = sampling.kind.judged_by
    while True:
        theirs = sampling.result()
        numbers = compare(image, theirs.images, masks.select(request.masks, image, theirs, mirror)[0])
        noise, error = numbers["noise_floor"][metric], numbers["metrics"][f"{metric}_corrected"]
        ratio = noise / error if noise and error else None
        count = len(theirs.seeds)
        reached = ratio is not None and ratio <= request.until
        if reached or noise is None or noise == 0.0 or count >= request.most_seeds:
            entry = {
                "fraction": request.until,
                "metric": metric,
                "ratio": ratio,
                "reached": reached or noise == 0.0,
                "most_seeds": request.most_seeds,
            }
            return theirs, entry
        wanted = _wanted_seeds(count, ratio, request)
        what = f"{labels.of_model(case.model)}: reference ({case.kind.label}), seeds {count + 1} to {wanted}"
        progress.insert([(what, sampling.kind.recipe, _guess(sampling.kind, request, size, wanted - count))])
        progress.begin()
        sampling.add(range(count + 1, wanted + 1), progress.update)
        progress.end()


def _wanted_seeds(count, ratio, request):
    """How many seeds it takes, as noise falls with the root of their number; at most twice as many in one go."""
    # Bounded, because a tiny fraction overflows when it is squared.
    needed = 2 * count if ratio is None else math.ceil(count * min(ratio / request.until, 1e6) ** 2)
    return min(max(count + 1, min(needed, 2 * count)), request.most_seeds)
