# Lets Python write again where a render has left Blender refusing it to timers for good.
"""Around each call of a class written in Python Blender notes in one variable, shared by all threads, whether writing
is allowed, and puts back what it found there once the call is over. Where a render begins in its thread amid the
drawing of a panel it finds "not allowed", and puts that back when nothing is drawn any more (seen on Blender 3.4 and
4.3; not on 5.2). What is done here is the reverse: a call that begins while writing is allowed, which it is while a
property's getter runs, and ends after it."""
import threading

import bpy
from bpy.props import BoolProperty

from .. import compat

LOOK_SECONDS = 0.2
PATIENCE = 1.0  # s for what takes less than a millisecond
JOBS = ("RENDER", "RENDER_PREVIEW", "OBJECT_BAKE")  # which call engines in threads

_rendered = False  # since the timer looked


class _Overlap:
    """A call of an operator's poll in another thread that has begun, and that ends when it is let go."""

    def __init__(self):
        self._begun, self._over = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=bpy.ops.mesograin.nothing.poll)

    def begin(self):
        self._thread.start()
        self._begun.wait(PATIENCE)

    def last(self):
        """What the call does."""
        self._begun.set()
        self._over.wait(PATIENCE)

    def end(self):
        self._over.set()
        if self._thread.is_alive():
            self._thread.join()


_overlap = None  # the one under way


class MESOGRAIN_OT_nothing(bpy.types.Operator):
    bl_idname = "mesograin.nothing"
    bl_label = "Nothing"
    bl_description = "Can never be called: how Blender says so tells whether it lets Python write"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context):
        if _overlap is not None and threading.current_thread() is not threading.main_thread():
            _overlap.last()
        return False


def refused():
    """Whether Blender lets timers write nothing; nothing else may be under way. Asked on the main thread."""
    try:
        bpy.ops.mesograin.nothing()
    except RuntimeError as refusal:
        return compat.refuses_writing(refusal)
    return False


def allow():
    """Makes Blender allow it again; on the main thread, while no job of JOBS runs."""
    global _overlap
    _overlap = _Overlap()
    try:
        getattr(bpy.context.window_manager, "mesograin_writing")  # its getter begins the call
    finally:
        _overlap.end()
        _overlap = None


def _allowed(_window_manager):
    if _overlap is not None:
        _overlap.begin()
    return True


@bpy.app.handlers.persistent
def note_render(*_arguments):
    """To be called where a render ends: in its thread, where no timer can be registered."""
    global _rendered
    _rendered = True


def _look():
    """The timer: looks after each render, by whichever engine."""
    global _rendered
    if _rendered and not any(bpy.app.is_job_running(job) for job in JOBS):
        _rendered = refused()
        if _rendered:
            allow()
    return LOOK_SECONDS


def register():
    bpy.utils.register_class(MESOGRAIN_OT_nothing)
    bpy.types.WindowManager.mesograin_writing = BoolProperty(
        name="Writing", description="Whether Python may write while this is read", get=_allowed, options={"HIDDEN"})
    for event in (bpy.app.handlers.render_complete, bpy.app.handlers.render_cancel):
        event.append(note_render)
    bpy.app.timers.register(_look, first_interval=LOOK_SECONDS, persistent=True)


def unregister():
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)
    for event in (bpy.app.handlers.render_complete, bpy.app.handlers.render_cancel):
        event.remove(note_render)
    del bpy.types.WindowManager.mesograin_writing
    bpy.utils.unregister_class(MESOGRAIN_OT_nothing)
