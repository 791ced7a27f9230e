# The one bake that may be under way in this Blender, and what came of the last one.
"""The surface is read at once; a thread shades and writes it, without Blender's data, and a timer looks at it."""

import threading
import time
from pathlib import Path

import bpy
from bpy.props import FloatProperty

from .. import native_module
from ..baking import surface

POLL_SECONDS = 0.2

bake = None
"""The Bake under way, or the last one; None before the first."""
error = ""
"""Why there is none, one sentence."""


class Bake:
    """A texture that is being made. path: where it goes. After the end: `error`, one sentence or empty; `seconds`."""

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

    def cancel(self):
        """Ends it soon, without a file."""
        self.surface.cancel()

    def wait(self):
        self._thread.join()

    def _run(self):
        try:
            self.finished = self.surface.render(self.samples, self._advance)
            if self.finished:
                surface.write(self.path, self.surface.texture(self._margin), self.surface.provenance(self._margin),
                              self._half)
        except (surface.BakeError, surface.OutputError, native_module.get().Error) as problem:
            self.finished, self.error = False, str(problem)
        self.seconds = time.monotonic() - self._started

    def _advance(self, fraction):
        self.fraction = fraction


def prepare(context):
    """The Bake that the scene asks for, not yet started. Raises surface.BakeError, surface.OutputError, native.Error or
    native_module.Unavailable with a sentence."""
    native_module.get()
    asked = context.scene.mesograin_bake
    path = output(context.scene)
    surface.require_writable(path)
    depsgraph = context.evaluated_depsgraph_get()
    name = surface.choose(depsgraph)
    chosen = surface.Surface(depsgraph, name, (asked.width, asked.height), asked.view_from)
    return Bake(chosen, path, asked.samples, asked.margin, asked.half)


def start(context):
    """Starts baking beside the artist. Raises as `prepare`."""
    global bake, error
    bake, error = prepare(context), ""
    bake.start()
    bpy.app.timers.register(_poll, first_interval=POLL_SECONDS)


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


def running():
    return bake is not None and bake.running


def cancel():
    """Ends the bake under way, if there is one."""
    if bake is not None:
        bake.cancel()


def _poll():
    _redraw()
    return POLL_SECONDS if running() else None


def _redraw():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()


@bpy.app.handlers.persistent
def _forget(*_arguments):
    global bake, error
    if bake is not None:
        bake.cancel()
        bake.wait()
    bake, error = None, ""


def register():
    # As in the Compare panel: a slider is how Blender before 4.0 draws a bar.
    bpy.types.WindowManager.mesograin_bake_progress = FloatProperty(
        name="Progress", min=0.0, max=100.0, subtype="PERCENTAGE", precision=0,
        get=lambda _: 100.0 * bake.fraction if bake is not None else 0.0)
    bpy.app.handlers.load_pre.append(_forget)


def unregister():
    _forget()
    if bpy.app.timers.is_registered(_poll):
        bpy.app.timers.unregister(_poll)
    bpy.app.handlers.load_pre.remove(_forget)
    del bpy.types.WindowManager.mesograin_bake_progress
