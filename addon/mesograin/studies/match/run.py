# A match in Blender's current scene, from what was asked for to its files.
"""See `match`."""

import json
from pathlib import Path

import bpy

from ... import native_module
from ...cycles.shot import PROVENANCE, ReferenceError
from ...cycles.stage import StageError
from ...report import colours
from ...scene import as_rendered
from ..comparison import origin
from ..comparison.progress import Calls
from ..comparison.results import Output, OutputError
from . import choices, files, keeping, of_blender, search
from .subject import SubjectError
from .target import TargetError


SENTENCES = (OutputError, SubjectError, TargetError, ReferenceError, StageError)
"""What says by itself what is wrong, beside native.Error."""


class MatchError(RuntimeError):
    """Nothing could be matched; one sentence."""


def match(asked, whole, progress, command, memory=None):
    """Matches Blender's current scene, as it renders, to a target.Target; returns the dict of match.json.

    asked: choices.Asked. memory: folder of what renders came to, None for `asked.out`. Raises OutputError,
    native.Error, SubjectError, TargetError, ReferenceError, StageError or progress.Cancelled.
    """
    native = native_module.get()
    output = Output(asked.out)
    with as_rendered.depsgraph(bpy.context) as depsgraph:
        matched, small, factor, warnings = of_blender.subject(
            depsgraph, asked.material, whole, asked.size, asked.samples, asked.reference)
        for warning in warnings:
            progress.say(warning)
        trace = None
        if asked.corrections:
            trace = of_blender.tracer(depsgraph, whole, small, factor, asked.reference, asked.traced_samples)
        request = search.Request(
            asked.parameters, asked.model or matched.values["model"], asked.exposure == "free",
            keeping.keep(asked.masks, whole, small, factor, of_blender.mask),
            Path(memory or asked.out) / files.RENDERS, asked.corrections, trace)
        progress.plan(search.steps(request, search.guess(matched)), is_guess=True)
        found = search.search(native, matched, small, request, progress)
    for warning in found.warnings:
        progress.say(warning)
    results = files.describe(found, "mm", bpy.context.scene.mesograin.millimetres_per_unit, asked.settings(),
                             picture=whole.name, material=matched.name, **origin.describe(command, small.size))
    stops = colours.exposure_for(found.target, found.mask)
    try:
        files.write(native, output.folder, results, found, PROVENANCE)
    except (OSError, native.Error) as error:
        raise OutputError(" ".join(str(error).split())) from error
    output.write_png(files.BESIDE, files.beside(found, lambda pixels: colours.expose(pixels, stops)))
    return json.loads(json.dumps(results))


def match_image(image, out, memory, on_step, on_sentence, **asked):
    """Matches Blender's current scene to the image of this name. out: folder of the files; memory: as of `match`.
    asked: the rest of choices.Asked. on_step, on_sentence: as of progress.Calls. Raises MatchError."""
    try:
        match(choices.Asked(out=Path(out), **asked), of_blender.target(bpy.data.images[image]),
              Calls(on_step, on_sentence), "Match to Picture", memory)
    except (*SENTENCES, native_module.get().Error) as error:
        raise MatchError(str(error)) from error
