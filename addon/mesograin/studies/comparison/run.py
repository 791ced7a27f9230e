# Runs a comparison: every case by itself, its results written as soon as they are known.
"""See `compare`."""

from dataclasses import dataclass

import bpy

from ... import native_module
from ...cycles import kinds, nodes, reference
from ...cycles.stage import StageError
from ...report.reading import RESULTS_FORMAT
from ...scene import as_rendered, export
from ...schema import labels
from . import controls, definitions, measure, origin, pictures
from .ours import Ours
from .request import Case, Request, cases
from .results import Output

__all__ = ["Case", "Request", "cases", "compare"]


def compare(request, progress):
    """Compares every case of a Request in Blender's current scene, as it renders; writes the files, returns the
    results.

    A case that fails is recorded with its sentence and the others go on. progress: a `progress.Progress`.
    Raises OutputError if the folder cannot be written, native.Error or Unavailable if nothing can be rendered,
    progress.Cancelled after `progress.cancel()`; what was finished stays.
    """
    with as_rendered.depsgraph(bpy.context) as depsgraph:
        return _compare(request, depsgraph, progress)


def _compare(request, depsgraph, progress):
    scene = bpy.context.scene
    output = Output(request.out)
    size = request.size or _size(scene)
    overrides = export.overrides(request.settings, scene)
    ours = Ours(depsgraph, size, overrides, exchange=request.exchange)
    for warning in ours.warnings:
        progress.say(warning)

    planned = cases(request.models, request.references, request.part)
    if request.references is None:
        for model in dict.fromkeys(request.models):
            if not any(case.model == model for case in planned):
                progress.say(f"{labels.of_model(model)} is left out: no reference has a {request.part} part of it.")
    progress.plan(step for case in planned for step in measure.steps(case, request, size))
    results = {
        "format": RESULTS_FORMAT[0],
        "format_version": RESULTS_FORMAT[1],
        "complete": False,
        **origin.describe(request.command, size),
        "settings": {
            **origin.COMMON_SETTINGS,
            "samples": request.samples,
            "exchange": ours.exchange,
            "seeds": request.seeds,
            "until": request.until,
            "masks": [[name, *numbers] for name, numbers in request.masks],
            "material_settings": controls.plain(request.settings),
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
        chosen = {"model": case.model, **kinds.our_side(case.reference, nodes.features(), case.part)}
        entry = {
            "name": case.name,
            "scene": origin.scene_name(),
            "model": case.model,
            "reference": case.reference,
            "reference_title": case.kind.title,
            "part": case.part or "whole",
            "boundary": chosen.get("boundary", ""),
            "own_boundaries": self.ours.replaced("boundary", chosen),
            "material": self._materials(case, chosen),
            "versions": origin.versions(),
            "status": "done",
        }
        left = self.progress.steps_left
        try:
            entry.update(self._measure(case, chosen))
            entry["exchange"] = self.ours.exchanged
            for sentence in self.ours.drawn_otherwise:
                self.progress.say(f"{case.name}: {sentence}")
        except (reference.ReferenceError, StageError, native.Error, RuntimeError, MemoryError, ValueError) as error:
            entry["status"] = "failed"
            entry["error"] = " ".join(str(error).split()) or type(error).__name__
            self.progress.skip_to_last(left - len(list(measure.steps(case, self.request, self.size))))
            self.progress.say(f"{case.name} failed: {entry['error']}")
        return entry

    def _measure(self, case, chosen):
        found = measure.measure(
            case, chosen, self.request, self.depsgraph, self.size, self.overrides, self.ours, self.progress
        )
        ours = {
            "model": case.model,
            "samples": found.numbers["samples"],
            "materials": self._materials(case, chosen),
            "units": "coefficients per scene unit; pixels are linear radiance, alpha is coverage, premultiplied",
            "device": native_module.get().device_info()["renderer"],
        }
        common = {"scene": origin.scene_name(), "created_by": self.request.command}
        return {**found.numbers, **pictures.write(case, found, self.output, common, ours)}

    def _materials(self, case, chosen):
        found = self.ours.parameters(chosen, case.kind.direct)
        return {name: controls.plain(values) for name, values in found.items()}


def _size(scene):
    share = scene.render.resolution_percentage / 100.0
    return max(1, int(scene.render.resolution_x * share)), max(1, int(scene.render.resolution_y * share))
