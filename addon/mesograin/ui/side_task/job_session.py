# The session of a task that is a Blender of its own: where its results go, why it cannot start, what it found.
"""See `JobSession`."""

import json
from pathlib import Path

import bpy

from ... import native_module
from ...studies.background import job as jobs
from .session import Session


class JobSession(Session):
    """The task is a background.job.Job. Beside what a Session says for itself it has `asked_of(scene)`, the settings,
    with an `out`; `begin(context, out)`, which starts the job with results in that folder; and `show(results, folder)`.

    called: the task, as in 'The match cannot be started'. folder: of results, while the file has none. file: of what
    was found. error: the exception of `launch`. others: those of `begin` that say in a sentence what is wrong.
    """

    results = None
    """What the file of the last job that ended well holds."""
    _seen = None

    def __init__(self, progress, shown_in, called, folder, file, error, others=()):
        super().__init__(progress, shown_in)
        self._called, self._folder, self._file, self._error, self._others = called, folder, file, error, others

    def asked_of(self, scene):
        raise NotImplementedError

    def begin(self, context, out):
        raise NotImplementedError

    def show(self, results, folder):
        """Shows the pictures of a job that ended well."""
        raise NotImplementedError

    def folder(self, scene):
        """Where results go: as the scene says, or in this session's temporary folder while the file has no folder."""
        chosen = self.asked_of(scene).out
        if chosen.startswith("//") and not bpy.data.filepath:
            return Path(bpy.app.tempdir) / self._folder
        return Path(bpy.path.abspath(chosen)).absolute()

    def refusals(self):
        return (self._error,)

    def launch(self, context):
        out = self.folder(context.scene)
        try:
            native_module.get()
            return self.begin(context, out)
        except self._error:
            raise
        except (native_module.Unavailable, *self._others) as problem:
            raise self._error(str(problem)) from problem
        except (OSError, RuntimeError) as problem:
            reason = getattr(problem, "strerror", None) or " ".join(str(problem).split())
            raise self._error(f"The {self._called} cannot be started: {reason} "
                              f"({getattr(problem, 'filename', None) or out}).") from problem

    def start(self, context):
        super().start(context)
        self.results, self._seen = None, None

    def has_news(self):
        left = self.task.seconds_left
        seen, self._seen = self._seen, (self.task.changes, left if left is None else round(left))
        return seen != self._seen

    def finish(self):
        job = self.task
        self.error = job.error if job.state == jobs.FAILED else ""
        if job.state != jobs.DONE:
            return
        try:
            self.results = json.loads((job.out / self._file).read_text(encoding="utf-8"))
            self.show(self.results, job.out)
        except (OSError, ValueError, RuntimeError) as problem:
            self.error = f"The results in {job.out} cannot be shown: {' '.join(str(problem).split())}"

    def forget(self):
        super().forget()
        self.results = None
