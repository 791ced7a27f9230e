# How often a final render says how far it is: a window follows it, while in a log each time is a line more.
import time

LINE_SECONDS = 10.0
"""Between lines of a log: a farm keeps those of every frame."""


class Telling:
    """in_log: whether each line ends in a log."""

    def __init__(self, in_log):
        self._pause = LINE_SECONDS if in_log else 0.0
        self._told = None

    def is_due(self):
        """Whether to say something now; if so, it counts as said."""
        now = time.perf_counter()
        if self._told is not None and now - self._told < self._pause:
            return False
        self._told = now
        return True
