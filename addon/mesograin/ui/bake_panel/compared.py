# An object's texture, and beside it ours and Cycles' of the material that means the same, in a Blender of their own.
"""See `ComparedBake`."""

import json

from ...studies.background import job as jobs
from ...studies.background.launch import launch
from ...studies.baking import comparison
from ...studies.baking.surface import BakeError
from ..side_task import pictures


class ComparedBake:
    """Textures that are being made. path: where the object's own goes, those that are compared beside it. name: of the
    object. arguments: of `baking.beside.bake`, but for what these and the folders say. results: what OUT.json holds,
    once it was finished."""

    def __init__(self, path, name, **arguments):
        self.path, self.name = path, name
        self.results = None
        self._arguments = arguments
        self._job = None
        self._problem = ""

    def start(self):
        """Raises BakeError if nothing can be started."""
        try:
            self._job = launch("bake", self.path.parent, name=self.name, file=self.path.name, **self._arguments)
        except (OSError, RuntimeError) as problem:
            reason = getattr(problem, "strerror", None) or " ".join(str(problem).split())
            raise BakeError(f"The comparison cannot be started: {reason} "
                            f"({getattr(problem, 'filename', None) or self.path.parent}).") from problem

    @property
    def running(self):
        return self._job.running

    @property
    def fraction(self):
        return self._job.fraction

    @property
    def before_first_step(self):
        """What is said while nobody knows how long it takes."""
        return self._job.unknown

    @property
    def seconds_left(self):
        """None while nothing is known yet."""
        return self._job.seconds_left

    @property
    def detail(self):
        """What is under way, in words."""
        step = self._job.step
        return f"{step.number} of {step.count}: {step.what}" if step else ""

    @property
    def error(self):
        """One sentence, or empty."""
        return self._problem or (self._job.error if self._job.state == jobs.FAILED else "")

    @property
    def finished(self):
        return self.results is not None

    @property
    def cancelled(self):
        return self._job.state == jobs.CANCELLED

    @property
    def sentences(self):
        """What the scene has and we leave out, and what Cycles can only approximate."""
        return self._job.sentences

    @property
    def summary(self):
        width, height = self.results["size"]
        return f"{self.path.name}, and Mesograin's and Cycles' beside it: {self.name}, {width} x {height} texels"

    @property
    def entry(self):
        """The result as `side_task.results` draws it."""
        return {**self.results, "status": "done", "name": f"bake {self.name}", "files": comparison.files(self.path)}

    def cancel(self):
        """Ends it at once, without a file; references that were rendered stay in the cache."""
        self._job.cancel()

    def look(self):
        """As background.job.Job."""
        return self._job.look()

    def let_go(self):
        """After a cancel: the process is looked after until its end, and nobody waits for it."""

    def wait(self):
        self._job.wait()

    def finish(self):
        """In Blender's own thread, once it has ended: reads the results and shows the pictures."""
        if self._job.state != jobs.DONE:
            return
        try:
            self.results = json.loads((self.path.parent / comparison.files(self.path)["results"]).read_text("utf-8"))
            pictures.show_all(self.entry, self.path.parent)
        except (OSError, ValueError, RuntimeError) as problem:
            self.results = None
            self._problem = f"The results in {self.path.parent} cannot be shown: {' '.join(str(problem).split())}"
