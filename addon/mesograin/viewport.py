# One viewport's picture: a native view that gets better in the background while Blender keeps drawing.
import concurrent.futures
import time

import numpy as np

from . import meshes, native_module

# A redraw may wait this long for samples under way: short enough for a fluid window, long enough that a fast device
# answers a change within the same redraw.
PATIENCE_SECONDS = 0.03
# The display is half-float: a value beyond its largest would become Inf and blacken the viewport.
LARGEST_DISPLAYED = 65504.0


class Session:
    """Owned by one engine and used from Blender's main thread; only `View.render` runs on another, without Blender's
    data. Holds no reference into Blender."""

    def __init__(self):
        self.cache = meshes.MeshCache()
        self.samples = 0  # in the picture last returned by `advance`
        self.stopped = False
        self._values = None
        self._camera = None
        self._view = None
        self._pixels = None
        self._task = None
        self._chunk = 1
        self._worker = concurrent.futures.ThreadPoolExecutor(max_workers=1, thread_name_prefix="mesograin-viewport")

    def set_scene(self, values):
        """Takes export.SceneValues; restarts the picture if they look different. Raises native.Error as to_native."""
        if values == self._values:
            return
        self._values = None  # an error below leaves nothing that the next update could take for shown
        scene = values.to_native()
        self._interrupt()
        self._ensure_view(1, 1)
        self._view.set_scene(scene)
        self._values = values

    def set_camera(self, camera, width, height):
        """Takes a native.Camera and the region's size in pixels; restarts the picture if either is new."""
        if self._camera is not None and camera == self._camera and (width, height) == self.size:
            return
        self._interrupt()
        self._ensure_view(width, height)
        if (width, height) != self.size:
            self._view.resize(width, height)
        self._view.set_camera(camera)
        self._camera = camera

    @property
    def size(self):
        return self._view.width, self._view.height

    @property
    def has_scene(self):
        return self._values is not None

    def advance(self, target):
        """Moves on towards `target` samples, for PATIENCE_SECONDS at most. Returns the picture, (height, width, 4)
        float32 with row 0 at the top, when it is new, else None."""
        self._keep_busy(target)
        if self._task is None:
            return None
        concurrent.futures.wait([self._task], timeout=PATIENCE_SECONDS)
        if not self._task.done():
            return None
        task, self._task = self._task, None
        self._adapt(task.result())
        self.samples = self._view.samples
        pixels = self._read()
        self._keep_busy(target)
        return pixels

    def picture(self):
        """The picture as it is, as `advance` returns it; waits for samples under way. None before the first."""
        return self._read() if self.samples else None

    def timings(self):
        return tuple((timing["pass"], timing["milliseconds"]) for timing in self._view.timings())

    @property
    def busy(self):
        return self._task is not None

    def __del__(self):
        # Blender lets go of an engine, and so of its session, without a call that could be relied upon.
        self.stop()

    def stop(self):
        """Ends the work under way and frees the view; the session cannot be used afterwards."""
        self._interrupt()
        self._worker.shutdown()
        self._view = self._values = None
        self.cache.forget()
        self.stopped = True

    def _ensure_view(self, width, height):
        if self._view is None:
            self._view = native_module.get().View(width, height)

    def _keep_busy(self, target):
        if self._task is None and self._view.samples < target:
            self._task = self._worker.submit(_render, self._view, min(self._chunk, target - self._view.samples))

    def _interrupt(self):
        if self._task is not None:
            self._view.cancel()
            concurrent.futures.wait([self._task])
            self._task = None
        self._chunk = 1
        self.samples = 0

    def _adapt(self, seconds):
        # A fast device does several samples between two redraws, which cost as much as many samples.
        if seconds < PATIENCE_SECONDS / 2:
            self._chunk *= 2
        elif seconds > PATIENCE_SECONDS and self._chunk > 1:
            self._chunk //= 2

    def _read(self):
        width, height = self.size
        if self._pixels is None or self._pixels.shape[:2] != (height, width):
            self._pixels = np.empty((height, width, 4), dtype=np.float32)
        self._view.read(self._pixels)
        return np.minimum(self._pixels, LARGEST_DISPLAYED, out=self._pixels)


def _render(view, samples):
    """Seconds that `samples` took; on the session's thread, which must not keep the session alive."""
    started = time.perf_counter()
    view.render(samples)
    return time.perf_counter() - started
