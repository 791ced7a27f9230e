# The one comparison that may run beside this Blender, and what the last one found.
import json
from pathlib import Path

import bpy

from ... import native_module
from ...cycles import reference_cache
from ...studies import scripting
from ...studies.background import job as jobs
from ...studies.background.launch import launch
from ..side_task import pictures
from ..side_task.session import Session
from . import properties


class CompareSession(Session):
    """The task is a background.job.Job."""

    results = None
    """What results.json of the last comparison that ended holds."""
    _seen = 0

    def refusals(self):
        return (scripting.ComparisonError,)

    def launch(self, context):
        scene = context.scene
        arguments = properties.arguments(scene)
        try:
            native_module.get()
            out = folder(scene)
            cache = reference_cache.cache()
            if not arguments["models"]:
                raise scripting.ComparisonError("No model is chosen: choose at least one.")
            return launch(
                "compare", str(out), **arguments, cache=str(cache.folder), cache_limit=cache.limit,
                command=scripting.call(**arguments, out=scene.mesograin_compare.out))
        except (native_module.Unavailable, ValueError) as problem:
            raise scripting.ComparisonError(str(problem)) from problem
        except (OSError, RuntimeError) as problem:
            reason = getattr(problem, "strerror", None) or " ".join(str(problem).split())
            raise scripting.ComparisonError(f"The comparison cannot be started: {reason} "
                                            f"({getattr(problem, 'filename', None) or out}).") from problem

    def start(self, context):
        super().start(context)
        self.results, self._seen = None, 0

    def has_news(self):
        seen, self._seen = self._seen, self.task.changes
        return seen != self._seen

    def finish(self):
        job = self.task
        reference_cache.look_again()
        self.error = job.error if job.state == jobs.FAILED else ""
        if job.state != jobs.DONE:
            return
        try:
            self.results = json.loads((job.out / "results.json").read_text(encoding="utf-8"))
            for entry in self.results["cases"]:
                if entry["status"] == "done":
                    pictures.show_all(entry, job.out)
        except (OSError, ValueError, RuntimeError) as problem:
            self.error = f"The results in {job.out} cannot be shown: {' '.join(str(problem).split())}"

    def forget(self):
        super().forget()
        self.results = None


session = CompareSession("mesograin_compare_progress", {"PROPERTIES", "IMAGE_EDITOR"})
register, unregister = session.register, session.unregister


def folder(scene):
    """Where results go: as the scene says, or in this session's temporary folder while the file has no folder."""
    chosen = scene.mesograin_compare.out
    if chosen.startswith("//") and not bpy.data.filepath:
        return Path(bpy.app.tempdir) / "comparison"
    return Path(bpy.path.abspath(chosen)).absolute()
