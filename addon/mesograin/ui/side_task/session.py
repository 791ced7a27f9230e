# The one task of its kind that may be under way in this Blender, and what came of the last one.
"""A timer looks at the task a few times a second; nothing here waits for it."""

import bpy
from bpy.props import FloatProperty

from ... import compat

POLL_SECONDS = 0.2


class Session:
    """What a kind of task must say for itself: how it starts, and what follows its end.

    progress: the name, on the window manager, of how much is done. shown_in: the types of areas that show it.
    A task has `cancel()`, `running`, `fraction` (0 to 1), `seconds_left` (None while unknown) and `look()`, by which it
    goes on and says whether nothing of it is left.
    """

    def __init__(self, progress, shown_in):
        self.progress = progress
        self.task = None
        """The task under way, or the last one; None before the first."""
        self.error = ""
        """Why there is none, or nothing came of it, one sentence."""
        self._shown_in = shown_in
        self._under_way = None  # the task, until its end was told
        self._leaving = []  # tasks whose end was told or that are forgotten, and that still have to clean up
        # One object each: what is unregistered must be what was registered, and a method is a new one at each look.
        self.poll = self._look
        self._forget_handler = _handler(self.forget)

    def launch(self, context):
        """The task that the scene asks for, started. Raises one of `refusals`, with a sentence."""
        raise NotImplementedError

    def refusals(self):
        """The exceptions by which `launch` says what is wrong."""
        raise NotImplementedError

    def has_news(self):
        """Whether there is something new to show."""
        return True

    def finish(self):
        """The task has ended, by itself or cancelled."""

    def start(self, context):
        """Starts what the scene asks for beside the artist. Raises as `launch`."""
        task = self.launch(context)
        self.let_go()
        self.task = self._under_way = task
        self.error = ""
        if not bpy.app.timers.is_registered(self.poll):
            bpy.app.timers.register(self.poll, first_interval=POLL_SECONDS, persistent=True)

    @property
    def running(self):
        return self.task is not None and self.task.running

    @property
    def fraction(self):
        return self.task.fraction if self.task is not None else 0.0

    def cancel(self):
        """Ends the task under way, if there is one."""
        if self.task is not None:
            self.task.cancel()
            self.redraw()

    def forget(self):
        """Another file is another scene: what came of the last one's task is none of its own."""
        if self.task is not None:
            self.task.cancel()
        self.let_go()
        self.task, self.error = None, ""

    def let_go(self):
        """The end of the task under way is told to nobody any more; it may clean up."""
        if self._under_way is not None:
            self._leaving.append(self._under_way)
        self._under_way = None

    def redraw(self):
        for window in bpy.context.window_manager.windows:
            for area in window.screen.areas:
                if area.type in self._shown_in:
                    area.tag_redraw()

    def register(self):
        # A property, because a slider is how Blender before 4.0 draws a bar; it is read from here and cannot be set.
        setattr(bpy.types.WindowManager, self.progress, FloatProperty(
            name="Progress", min=0.0, max=100.0, subtype="PERCENTAGE", precision=0,
            get=lambda _: float(round(100.0 * self.fraction))))  # of smaller numbers Blender shows digits
        bpy.app.handlers.load_pre.append(self._forget_handler)

    def unregister(self):
        self.forget()
        if bpy.app.timers.is_registered(self.poll):
            bpy.app.timers.unregister(self.poll)
        bpy.app.handlers.load_pre.remove(self._forget_handler)
        delattr(bpy.types.WindowManager, self.progress)

    def _look(self):
        """The timer: looks after tasks, until there are none."""
        self._leaving = [task for task in self._leaving if not task.look()]
        if self._under_way is not None:
            self._look_at_task()
        return POLL_SECONDS if self._under_way is not None or self._leaving else None

    def _look_at_task(self):
        """Redraws if it has news, and tells of its end."""
        over = self.task.look()
        if self.has_news():
            self.redraw()
        if self.running:
            return
        try:
            self.finish()
        except AttributeError as refusal:
            if not compat.refuses_writing(refusal):
                raise
            self.redraw()  # it is told once Blender lets it
            return
        self._under_way = None
        if not over:
            self._leaving.append(self.task)
        self.redraw()


def _handler(forget):
    @bpy.app.handlers.persistent
    def before_another_file(*_arguments):
        forget()

    return before_another_file
