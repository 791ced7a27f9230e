# Textures of our own that a thread of this Blender makes while the artist goes on.
"""See `Bake`, and `RelitBake` for light from anywhere; `compared.ComparedBake` is the one that Cycles takes part in."""

import threading
import time

from ... import native_module
from ...durations import duration
from ...engine import waiting
from ...studies.baking import relightable, relightable_files, surface


def refusals():
    """The exceptions that say, in a sentence, why there is no texture."""
    return surface.BakeError, surface.OutputError, native_module.get().Error


class _Threaded:
    """path: where it goes. before_first_step: what it does while nobody knows for how long. After the end: `error`, one
    sentence or empty; `seconds`."""

    before_first_step = "First sample"
    detail = ""
    results = None

    def __init__(self, path, margin, half):
        self.path, self._margin, self._half = path, margin, half
        self.fraction = 0.0
        self.finished = False
        self.error = ""
        self.seconds = 0.0
        self._first = None  # (fraction, when it was so much): what must be known before takes as long as it takes
        self._started = time.monotonic()
        self._thread = threading.Thread(target=self._run, name="mesograin-bake", daemon=True)

    def make(self):
        """Shades and writes, in the thread and without Blender's data; returns whether it was not cancelled. Raises
        one of `refusals`."""
        raise NotImplementedError

    def cancel(self):
        """Ends it soon, without a file."""
        raise NotImplementedError

    def start(self):
        self._thread.start()

    @property
    def running(self):
        return self._thread.is_alive()

    @property
    def seconds_left(self):
        """None while nothing is known yet."""
        if self._first is None or self.fraction <= self._first[0]:
            return None
        share, then = self._first
        return (time.monotonic() - then) / (self.fraction - share) * (1.0 - self.fraction)

    @property
    def cancelled(self):
        return not (self.running or self.finished or self.error)

    def look(self):
        """Whether the thread, which goes on by itself, has ended."""
        return not self._thread.is_alive()

    def wait(self):
        self._thread.join()

    let_go = wait

    def finish(self):
        """In Blender's own thread, once the other has ended."""

    def _run(self):
        try:
            self.finished = self.make()
        except refusals() as problem:
            self.error = str(problem)
        self.seconds = time.monotonic() - self._started

    def _advance(self, fraction):
        self._first = self._first or (fraction, time.monotonic())
        self.fraction = fraction


class Bake(_Threaded):
    """A surface under the scene's lights. chosen: the surface.Surface."""

    def __init__(self, chosen, path, samples, margin, half):
        super().__init__(path, margin, half)
        self.surface, self.samples = chosen, samples

    @property
    def before_first_step(self):
        awaited = self.surface.awaited
        return waiting.line(*awaited) if awaited else super().before_first_step

    @property
    def sentences(self):
        """What the scene has and we leave out."""
        return self.surface.warnings

    @property
    def summary(self):
        width, height = self.surface.size
        return f"{self.path.name}: {self.surface.name}, {width} x {height} texels in {duration(self.seconds)}"

    def make(self):
        try:
            if not self.surface.render(self.samples, self._advance):
                return False
            surface.write(self.path, self.surface.texture(self._margin), self.surface.provenance(self._margin),
                          self._half)
            return True
        finally:
            self.surface.let_go()  # what came of it is shown until the next one, or another file

    def cancel(self):
        self.surface.cancel()


class RelitBake(_Threaded):
    """A surface for light from anywhere. chosen: the relightable_bake.RelightableBake."""

    def __init__(self, chosen, path, margin, half):
        super().__init__(path, margin, half)
        self._chosen = chosen
        self.surface = chosen.surface

    @property
    def sentences(self):
        """What the scene has and we leave out, and what the model did not draw."""
        return self._chosen.warnings

    @property
    def summary(self):
        width, height = self.surface.size
        beside = len(relightable_files.paths(self.path)) - 1
        return (f"{self.path.name} and {beside} files beside it: {self.surface.name}, {self._chosen.count} components "
                f"of {width} x {height} texels in {duration(self.seconds)}; {self._chosen.errors_in_words()}")

    def make(self):
        try:
            self._chosen.bake(self._advance)
        except relightable.Cancelled:
            return False
        self._chosen.write(self.path, self._margin, self._half)
        return True

    def cancel(self):
        self._chosen.cancel()

    def finish(self):
        """Writes the node group, which is made of Blender's data."""
        if not self.finished:
            return
        try:
            self._chosen.write_nodes(self.path)
        except surface.OutputError as problem:
            self.finished, self.error = False, str(problem)
