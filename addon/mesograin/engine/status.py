# What the last picture of each kind was made of and what was wrong with it, for panels to show.
import dataclasses

RENDER, VIEWPORT = "render", "viewport"


@dataclasses.dataclass(frozen=True)
class Status:
    """A snapshot without references into Blender; `error` is one sentence, or empty."""

    samples: int = 0
    width: int = 0
    height: int = 0
    passes: tuple = ()  # (name, milliseconds) of the last sample
    warnings: tuple = ()
    error: str = ""


_latest = {}


def put(kind, status):
    """Remembers `status` for pictures of `kind` and tells whether what it complains of is news."""
    before = _latest.get(kind, Status())
    _latest[kind] = status
    return (before.warnings, before.error) != (status.warnings, status.error)


def get(kind):
    return _latest.get(kind)


def complaints():
    """Every distinct sentence that the last pictures left, errors first."""
    found = [status for status in _latest.values()]
    sentences = [status.error for status in found if status.error]
    sentences += [warning for status in found for warning in status.warnings]
    return list(dict.fromkeys(sentences))


def clear():
    _latest.clear()
