# How fast the samples of a final render come, and what is said of that over the picture.
from ..durations import duration


class Pace:
    """Counted from the first samples on: before them programs are compiled and light is sought, once for all."""

    def __init__(self, target):
        self._target = target
        self._first = None  # (samples, when there were so many)
        self._samples = self._now = 0

    def note(self, samples, now):
        """There are so many; now: in seconds."""
        self._samples, self._now = samples, now
        self._first = self._first or (samples, now)

    def line(self):
        said = f"Sample {self._samples}/{self._target}"
        samples, since = self._first
        if self._samples == samples:
            return said
        each = (self._now - since) / (self._samples - samples)
        return f"{said}, about {duration(each * (self._target - self._samples))} left"
