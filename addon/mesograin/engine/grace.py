# How long a final render that the artist cancels goes on: a program that is being compiled cannot be given up.
import time

POLL_SECONDS = 0.05
"""How long it may go without looking whether it was cancelled."""
GRACE_SECONDS = 2.0


class GivenUp(Exception):
    """Of a final render that was cancelled while the device did not answer: it ends with what it has shown."""


class Grace:
    """Of what is drawn beside a final render's picture. cancelled(): whether the artist wishes to cancel."""

    def __init__(self, cancelled):
        self._cancelled = cancelled
        self._ends = None

    def is_over(self):
        """Whether there is no time for more, as the artist's wish to cancel was seen so long ago."""
        now = time.perf_counter()
        if self._ends is None and self._cancelled():
            self._ends = now + GRACE_SECONDS
        return self._ends is not None and now >= self._ends

    def result(self, task, view):
        """Of a task of a native.View. Raises GivenUp where it is over before."""
        while not task.wait(POLL_SECONDS):
            if self.is_over():
                view.cancel()
                raise GivenUp
        return task.result()
