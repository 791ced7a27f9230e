# How often a final render says how far it is: a window follows it, while in a log each time is a line more.
import time

LINE_SECONDS = 10.0
"""Between lines of a log: a farm keeps those of every frame."""


class Telling:
    """tell: what takes a text, as RenderEngine.update_stats its second; in_log: whether each ends in a log."""

    def __init__(self, tell, in_log):
        self._tell, self._pause = tell, LINE_SECONDS if in_log else 0.0
        self._told = None

    def say(self, text):
        """Unless it is too soon after the last one."""
        now = time.perf_counter()
        if self._told is None or now - self._told >= self._pause:
            self._told = now
            self._tell(text)
