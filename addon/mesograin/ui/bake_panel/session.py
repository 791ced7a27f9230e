# The one bake that may be under way in this Blender, and what came of the last one.
"""See `Bake`, and `compared.ComparedBake` for one that Cycles takes part in."""

import threading
import time
from pathlib import Path

import bpy

from ... import native_module
from ...cycles import reference_cache
from ...scene import as_rendered
from ...studies.baking import surface
from ...studies.comparison.progress import duration
from ..side_task.session import Session
from .compared import ComparedBake
from .properties import USUAL


def refusals():
    """The exceptions that say, in a sentence, why there is no texture."""
    return surface.BakeError, surface.OutputError, native_module.get().Error


class Bake:
    """A texture that is being made: the surface is read at once, and a thread shades and writes it without Blender's
    data. path: where it goes. After the end: `error`, one sentence or empty; `seconds`."""

    detail = ""
    results = None

    def __init__(self, chosen, path, samples, margin, half):
        self.surface, self.path, self.samples = chosen, path, samples
        self._margin, self._half = margin, half
        self.fraction = 0.0
        self.finished = False
        self.error = ""
        self.seconds = 0.0
        self._started = time.monotonic()
        self._thread = threading.Thread(target=self._run, name="mesograin-bake", daemon=True)

    def start(self):
        self._thread.start()

    @property
    def running(self):
        return self._thread.is_alive()

    @property
    def seconds_left(self):
        """None while nothing is known yet."""
        passed = time.monotonic() - self._started
        return passed / self.fraction * (1.0 - self.fraction) if self.fraction > 0.0 else None

    @property
    def cancelled(self):
        return not (self.running or self.finished or self.error)

    @property
    def sentences(self):
        """What the scene has and we leave out."""
        return self.surface.warnings

    @property
    def summary(self):
        width, height = self.surface.size
        return f"{self.path.name}: {self.surface.name}, {width} x {height} texels in {duration(self.seconds)}"

    def cancel(self):
        """Ends it soon, without a file."""
        self.surface.cancel()

    def look(self):
        """Whether the thread, which goes on by itself, has ended."""
        return not self._thread.is_alive()

    def wait(self):
        self._thread.join()

    let_go = wait

    def finish(self):
        """The thread has written the file."""

    def _run(self):
        try:
            self.finished = self.surface.render(self.samples, self._advance)
            if self.finished:
                surface.write(self.path, self.surface.texture(self._margin), self.surface.provenance(self._margin),
                              self._half)
        except refusals() as problem:
            self.finished, self.error = False, str(problem)
        self.seconds = time.monotonic() - self._started

    def _advance(self, fraction):
        self.fraction = fraction


class BakeSession(Session):
    refusals = staticmethod(refusals)

    def launch(self, context):
        bake = prepare(context)
        bake.start()
        return bake

    def start(self, context):
        self.let_go()
        self.task = None  # what is wrong with this one is not said beside what came of another
        super().start(context)

    def finish(self):
        reference_cache.look_again()
        self.task.finish()

    @property
    def results(self):
        """What the last comparison's file of numbers holds; None without one."""
        return self.task.results if self.task is not None else None

    def forget(self):
        bake = self.task
        super().forget()
        if bake is not None:
            bake.let_go()


session = BakeSession("mesograin_bake_progress", {"PROPERTIES"})
register, unregister = session.register, session.unregister


def prepare(context):
    """The Bake or ComparedBake that the scene asks for, not yet started. Raises surface.BakeError, surface.OutputError,
    native.Error or native_module.Unavailable with a sentence."""
    native_module.get()
    asked = context.scene.mesograin_bake
    path = output(context.scene)
    surface.require_writable(path)
    with as_rendered.depsgraph(context) as depsgraph:
        name = surface.choose(depsgraph)
        if asked.compare:
            return _prepare_compared(asked, path, name)
        chosen = surface.Surface(depsgraph, name, (asked.width, asked.height), asked.view_from)
    return Bake(chosen, path, asked.samples, asked.margin, asked.half)


def _prepare_compared(asked, path, name):
    try:
        cache = reference_cache.cache()
    except ValueError as problem:
        raise surface.BakeError(str(problem)) from problem
    return ComparedBake(
        path, name, size=[asked.width, asked.height], samples=asked.samples, view_from=asked.view_from,
        margin=asked.margin, half=asked.half,
        reference=None if asked.reference == USUAL else asked.reference,
        reference_samples=asked.reference_samples or None, cache=str(cache.folder), cache_limit=cache.limit)


def output(scene):
    """The file that a scene asks for. Raises surface.OutputError if it has no folder yet, or is no EXR file."""
    chosen = scene.mesograin_bake.out
    if chosen.startswith("//") and not bpy.data.filepath:
        raise surface.OutputError(
            f"The file is not saved, so {chosen} has no folder: save it, or choose a file elsewhere.")
    path = Path(bpy.path.abspath(chosen)).absolute()
    if path.suffix.lower() != ".exr":
        raise surface.OutputError(f"The texture is OpenEXR and its name must end in .exr; got '{path.name}'.")
    return path
