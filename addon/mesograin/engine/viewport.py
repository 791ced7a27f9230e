# One viewport's picture: a native view that gets better in the background while Blender keeps drawing.
import time

import numpy as np

from .. import native_module
from ..scene import meshes
from . import coarseness, status

# A redraw may wait this long for samples under way: short enough for a fluid window, long enough that a fast device
# answers a change within the same redraw.
PATIENCE_SECONDS = 0.028
# The display is half-float: a value beyond its largest would become Inf and blacken the viewport.
LARGEST_DISPLAYED = 65504.0
# What a better answer changes in the picture comes over this long.
FADE_SECONDS = 0.3
# So long it may wait for the first picture of a change that is expected by then: a redraw without it puts off the next,
# which shows it, by all that Blender itself takes for one.
EXPECTED_SECONDS = 0.075
# No sharper or better picture is begun before so long has passed without a change: a change would have to wait for it,
# or for the redraw that shows it.
STILL_SECONDS = 0.1


class Session:
    """Owned by one engine and used from Blender's main thread, which never waits for the native module's thread longer
    than PATIENCE_SECONDS: it may be held by a program that it compiles for a minute, for this view or another. All that
    is asked of the view is posted there, and what is still under way at the next redraw is asked for then. One of
    Python's would crash Blender now and then: before Python 3.12 its operators take another thread's hold of the
    interpreter for their own. Holds no reference into Blender."""

    def __init__(self):
        self.cache = meshes.MeshCache()
        self.samples = 0  # in the picture last returned by `advance`; 0 after a change
        self.timings = ()  # (pass, milliseconds) of the picture last read
        self.exchange = None  # status.Exchange of it, or None
        self.stopped = False
        self._values = None  # of the scene that was last asked for
        self._camera = None
        self._size = (1, 1)  # that was last asked for
        self._coarseness = coarseness.Coarseness()
        self._divisor = 1  # of what the view draws or is about to, as Coarseness'
        self._still = None  # since when no change came after a picture was seen
        self._rests = False  # whether nothing is drawn beyond that yet, as a change may come
        self._next_scene = self._next_camera = None  # asked for, and not yet the view's
        self._taking = None  # a scene or a camera that the view is being given, or news that it takes in
        self._took = None  # what goes on once that is done: no method of this object, which would keep it alive
        self._view = None
        self._view_size = None  # of the region that the view draws for
        self._read = None  # the picture last read, as native.Reading's
        self._pixels = None  # the same, as it is displayed
        self._kept = None  # (picture, samples) that is finished, and not yet returned
        self._seen = False  # whether a picture of the view's scene and camera was returned
        self._refines = False  # whether one was before news of them were taken in
        self._restarted = 0.0  # when the view's picture was last begun
        self._task = None
        self._drawn = None  # (samples, divisor) of that
        self._begun = 0.0  # when that was
        self._given_up = False  # whether that is to be heard of no more
        self._preparing = False  # whether more may become known of what the view draws
        self._fade = None  # (picture before that, when the other's first was read)
        self._chunk = 1
        self._target = 0

    def set_scene(self, values):
        """Takes export.SceneValues; restarts the picture if they look different. Raises native.Error as to_native."""
        if values == self._values:
            return
        self._values = None  # an error below leaves nothing that the next update could take for shown
        self._next_scene = values.to_native()
        self._values = values
        self._change()

    def set_camera(self, camera, width, height):
        """Takes a native.Camera and the region's size in pixels; restarts the picture if either is new."""
        size = (width, height)
        if self._camera is not None and camera == self._camera and size == self._size:
            return
        if size != self._size:
            self._interrupt()  # a picture of another size is none to be shown
            self._kept = None
        self._size = size
        self._camera = self._next_camera = camera
        self._change()

    @property
    def size(self):
        """(width, height) in pixels, as last asked for."""
        return self._size

    @property
    def values(self):
        """export.SceneValues as last taken, or None."""
        return self._values

    @property
    def has_scene(self):
        return self._values is not None

    def advance(self, target):
        """Moves on towards `target` samples, for PATIENCE_SECONDS at most. Returns the picture, (height, width, 4)
        float32 with row 0 at the top, when it is new, else None."""
        self._target = target
        self._sharpen_in_time()
        self._keep_busy()
        if self._taking is not None:
            if self._taking.wait(PATIENCE_SECONDS):
                self._apply()
        elif self._task is not None:
            if self._task.wait(self._patience()):
                self._finish()
        elif self._fade:
            self._kept = self._displayed(), self._view.samples
        elif self._preparing or self.settling:
            time.sleep(PATIENCE_SECONDS)
        if self._kept is None:
            return None
        (picture, self.samples), self._kept = self._kept, None
        return picture

    def picture(self):
        """The picture that `advance` returned last, as it did. None before the first of what was asked for."""
        return self._displayed() if self._seen and self._taking is None else None

    @property
    def busy(self):
        return (self._taking is not None or self._task is not None or self._preparing or self._fade is not None
                or self.settling)

    @property
    def settling(self):
        """Whether the picture is the first of what was asked for, or a coarse one, and left so until no change has come
        for a while."""
        return self._seen and (self._rests or self._divisor > 1)

    @property
    def waits(self):
        """Whether redraws would show nothing new until more is known of what the view draws, or no change has come for
        a while: `look` tells when."""
        return ((self._preparing or self.settling) and self._taking is None and self._task is None
                and self._fade is None and self._kept is None)

    def look(self):
        """Whether a session that waits has a reason for a redraw. Starts samples of what has become known, or of a
        picture that is to be sharp."""
        self._sharpen_in_time()
        self._keep_busy()
        return not self.waits

    @property
    def seconds_behind(self):
        """How long what was asked for has waited for its first picture; 0 if there is one."""
        return 0.0 if self._seen else time.perf_counter() - self._restarted

    @property
    def preparing(self):
        """The share that is done of what will make the picture better; None if there is nothing."""
        return self._view.preparing if self._is_at_hand else 0.0

    @property
    def awaited(self):
        """What that is, as native.View's."""
        return tuple(self._view.awaited) if self._is_at_hand else ()

    @property
    def warnings(self):
        """Sentences on what is not drawn by the model asked for."""
        return tuple(self._view.warnings) if self._is_at_hand else ()

    @property
    def _is_at_hand(self):
        """Whether the view tells at once of what its scene waits for."""
        return self._view is not None and (
            self._taking is None or self._took in (Session._took_camera, Session._took_sharpness))

    def __del__(self):
        # Blender lets go of an engine, and so of its session, without a call that could be relied upon.
        self.stop()

    def stop(self):
        """Ends the work under way and frees the view; the session cannot be used afterwards."""
        self._interrupt()
        self._preparing = False
        self._view = self._task = self._taking = self._took = None
        self._values = self._next_scene = self._next_camera = self._kept = None
        self.cache.forget()
        self.stopped = True

    def _change(self):
        """Makes what was asked for the view's as soon as may be. In a drag a change comes for each redraw: were samples
        under way always given up for it, no picture would be seen before its end. So the first picture after a change
        is finished before the next change, and one that is finished is kept until it was drawn."""
        if self._task is not None and self._task.done:
            self._keep()
        if self._task is not None and (self._seen or self._refines):  # which would only refine what is shown already
            self._interrupt()
        self._still, self._rests = None, True
        divisor = self._coarseness.divisor()
        if divisor != self._divisor and self._camera is not None:
            self._divisor, self._next_camera = divisor, self._camera
        self._apply()

    def _sharpen_in_time(self):
        """Goes over from a coarse picture to a finer one, or to further samples of it, unless changes come yet."""
        if not self.settling or self._taking is not None or self._task is not None or self._fade is not None:
            return
        if self._camera is None:  # the view could not take it: the next redraw asks anew
            return
        now = time.perf_counter()
        self._still = self._still or now
        if now - self._still < STILL_SECONDS:
            return
        self._rests = False
        if self._divisor == 1:
            return
        self._divisor = coarseness.finer(self._divisor)
        size = coarseness.size(self._size, self._divisor)
        self._take(self._view.start_camera(self._camera, *size), Session._took_sharpness)
        if self._taking.wait(PATIENCE_SECONDS):
            self._went_over()

    def _apply(self):
        """Makes what was asked for the view's, if no samples are under way, and goes on."""
        if self._task is None and self._hand_over():
            self._keep_busy()

    def _hand_over(self):
        """Whether the view has the scene and the camera that were asked for last, and all news begun, or samples were.
        Raises native.Error as View.set_scene."""
        while self._taking is not None or self._next_scene is not None or self._next_camera is not None:
            late = self._taking is not None
            if not late:
                self._take_next()
            if not self._taking.wait(PATIENCE_SECONDS):
                return False
            self._went_over()
            # Where a change comes for each redraw, and is taken later than that, no picture would ever be begun.
            if late and not self._seen and self._view_size == self._size:
                self._draw()
                if self._task is not None:
                    return True
        return True

    def _take_next(self):
        if self._view is None:
            try:
                self._view = native_module.get().View(1, 1, patient=False)
            except native_module.get().Error:
                # Nothing can be drawn; the next update says so again.
                self._values = self._next_scene = self._camera = self._next_camera = None
                raise
        if self._next_scene is not None:
            taking, self._next_scene = self._view.start_scene(self._next_scene), None
            self._take(taking, Session._took_scene)
        else:
            size = coarseness.size(self._size, self._divisor)
            taking, self._next_camera = self._view.start_camera(self._next_camera, *size), None
            self._view_size = self._size
            self._take(taking, Session._took_camera)

    def _take(self, taking, took):
        self._taking, self._took = taking, took

    def _went_over(self):
        """Goes on with what the view has taken. Raises native.Error as View.set_scene."""
        (taking, self._taking), (took, self._took) = (self._taking, None), (self._took, None)
        took(self, taking)

    def _took_scene(self, taking):
        try:
            taking.result()
        except native_module.get().Error:
            self._values = None  # the next update takes nothing for shown
            raise
        self._begin()

    def _took_camera(self, taking):
        self._took_view(taking)
        self._begin()

    def _took_sharpness(self, taking):
        self._took_view(taking)
        self._chunk = 1

    def _took_view(self, taking):
        try:
            taking.result()
        except native_module.get().Error:
            self._camera = None
            raise

    def _took_news(self, news):
        if news.result():
            before = self._pixels.copy() if self._seen else None
            self._refines = self._refines or self._seen
            self._restart()
            self._fade = None if before is None else (before, None)

    def _begin(self):
        self._preparing, self._refines = True, False
        self._restart()

    def _keep_busy(self):
        if self._taking is not None:
            return
        # What becomes known after the first picture of a change makes it better; the next change takes it in, too.
        if self._task is None and self._preparing and not (self._seen and self._rests):
            self._preparing = self._view.preparing is not None  # asked first, so that the last news is not missed
            self._take(self._view.start_news(), Session._took_news)
            if not self._taking.wait(PATIENCE_SECONDS):  # that of a million grains takes a second
                return
            self._went_over()
        if self._task is None:
            self._draw()

    def _draw(self):
        if self.settling and self._view.samples:
            return
        if self._camera is not None and self._view.samples < self._target:
            count = min(self._chunk, self._target - self._view.samples)
            self._task, self._drawn = _start(self._view, count), (count, self._divisor)
            self._begun = time.perf_counter()

    def _patience(self):
        """How long a redraw may wait for the samples under way."""
        expected = None if self._seen else self._coarseness.expected(self._divisor)
        if expected is not None and self._begun + expected - time.perf_counter() <= EXPECTED_SECONDS:
            return EXPECTED_SECONDS
        return PATIENCE_SECONDS

    def _finish(self):
        """Keeps the picture of the task that is done, and goes on. Raises native.Error if it failed."""
        try:
            self._kept = self._end()
            self._seen = self._kept is not None
        finally:
            self._apply()

    def _keep(self):
        """As `_end`, for what a change has made old: an error in it is old, too."""
        try:
            self._kept = self._end() or self._kept
        except native_module.get().Error:
            self._kept = None

    def _end(self):
        """(picture, samples) of the task that is done, or None if it was given up. Raises native.Error if it failed."""
        task, self._task = self._task, None
        given_up, self._given_up = self._given_up, False
        if given_up:
            return None
        seconds = task.result()
        samples, divisor = self._drawn
        if seconds < PATIENCE_SECONDS / 2:  # another is no hindrance
            self._rests = False
        self._coarseness.note(divisor, seconds / samples)
        self._adapt(seconds)
        self._read = task.picture()
        told = self._read
        self.timings = tuple((timing["pass"], timing["milliseconds"]) for timing in told["timings"])
        self.exchange = status.exchange(told["statistics"])
        return self._displayed(), self._view.samples

    def _interrupt(self):
        """Gives up the samples under way. They may end later than here: no change is the view's before."""
        if self._task is not None:
            self._view.cancel()
            self._given_up = True
            if self._task.wait(PATIENCE_SECONDS):
                self._end()
        self._restart()

    def _restart(self):
        self._fade = None
        self._chunk = 1
        self.samples = 0
        self._seen = False
        self._restarted = time.perf_counter()

    def _adapt(self, seconds):
        # A fast device does several samples between two redraws, which cost as much as many samples.
        if seconds < PATIENCE_SECONDS / 2:
            self._chunk *= 2
        elif seconds > PATIENCE_SECONDS and self._chunk > 1:
            self._chunk //= 2

    def _displayed(self):
        """The picture last read, as it may be shown."""
        read = self._read["pixels"]
        if self._pixels is None or self._pixels.shape != read.shape:
            self._pixels, self._fade = np.empty_like(read), None
        np.minimum(read, LARGEST_DISPLAYED, out=self._pixels)
        if self._fade:
            self._fade_over()
        return self._pixels

    def _fade_over(self):
        before, started = self._fade
        now = time.perf_counter()
        share = 0.0 if started is None else (now - started) / FADE_SECONDS
        self._fade = (before, now if started is None else started) if share < 1.0 else None
        if self._fade:
            self._pixels *= share
            self._pixels += (1.0 - share) * before


def _start(view, samples):
    return view.start(samples, read=True)
