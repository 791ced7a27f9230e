# A grain's texture by Mesograin beside the one that Cycles bakes of the material that means the same.
"""See `Pair`, and `bake` for the object's own texture with them."""

import json
import time

from ... import native_module
from ...cycles import kinds, nodes, reference
from ...cycles.unwrapping import Unwrapping
from ...report import colours
from ..comparison import definitions, measure, origin, significance
from ..comparison.ours import SEEDS
from ..comparison.results import Output
from . import surface
from .surface import BakeError, Surface

FORMAT = "mesograin-bake"
FORMAT_VERSION = 1
TEXELS_A_TRIANGLE = 4
"""With fewer, how Cycles samples a texel shows: all within the triangle under its middle. Measured on a sphere, against
a noise floor of 0.04 to 0.12 %: 0.7 % off with one texel for two triangles, 0.2 % with two for one, 0.08 % with
eight."""

ERROR = "i - r: our texture less the mean of the reference's seeds, linear radiance"


class Pair:
    """Both textures of one object of an evaluated scene, ready to bake.

    name: of the object. size: (width, height) in texels. samples: a texel on our side, reference_samples: a texel and
    seed on Cycles' (None: the kind's default). overrides: {parameter: value} for every material, coefficients per
    scene unit. model: of ours, None for the material's. kind: of reference, None for the model's. cache:
    `cycles.cache.Cache`. exchange: of the schema's choices, or None for the scene's own.
    Raises BakeError, ReferenceError or native.Error, before anything is rendered.
    """

    def __init__(self, depsgraph, name, size, samples, view_from, overrides, model, kind, reference_samples, cache,
                 exchange=None):
        model = model or _only_model(depsgraph, name, size, overrides)
        kind = kind or kinds.default_kind(model)
        if model not in kinds.KINDS[kind].models:
            raise BakeError(f"The reference {kind} does not answer {model}: choose another.")
        self._model, self._kind, self._samples = model, kind, samples
        chosen = {"model": model, **kinds.our_side(kind, nodes.features())}
        self._ours = Surface(depsgraph, name, size, view_from, {**overrides, **chosen}, min(SEEDS, samples),
                             "off" if kinds.KINDS[kind].direct else exchange)
        # What Cycles cannot bake at all is an error here; what it can only approximate, a note.
        self._sampling = reference.Sampling(
            depsgraph, kind, size, reference_samples, cache, overrides, Unwrapping(name, view_from))
        self._notes = [*self._sampling.notes, *_coarse(self._ours)]

    @property
    def sentences(self):
        """What the scene has and we leave out, and what Cycles can only approximate."""
        return (*self._ours.warnings, *self._notes)

    @property
    def steps(self):
        """Of `comparison.progress.Progress.plan`."""
        sampling, name = self._sampling, self._ours.name
        rendered = sampling.kind.cost * sampling.samples * len(reference.SEEDS) * million(self._ours.size)
        return [(f"Cycles bakes {name} ({sampling.kind.label})", self._kind, rendered),
                (f"baking {name} as Cycles has it", self._model, our_cost(self._ours.size, self._samples))]

    def bake(self, progress):
        """Begins and ends `steps`; returns (Surface, Reference, mask, results), of which results is JSON-able.
        Raises BakeError, ReferenceError, StageError or native.Error."""
        progress.begin()
        self._sampling.add(reference.SEEDS, progress.update)
        theirs = self._sampling.result()
        progress.end(learn=not theirs.cached)
        progress.begin()
        started = time.monotonic()
        self._ours.render(self._samples, progress.update)
        our_seconds = time.monotonic() - started
        progress.end()
        return self._measure(theirs, our_seconds)

    def _measure(self, theirs, our_seconds):
        parts, texture, mean = self._ours.parts(), self._ours.texture(), theirs.mean
        mask = native_module.get().default_mask(texture[..., 3], 0) & (mean[..., 3] == 1.0)
        if not mask.any():
            raise BakeError(f"No texel of '{self._ours.name}' is covered on both sides: bake a larger texture.")
        numbers = measure.compare(texture, theirs.images, mask)
        verdict, _ = significance.test(parts, theirs.images, mask)
        results = {
            "format": FORMAT,
            "format_version": FORMAT_VERSION,
            "scene": origin.scene_name(),
            "object": self._ours.name,
            "model": self._model,
            "reference": self._kind,
            "reference_title": kinds.KINDS[self._kind].title,
            "judged_by": kinds.KINDS[self._kind].judged_by,
            "view_from": self._ours.view_from,
            "size": list(self._ours.size),
            **numbers,
            "our_noise": measure.compare(mean, parts, mask)["noise_floor"],
            "significance": verdict,
            "material": self._ours.materials,
            "uv_use": self._ours.uv_use,
            "samples": self._ours.samples,
            "our_seeds": len(parts),
            "our_seconds": round(our_seconds, 4),
            "passes_ms": dict(self._ours.timings()),
            "reference_samples": self._sampling.samples,
            "reference_seeds": list(theirs.seeds),
            "reference_seconds": round(theirs.seconds, 3),
            "reference_cached": theirs.cached,
            "notes": self._notes,
            "versions": origin.versions(),
            "device": native_module.get().device_info(),
            "definitions": definitions.all_definitions(sorted(numbers["metrics"])),
        }
        return self._ours, theirs, mask, json.loads(json.dumps(results))


def million(size):
    """How many millions of texels."""
    return size[0] * size[1] * 1e-6


def our_cost(size, samples):
    """Guessed seconds of a texture of ours, for the first estimate of the time left."""
    return 0.3 * samples * million(size)


def bake(path, own, pair, samples, margin, half, progress):
    """Writes the texture that was asked for, the Surface `own`, to `path`, OUT.exr, and those of a Pair beside it.
    Returns (names of all files, results).

    samples: a texel. margin, half: of `own` alone. progress: `comparison.progress.Progress`.
    Raises BakeError, ReferenceError, StageError, OutputError or native.Error.
    """
    for sentence in dict.fromkeys((*own.warnings, *pair.sentences)):
        progress.say(sentence)
    progress.plan([(f"baking {own.name}", "texture", our_cost(own.size, samples)), *pair.steps])
    progress.begin()
    own.render(samples, progress.update)
    progress.end()
    *found, results = pair.bake(progress)
    progress.close()
    surface.write(path, own.texture(margin), own.provenance(margin), half)
    return [path.name, *write(path, *found, results)], results


def write(path, ours, theirs, mask, results):
    """Writes beside `path`, OUT.exr, which is left alone: OUT.mesograin.exr, OUT.cycles.exr, OUT.error.exr, a PNG of
    each, and OUT.json. Returns their names. Raises OutputError."""
    native = native_module.get()
    output = Output(path.absolute().parent)
    names = files(path)
    texture, mean = ours.texture(), theirs.mean
    stops = colours.exposure_for(mean, mask)
    shown = mask[..., None]
    relative = colours.relative_error(texture, mean)
    error = native.error_image(texture, mean, metric="e")
    output.write_exr(names["model"], texture, ours.provenance())
    output.write_exr(names["reference"], mean, {"mean_of": theirs.provenance})
    output.write_exr(names["error"], shown * error, {"definition": ERROR})
    output.write_png(names["model_png"], colours.expose(texture, stops))
    output.write_png(names["reference_png"], colours.expose(mean, stops))
    output.write_png(names["error_png"], shown * colours.false_colour(relative))
    output.write_text(names["results"], json.dumps(results, indent=1, allow_nan=False) + "\n")
    return list(names.values())


def files(path):
    """{what it holds: its name} of the files that `write` puts beside `path`, OUT.exr, which is none of them: our side
    of a comparison has the reference's boundary and no margin, and is not the texture that was asked for."""
    stem = path.name[: -len(path.suffix)]
    return {
        "model": f"{stem}.mesograin.exr",
        "reference": f"{stem}.cycles.exr",
        "error": f"{stem}.error.exr",
        "model_png": f"{stem}.mesograin.png",
        "reference_png": f"{stem}.cycles.png",
        "error_png": f"{stem}.error.png",
        "results": f"{stem}.json",
    }


def _only_model(depsgraph, name, size, overrides):
    models = {values["model"] for values in Surface(depsgraph, name, size, overrides=overrides).materials.values()}
    if len(models) > 1:
        there = ", ".join(sorted(models))
        raise BakeError(f"The materials of '{name}' have several models ({there}): name one, or give all the same.")
    return models.pop()


def _coarse(ours):
    texels = ours.uv_use["texels"]
    if texels < TEXELS_A_TRIANGLE * ours.triangles:
        yield (
            f"'{ours.name}' has {ours.triangles} triangles for {texels} texels, and Cycles takes a texel's samples from"
            " one triangle alone: a larger texture compares more exactly."
        )
