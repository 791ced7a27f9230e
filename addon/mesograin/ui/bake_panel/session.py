# The one bake that may be under way in this Blender, and what came of the last one.
"""See `BakeSession`."""

from pathlib import Path

import bpy

from ... import native_module
from ...cycles import reference_cache
from ...scene import as_rendered
from ...studies.baking import surface
from ...studies.baking.relightable_bake import RelightableBake
from ..side_task.session import Session
from .compared import ComparedBake
from .own import Bake, RelitBake, refusals
from .properties import USUAL


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
    """The Bake, RelitBake or ComparedBake that the scene asks for, not yet started. Raises surface.BakeError,
    surface.OutputError, native.Error or native_module.Unavailable with a sentence."""
    native_module.get()
    asked = context.scene.mesograin_bake
    path = output(context.scene)
    surface.require_writable(path)
    with as_rendered.depsgraph(context) as depsgraph:
        name = surface.choose_active(depsgraph)
        size = asked.width, asked.height
        if asked.relightable:
            relit = RelightableBake(depsgraph, name, size, asked.direction_samples, asked.components)
            return RelitBake(relit, path, asked.margin, asked.half)
        if asked.compare:
            return _prepare_compared(asked, path, name)
        chosen = surface.Surface(depsgraph, name, size, asked.view_from)
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
