# Measures the points of a trade curve, each kept as soon as it is known, so that a stopped run goes on from there.
"""See `measure`."""

import csv
import hashlib
import io
import json
import os
from dataclasses import dataclass, field
from pathlib import Path

import bpy

from ... import native_module
from ...cycles import kinds, nodes, reference
from ...cycles.cache import Cache
from ...report.reading import TRADE_FORMAT
from ...scene import as_rendered, export
from ...schema import labels
from ...schema.models import CHOICES
from ..comparison import definitions, masks, origin
from ..comparison.ours import SHOWN_BEFORE, Ours
from ..comparison.results import Output
from . import curve

RESULTS = "trade.json"
SEED = 11
"""Of the traced renders that are measured; the converged one has others, so that their noise is independent."""

METRICS = ("relative_l1", "relative_l1_blocks", "bias", "rse_mean")
"""What a point keeps of docs/metrics.md beside its error."""

DEFINITIONS = {
    "error": (
        "the metric that judges its kind of reference, the converged render's noise taken off: sqrt(max(0, v^2 -"
        " floor^2)), v = sum |i - r| / sum r, pixel by pixel or in blocks of 8 x 8; 0 is perfect, no unit"
    ),
    "resolved": f"whether the error is above {curve.RESOLVED:g} of the noise floor; if not, it is at most what stands",
    "milliseconds": (
        "ours: that of a frame of one sample and of every further one, light between grains not counted; the path"
        " tracer's: wall-clock time of one render on all cores of the CPU, with the preparation of its scene"
    ),
    "frame_ms": (
        "milliseconds of all passes of a frame, one sample a pixel, on the device named; the median of several"
        " frames after a first one that prepared the device"
    ),
    "further_ms": "the same of a sample that refines such a frame; the median of as many",
    "once_solved": (
        "a picture of one sample that a viewport shows while its camera moves, light between grains being solved; its"
        " milliseconds are those of all passes of such a frame"
    ),
    "in_known_light": (
        f"the same after {SHOWN_BEFORE} samples of the view, from which the light in its grains is known, too"
    ),
    "exchange_ms": "milliseconds that light between grains took to be solved, once before the first sample; 0 if none",
    "from_nothing": (
        "the first picture with light between grains in it, as a viewport shows it that has just been opened: its"
        " milliseconds hold all that had to be found for it"
    ),
    "noise_floor": "the error that a perfect picture would score, because the converged render is noisy itself",
    "front": "no other point is both faster and nearer to the converged render",
}


@dataclass(frozen=True)
class Request:
    """What to measure. reference: a name in `kinds.KINDS`; models: some of those that it answers. samples: a pixel, on
    our side; taps: of model 3. reference_samples: a pixel and seed, of the converged render; traced_samples: of those
    that are measured against it. settings: {material parameter: value}, coefficients in 1/mm. exchange: of the schema's
    choices, or None for the scene's own. command: the line that repeats it."""

    out: Path
    reference: str
    models: tuple
    samples: tuple
    taps: tuple
    reference_samples: int
    traced_samples: tuple
    size: tuple
    frames: int = 25
    settings: dict = field(default_factory=dict)
    exchange: str = None
    cache: Cache = field(default_factory=Cache)
    command: str = ""


def measure(request, progress):
    """Measures a Request in Blender's current scene, as it renders, and writes trade.json, trade.csv and EXR files into
    its folder; returns what trade.json holds. Points that the folder has already, measured alike, are not measured
    again.

    progress: a `comparison.progress.Progress`. Raises OutputError if the folder cannot be written, ReferenceError or
    StageError if Cycles cannot render, native.Error or Unavailable if nothing can be drawn.
    """
    with as_rendered.depsgraph(bpy.context) as depsgraph:
        return _measure(request, depsgraph, progress)


def _measure(request, depsgraph, progress):
    native = native_module.get()
    output = Output(request.out)
    overrides = export.overrides(request.settings, bpy.context.scene)
    ours = Ours(depsgraph, request.size, overrides, parts=1, exchange=request.exchange)
    for warning in ours.warnings:
        progress.say(warning)
    progress.plan(_steps(request))

    def traced(samples, seeds):
        sampling = reference.Sampling(depsgraph, kind.name, request.size, samples, request.cache, overrides)
        progress.begin()
        sampling.add(seeds, progress.update)
        rendered = sampling.result()
        progress.end(learn=not rendered.cached)
        return rendered, sampling

    kind = kinds.KINDS[request.reference]
    truth, sampling = traced(request.reference_samples, reference.SEEDS)
    mirror = None
    if kind.smooth_interface:
        suns = [(direction, angle) for direction, angle, _ in ours.suns(kind.least_sun)]
        mirror = masks.mirror_patch(sampling.geometry()[1], suns)
    mask = masks.select((), truth.mean, truth, mirror)[0]
    chosen = kinds.our_side(request.reference, nodes.features())
    results = {
        "format": TRADE_FORMAT[0],
        "format_version": TRADE_FORMAT[1],
        "complete": False,
        **origin.describe(request.command, request.size),
        "settings": {
            **origin.COMMON_SETTINGS,
            "frames_timed": request.frames,
            "exchange": ours.exchange,
        },
        "definitions": {**DEFINITIONS, **{name: definitions.definition(name) for name in METRICS}},
        "material": ours.parameters(chosen, kind.direct),
        "reference": {
            "kind": kind.name,
            "title": kind.title,
            "tracer": kind.tracer,
            "judged_by": kind.judged_by,
            "samples": request.reference_samples,
            "seeds": list(reference.SEEDS),
            "bounces": kind.bounces,
            "seconds": round(truth.seconds, 3),
            "notes": list(truth.notes),
        },
        "points": [],
        **{of: [] for of in curve.SHOWN},
    }
    book = _Book(results, output, truth, mask, _fingerprint(request, results, truth))

    provenance = {
        "made_by": f"Mesograin {native.__version__}",
        "scene": origin.scene_name(),
        "created_by": request.command,
    }
    book.picture("reference", truth.mean, provenance)
    for model in request.models:
        for taps in request.taps if CHOICES[model].taps else (None,):
            _measure_model(request, ours, {"model": model, **chosen}, taps, book, progress, provenance)
    # Cycles starts with its first render in a process: no point's time holds that.
    started = kind.referee or not truth.cached
    for samples in request.traced_samples:
        name = f"{'photon' if kind.referee else 'cycles'}.samples{samples}"
        if book.has(name):
            progress.begin()
            progress.end(learn=False)
            continue
        if not started:
            reference.render(depsgraph, kind.name, (8, 8), samples=1, seeds=(SEED,), overrides=overrides)
            started = True
        rendered, _ = traced(samples, (SEED,))
        book.picture(name, rendered.images[0], {**provenance, "traced": rendered.provenance[0]})
        book.add(name, rendered.images[0], side="traced", model=kind.tracer, taps=None, samples=samples,
                 milliseconds=1000.0 * rendered.seconds)
    book.finish()
    return results


def _measure_model(request, ours, chosen, taps, book, progress, provenance):
    """The points of one model (and number of taps) at every number of samples: one picture that is refined."""
    progress.begin()
    model = chosen["model"]
    setting = f"{model}.taps{taps}" if taps else model
    names = {f"{setting}.samples{count}": count for count in request.samples}
    missing = {name: count for name, count in names.items() if not book.has(name)}
    shown = {of: book.has_shown(of, setting) for of in curve.SHOWN}
    if not missing:
        progress.end(learn=False)
        return
    kind = kinds.KINDS[request.reference]

    begins = (chosen, kind.least_sun, taps)
    ways = {
        "once_solved": lambda: ours.once_solved(request.frames, *begins),
        "in_known_light": lambda: ours.in_known_light(request.frames, *begins),
        "from_nothing": lambda: ours.from_nothing(*begins),
    }
    for of, way in ways.items():
        measured = None if kind.direct or shown[of] else way()
        if measured is not None:
            milliseconds, image = measured
            picture = f"{setting}.{of}"
            book.picture(picture, image, {**provenance, "model": model, "samples": 1, "taps": taps})
            book.add_shown(of, setting, image, picture, side="mesograin", model=model, taps=taps, samples=1,
                           milliseconds=milliseconds)
    ours.begin(*begins, kind.direct)
    images = {}
    for name, count in missing.items():
        (images[name],) = ours.refine(count)
        book.picture(name, images[name], {**provenance, "model": model, "samples": count, "taps": taps})
        progress.update(count / (request.samples[-1] + 2 * request.frames))
    frame_ms, passes = ours.time_frames(request.frames)
    further_ms = ours.time_further(request.frames)
    solved = ours.exchanged
    exchange_ms = solved["milliseconds"] if solved else 0.0
    for name, count in missing.items():
        book.add(name, images[name], side="mesograin", model=model, taps=taps, samples=count,
                 milliseconds=frame_ms + (count - 1) * further_ms, frame_ms=frame_ms, further_ms=further_ms,
                 exchange_ms=exchange_ms, frames_timed=request.frames, passes_ms=passes)
    progress.end()


class _Book:
    """The points so far, on disk after each; those of an earlier run that was determined by the same are taken over."""

    def __init__(self, results, output, truth, mask, fingerprint):
        self._results, self._output, self._truth, self._mask = results, output, truth, mask
        results["fingerprint"] = fingerprint
        # Here, because a run that takes over every point measures nothing else.
        itself = native_module.get().compare(truth.mean, *truth.images, mask=mask)
        results["reference"]["noise_floor"] = itself["noise_floor"][results["reference"]["judged_by"]]
        results["reference"]["mask"] = itself["mask"]
        self._known = {"points": {}, **{of: {} for of in curve.SHOWN}}
        try:
            earlier = json.loads((output.folder / RESULTS).read_text(encoding="utf-8"))
            if earlier.get("fingerprint") == fingerprint:
                self._known = {of: {point["name"]: point for point in earlier[of]} for of in self._known}
        except (OSError, ValueError, KeyError, AttributeError, TypeError):
            pass  # nothing there, or nothing of ours

    def has(self, name):
        """Whether a point was measured before and its picture is there; if so, it is taken over."""
        return self._has(name, "points")

    def has_shown(self, of, setting):
        """The same of a setting's picture of one sample; of: a key of `curve.SHOWN`."""
        return self._has(setting, of)

    def _has(self, name, of):
        known = self._known[of]
        if name not in known or not (self._output.folder / known[name]["picture"]).is_file():
            return False
        if known[name] not in self._results[of]:
            self._results[of].append(known[name])
            self._write()
        return True

    def picture(self, name, pixels, provenance):
        self._output.write_exr(f"pictures/{name}.exr", pixels, provenance)

    def add(self, name, image, **point):
        self._results["points"].append(self._judged(name, image, name, point))
        self._write()

    def add_shown(self, of, setting, image, picture, **point):
        self._results[of].append(self._judged(setting, image, picture, point))
        self._write()

    def _judged(self, name, image, picture, point):
        metrics = native_module.get().compare(image, *self._truth.images, mask=self._mask)
        kept = {name: metrics[name] for name in METRICS}
        judged_by = self._results["reference"]["judged_by"]
        return {"name": name, **point, **curve.place(metrics, metrics["noise_floor"], judged_by), "metrics": kept,
                "picture": f"pictures/{picture}.exr"}

    def finish(self):
        self._results["complete"] = True
        self._write()

    def _write(self):
        points = self._results["points"]
        order = curve.front(points)
        self._results["front"] = [points[at]["name"] for at in order]
        self._results["summary"] = curve.summary(points)
        self._results["summary_shown"] = [curve.shown(of, point, points)
                                          for of in curve.SHOWN for point in self._results[of]]
        self._output.write_text(RESULTS, json.dumps(self._results, indent=1, allow_nan=False) + "\n")
        self._output.write_text("trade.csv", _csv(points, set(self._results["front"])))


def _fingerprint(request, results, truth):
    """Of all that determines a point's numbers: the converged render's own keys hold the scene and its materials."""
    described = [
        TRADE_FORMAT,
        [shot["key"] for shot in truth.provenance],
        results["material"],
        results["versions"],
        results["device"]["renderer"],
        results["cpu"],
        request.frames,
        results["settings"]["exchange"],
    ]
    return hashlib.sha256(json.dumps(described, sort_keys=True).encode()).hexdigest()


def _csv(points, on_front):
    columns = ("name", "side", "model", "taps", "samples", "milliseconds", "frame_ms", "further_ms", "error",
               "resolved")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*columns, *METRICS, "front"])
    for point in points:
        writer.writerow([*(point.get(name) for name in columns), *(point["metrics"][name] for name in METRICS),
                         point["name"] in on_front])
    return text.getvalue()


def _steps(request):
    """The converged render, ours, then the traced ones: (what, kind, guessed seconds) each."""
    kind = kinds.KINDS[request.reference]
    million = request.size[0] * request.size[1] * 1e-6 / (os.cpu_count() or 1)
    yield "converged render", "traced", 2 * kind.cost * request.reference_samples * million
    for model in request.models:
        for taps in request.taps if CHOICES[model].taps else (None,):
            frames = request.samples[-1] + 2 * request.frames
            what = labels.of_model(model) + (f", {taps} taps" if taps else "")
            yield what, f"{model} {taps}", (0.3 + 0.3 * (taps or 0)) * frames * million
    for samples in request.traced_samples:
        yield f"{kind.tracer} at {samples} samples", "traced", kind.cost * samples * million
