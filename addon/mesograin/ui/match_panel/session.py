# The one match that may run beside this Blender, and what the last one found.
import json
from pathlib import Path

import bpy

from ... import native_module
from ...studies.background import job as jobs
from ...studies.background.launch import launch
from ...studies.match import files, of_blender
from ...studies.match.run import MatchError
from ...studies.match.target import TargetError
from ..side_task import pictures
from ..side_task.session import Session
from . import properties


class MatchSession(Session):
    """The task is a background.job.Job."""

    results = None
    """What match.json of the last match that ended holds."""
    _seen = 0

    def refusals(self):
        return (MatchError,)

    def launch(self, context):
        scene, material = context.scene, context.material
        if scene.mesograin_match.image is None:
            raise MatchError("No picture is chosen: choose or open one.")
        if not scene.mesograin_match.parameters:
            raise MatchError("Nothing is searched for: choose at least one of sigma_a, sigma_s and g.")
        out = folder(scene)
        try:
            native_module.get()
            of_blender.target(scene.mesograin_match.image)  # what is wrong with it is said at once
            return launch("match", str(out), **properties.arguments(scene), material=material.name_full,
                          memory=str(out))
        except (native_module.Unavailable, TargetError) as problem:
            raise MatchError(str(problem)) from problem
        except (OSError, RuntimeError) as problem:
            reason = getattr(problem, "strerror", None) or " ".join(str(problem).split())
            raise MatchError(f"The match cannot be started: {reason} "
                             f"({getattr(problem, 'filename', None) or out}).") from problem

    def start(self, context):
        super().start(context)
        self.results, self._seen = None, 0

    def has_news(self):
        seen, self._seen = self._seen, self.task.changes
        return seen != self._seen

    def finish(self):
        job = self.task
        self.error = job.error if job.state == jobs.FAILED else ""
        if job.state != jobs.DONE:
            return
        try:
            self.results = json.loads((job.out / files.RESULTS).read_text(encoding="utf-8"))
            pictures.show_all(self.entry, job.out)
        except (OSError, ValueError, RuntimeError) as problem:
            self.error = f"The results in {job.out} cannot be shown: {' '.join(str(problem).split())}"

    @property
    def entry(self):
        """The result as `side_task.pictures` shows it."""
        return {"name": f"match {self.results['material']}", "files": self.results["files"]}

    def forget(self):
        super().forget()
        self.results = None


session = MatchSession("mesograin_match_progress", {"PROPERTIES", "IMAGE_EDITOR"})
register, unregister = session.register, session.unregister


def folder(scene):
    """Where results go: as the scene says, or in this session's temporary folder while the file has no folder."""
    chosen = scene.mesograin_match.out
    if chosen.startswith("//") and not bpy.data.filepath:
        return Path(bpy.app.tempdir) / "match"
    return Path(bpy.path.abspath(chosen)).absolute()
