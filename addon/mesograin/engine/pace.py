# How fast the samples of a final render come, and what is said of that over the picture.
from ..durations import duration


class Pace:
    """Counted from the first samples on: before them programs are compiled and light is sought, once for all. target:
    how many there are to be, as far as is known."""

    def __init__(self, target):
        self.target = target
        self._first = None  # (samples, when there were so many)
        self._samples = self._now = 0

    def note(self, samples, now):
        """There are so many; now: in seconds. Fewer than before are others, and counted anew."""
        if samples < self._samples:
            self._first = None
        self._samples, self._now = samples, now
        self._first = self._first or (samples, now)

    def line(self):
        said = f"Sample {self._samples}/{self.target}"
        samples, since = self._first
        if self._samples == samples:
            return said
        each = (self._now - since) / (self._samples - samples)
        return f"{said}, about {duration(each * max(0, self.target - self._samples))} left"
