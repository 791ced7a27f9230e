# The one comparison that may run beside this Blender, and what the last one found.
"""A timer looks at the job a few times a second; nothing here waits for it."""

import json
from pathlib import Path

import bpy
from bpy.props import FloatProperty

from .. import native_module, reference_cache, scripting
from ..background import job as jobs
from ..background.launch import launch
from . import pictures, properties

POLL_SECONDS = 0.2
SHOWN_IN = {"PROPERTIES", "IMAGE_EDITOR"}

job = None
"""background.job.Job under way, or the last one; None before the first."""
results = None
"""What results.json of the last comparison that ended holds."""
error = ""
"""Why there is no comparison, one sentence."""
_seen = 0


def start(context):
    """Starts comparing as the scene asks. Raises scripting.ComparisonError with a sentence."""
    global job, results, error, _seen
    scene = context.scene
    arguments = properties.arguments(scene)
    try:
        native_module.get()
        out = folder(scene)
        cache = reference_cache.cache()
        if not arguments["models"]:
            raise scripting.ComparisonError("No model is chosen: choose at least one.")
        started = launch(
            str(out), **arguments, cache=str(cache.folder), cache_limit=cache.limit,
            command=scripting.call(**arguments, out=scene.mesograin_compare.out))
    except (native_module.Unavailable, ValueError) as problem:
        raise scripting.ComparisonError(str(problem)) from problem
    except (OSError, RuntimeError) as problem:
        reason = getattr(problem, "strerror", None) or " ".join(str(problem).split())
        raise scripting.ComparisonError(f"The comparison cannot be started: {reason} "
                                        f"({getattr(problem, 'filename', None) or out}).") from problem
    job, results, error, _seen = started, None, "", 0
    bpy.app.timers.register(_poll, first_interval=POLL_SECONDS)


def folder(scene):
    """Where results go: as the scene says, or in this session's temporary folder while the file has no folder."""
    chosen = scene.mesograin_compare.out
    if chosen.startswith("//") and not bpy.data.filepath:
        return Path(bpy.app.tempdir) / "comparison"
    return Path(bpy.path.abspath(chosen)).absolute()


def running():
    return job is not None and job.state == jobs.RUNNING


def cancel():
    """Ends the comparison under way, if there is one."""
    if job is not None:
        job.cancel()
        _redraw()


def fraction():
    """How much is done, 0 to 1, all steps alike."""
    step = job.step if job is not None else None
    return (step.number - 1 + step.fraction) / step.count if step and step.count else 0.0


def _poll():
    """The timer: redraws what has news, and ends when the job does."""
    global _seen
    if job is None:
        return None
    if job.changes != _seen:
        _seen = job.changes
        _redraw()
    if job.state == jobs.RUNNING:
        return POLL_SECONDS
    _finish()
    _redraw()
    return None


def _finish():
    global results, error
    reference_cache.look_again()
    error = job.error if job.state == jobs.FAILED else ""
    if job.state != jobs.DONE:
        return
    try:
        results = json.loads((job.out / "results.json").read_text(encoding="utf-8"))
        pictures.show_all(results, job.out)
    except (OSError, ValueError, RuntimeError) as problem:
        error = f"The results in {job.out} cannot be shown: {' '.join(str(problem).split())}"


def _redraw():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in SHOWN_IN:
                area.tag_redraw()


@bpy.app.handlers.persistent
def _forget(*_arguments):
    # Another file is another scene: its numbers and pictures are none of this one's.
    global job, results, error
    if job is not None:
        job.cancel()
    job = results = None
    error = ""


def register():
    # A property, because a slider is how Blender before 4.0 draws a bar; it is read from here and cannot be set.
    bpy.types.WindowManager.mesograin_compare_progress = FloatProperty(
        name="Progress", min=0.0, max=100.0, subtype="PERCENTAGE", precision=0, get=lambda _: 100.0 * fraction())
    bpy.app.handlers.load_pre.append(_forget)


def unregister():
    _forget()
    if bpy.app.timers.is_registered(_poll):
        bpy.app.timers.unregister(_poll)
    bpy.app.handlers.load_pre.remove(_forget)
    del bpy.types.WindowManager.mesograin_compare_progress
