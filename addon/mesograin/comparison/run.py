# Runs a comparison: every case by itself, its results written as soon as they are known.
"""See `compare`."""

import datetime
import os
import platform
import time
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy

from .. import __version__, native_module
from ..cycles import kinds, nodes, reference
from ..cycles.cache import Cache
from ..cycles.stage import StageError
from ..report import colours
from . import definitions
from .ours import Ours
from .results import Output

FORMAT = "mesograin-results"
FORMAT_VERSION = 1


@dataclass(frozen=True)
class Case:
    """One model against one kind of reference."""

    model: str
    reference: str

    @property
    def name(self):
        return f"{self.model}.{self.reference}"


@dataclass(frozen=True)
class Request:
    """What to compare. settings: {material parameter: value} for every material on both sides, coefficients in 1/mm.
    size: (width, height), or None for the scene's. reference_samples: per pixel and seed, None for the kind's default.
    references: names in `kinds.KINDS`, or None for each model's default. command: the line that repeats it."""

    models: tuple
    out: Path
    references: tuple = None
    size: tuple = None
    samples: int = 64
    reference_samples: int = None
    settings: dict = field(default_factory=dict)
    frames: int = 9
    cache: Cache = field(default_factory=Cache)
    command: str = ""


def cases(models, references=None):
    """The cases asked for: each model with each of `references` that answers it, or with its default one."""
    found = []
    for model in dict.fromkeys(models):
        if references is None:
            found.append(Case(model, kinds.default_kind(model)))
        else:
            found += [Case(model, kind) for kind in dict.fromkeys(references) if model in kinds.KINDS[kind].models]
    return found


def compare(request, progress):
    """Compares every case of a Request in Blender's current scene and writes its files; returns the results.

    A case that fails is recorded with its sentence and the others go on. progress: a `progress.Progress`.
    Raises OutputError if the folder cannot be written, native.Error or Unavailable if nothing can be rendered.
    """
    native = native_module.get()
    scene = bpy.context.scene
    output = Output(request.out)
    size = request.size or _size(scene)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    overrides = _per_unit(request.settings, scene.mesograin.millimetres_per_unit)
    ours = Ours(depsgraph, size, overrides)
    for warning in ours.warnings:
        progress.say(warning)

    planned = cases(request.models, request.references)
    progress.plan(step for case in planned for step in _steps(case, request, size))
    results = {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "complete": False,
        "created": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "command": request.command,
        "scene": _scene_name(),
        "size": list(size),
        "versions": _versions(),
        "device": native.device_info(),
        "cpu": {"cores": os.cpu_count(), "machine": platform.machine(), "name": _processor()},
        "settings": {
            "samples": request.samples,
            "pixel_filter": "box, one pixel, on both sides",
            "colour_space": "linear, scene-referred",
            "material_settings": {
                name: list(value) if isinstance(value, tuple) else value for name, value in request.settings.items()
            },
        },
        "definitions": definitions.OTHERS,
        "cases": [],
    }
    comparison = _Comparison(request, depsgraph, size, overrides, ours, output, progress)
    for case in planned:
        results["cases"].append(comparison.record(case))
        names = {name for done in results["cases"] for name in done.get("metrics", ())}
        results["definitions"] = definitions.all_definitions(sorted(names))
        output.write_results(results)
    results["complete"] = True
    output.write_results(results)
    return results


def _steps(case, request, size):
    """The reference, then ours: (what, kind, guessed seconds) each."""
    kind = kinds.KINDS[case.reference]
    samples = request.reference_samples or kind.samples
    million = size[0] * size[1] * 1e-6
    cores = os.cpu_count() or 1
    rendered = kind.cost * samples * len(reference.SEEDS)
    if kind.coverage_pass:
        rendered += kinds.COVERAGE.cost * kinds.COVERAGE.samples
    yield f"{case.model}: reference ({case.reference})", case.reference, rendered * million / cores
    yield f"{case.model}: our picture", case.model, 0.3 * request.samples * million / cores


@dataclass
class _Comparison:
    """What all cases of one run share."""

    request: Request
    depsgraph: object
    size: tuple
    overrides: dict
    ours: Ours
    output: Output
    progress: object

    def record(self, case):
        """The case's entry in the results, whether it succeeds or not."""
        native = native_module.get()
        chosen = {"model": case.model, **kinds.our_side(case.reference, nodes.features())}
        entry = {
            "name": case.name,
            "scene": _scene_name(),
            "model": case.model,
            "reference": case.reference,
            "reference_title": kinds.KINDS[case.reference].title,
            "boundary": chosen.get("boundary", ""),
            "material": {name: _plain(values) for name, values in self.ours.parameters(chosen).items()},
            "versions": _versions(),
            "status": "done",
        }
        before = self.progress.steps_begun
        try:
            entry.update(self._measure(case, chosen))
        except (reference.ReferenceError, StageError, native.Error, RuntimeError, MemoryError, ValueError) as error:
            entry["status"] = "failed"
            entry["error"] = " ".join(str(error).split()) or type(error).__name__
            self.progress.skip_to(before + 2)
            self.progress.say(f"{case.name} failed: {entry['error']}")
        return entry

    def _measure(self, case, chosen):
        native = native_module.get()
        kind = kinds.KINDS[case.reference]
        samples = self.request.reference_samples or kind.samples
        self.progress.begin()
        theirs = reference.render(
            self.depsgraph,
            case.reference,
            self.size,
            samples=samples,
            cache=self.request.cache,
            overrides=self.overrides,
            on_progress=self.progress.update,
        )
        self.progress.end(learn=not theirs.cached)
        self.progress.begin()
        started = time.monotonic()
        image = self.ours.render(chosen, self.request.samples)
        our_seconds = time.monotonic() - started
        frame_ms, passes = self.ours.time_frames(self.request.frames)
        self.progress.end()
        metrics = native.compare(image, *theirs.images)
        split = {name: metrics.pop(name) for name in ("noise_floor", "mask", "epsilon", "block_size")}
        return {
            "metrics": metrics,
            "noise_floor": split["noise_floor"],
            "mask": split["mask"],
            "epsilon": split["epsilon"],
            "block_size": split["block_size"],
            "samples": self.request.samples,
            "our_seconds": round(our_seconds, 4),
            "frame_ms": round(frame_ms, 4),
            "frames_timed": self.request.frames,
            "passes_ms": {name: round(milliseconds, 4) for name, milliseconds in passes},
            "reference_samples": samples,
            "reference_seeds": list(reference.SEEDS),
            "reference_seconds": round(theirs.seconds, 3),
            "reference_cached": theirs.cached,
            "reference_bounces": kind.bounces,
            "notes": list(theirs.notes),
            **self._write(case, chosen, image, theirs),
        }

    def _write(self, case, chosen, image, theirs):
        """The case's pictures; returns {"files", "exposure_stops"}."""
        native = native_module.get()
        mean = theirs.mean
        difference = native.error_image(image, *theirs.images, metric="e")
        mask = native.default_mask(mean[..., 3])
        stops = colours.exposure_for(mean, mask if mask.any() else None)
        shown = mask[..., None]
        relative = colours.relative_error(image, mean)
        common = {"made_by": f"Mesograin {__version__}", "scene": _scene_name(), "created_by": self.request.command}
        ours = {
            **common,
            "model": case.model,
            "samples": self.request.samples,
            "materials": {name: _plain(values) for name, values in self.ours.parameters(chosen).items()},
            "units": "coefficients per scene unit; pixels are linear radiance, alpha is coverage, premultiplied",
            "device": native.device_info()["renderer"],
        }
        error = {**common, "definition": "i - r: our image less the mean of the reference's seeds, linear radiance"}
        write_exr, write_png = self.output.write_exr, self.output.write_png
        files = {
            "model": write_exr(f"{case.name}/model.exr", image, ours),
            "reference": write_exr(f"{case.name}/reference.exr", mean, {**common, "mean_of": theirs.provenance}),
            "error": write_exr(f"{case.name}/error.exr", difference, error),
            "model_png": write_png(f"{case.name}/model.png", colours.expose(image, stops)),
            "reference_png": write_png(f"{case.name}/reference.png", colours.expose(mean, stops)),
            "error_png": write_png(f"{case.name}/error.png", shown * colours.false_colour(relative)),
            "signed_error_png": write_png(f"{case.name}/signed_error.png", shown * colours.signed_colour(relative)),
        }
        return {"files": files, "exposure_stops": stops}


def _plain(parameters):
    return {name: list(value) if isinstance(value, tuple) else value for name, value in parameters.items()}


def _per_unit(settings, millimetres_per_unit):
    """Settings with coefficients per scene unit, as material values have them."""
    return {
        name: tuple(channel * millimetres_per_unit for channel in value) if name in ("sigma_a", "sigma_s") else value
        for name, value in settings.items()
    }


def _size(scene):
    share = scene.render.resolution_percentage / 100.0
    return max(1, int(scene.render.resolution_x * share)), max(1, int(scene.render.resolution_y * share))


def _scene_name():
    return Path(bpy.data.filepath).name if bpy.data.filepath else "unsaved"


def _versions():
    return {
        "mesograin": __version__,
        "blender": f"{bpy.app.version_string} ({bpy.app.build_hash.decode('ascii', 'replace')})",
        "python": platform.python_version(),
        "numpy": numpy.__version__,
    }


def _processor():
    """The CPU's name, where the system tells."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "")
    except OSError:
        return ""
