# What a picture waits for before it can be as it will be, how far that is, and how long it will take, in words.
from ..durations import duration

# Of its work that must be done, and seconds that must have passed, before a time left is worth saying.
LEAST_SHARE, LEAST_SECONDS = 0.02, 1.0
PLACES = {("transport",): "in grains", ("exchange",): "between grains"}
ONCE = {("transport",): "once for each shape and medium", ("exchange",): "once for these grains and lights"}


def line(awaited, share):
    """Few words, for a viewport. awaited, share: as native.View's `awaited` and `preparing`."""
    return f"Light {_places(awaited)}: {share:.0%}"


def _places(awaited):
    return PLACES.get(tuple(awaited), "in and between grains")


class Waiting:
    """Of a final render, which waits for all of it before its first sample."""

    def __init__(self):
        self._first = None  # (share, when it was so much)

    def sentence(self, awaited, share, now):
        """As `line`, and what an artist asks who waits; now: in seconds."""
        self._first = self._first or (share, now)
        done, passed = share - self._first[0], now - self._first[1]
        said = f"Computing how light goes {_places(awaited)}"
        once = ONCE.get(tuple(awaited))
        said += f", {once}: {share:.0%}" if once else f": {share:.0%}"
        if done < LEAST_SHARE or passed < LEAST_SECONDS:
            return said
        return f"{said}, about {duration(passed / done * (1.0 - share))} left"
