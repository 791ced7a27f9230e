# What the last picture of each kind was made of and what was wrong with it, for panels to show.
import dataclasses

import bpy

from . import stated_error

RENDER, VIEWPORT = "render", "viewport"

MEANS = (("walked", "by walks"), ("looked_into", "looked into"), ("modelled", "by their model"))
"""By which a grain among others is shown, and what that is called."""


@dataclasses.dataclass(frozen=True)
class Exchange:
    """What was done for light between grains."""

    grains: int
    others: int  # objects that send no such light
    kinds: int
    links: int
    steps: int
    residual: float
    summed_on_device: bool
    milliseconds: float
    final: bool
    means: dict  # how many grains are shown by which, as native.View.statistics() names them
    levels: dict  # how many of those walked the last sample showed by which, as it names them
    walks_saved: int  # in that sample
    stated_error: str

    def lines(self):
        """Short lines of text."""
        if not self.links:
            return (f"light between {self.grains} grains: being found",)
        others = f", {self.others} other objects without" if self.others else ""
        return (f"light between {self.grains} grains of {self.kinds} kinds: {self.milliseconds:.0f} ms{others}",
                f"{self.links} links, {self.steps} steps, {self.residual:.1g} left"
                + (", summed by the device" if self.summed_on_device else "")
                + ("" if self.final else ", being refined"), self._by_which_means(), *self._seen_small())

    def _by_which_means(self):
        shown = [f"{self.means[name]} {how}" for name, how in MEANS if self.means[name]]
        sharing = self.means["sharing"]
        return ", ".join(shown) + (f"; {sharing} lie deep and share numbers" if sharing else "")

    def _seen_small(self):
        told = f"{self.levels['told']} without walks ({self.walks_saved} saved)"
        shown = [how for name, how in (("ball", f"{self.levels['ball']} as balls"), ("told", told),
                                       ("surface", f"{self.levels['surface']} by their surface alone"))
                 if self.levels[name]]
        return (f"seen small: {', '.join(shown)}",) if shown else ()


def exchange(statistics):
    """Exchange of what native.View.statistics() tells; None where no light goes from grain to grain."""
    counts = statistics["exchange"]
    return counts and Exchange(**{field.name: counts[field.name] for field in dataclasses.fields(Exchange)
                                  if field.name in counts}, stated_error=stated_error.sentence(counts))


@dataclasses.dataclass(frozen=True)
class Status:
    """A snapshot without references into Blender; `error` is one sentence, or empty."""

    samples: int = 0
    width: int = 0
    height: int = 0
    passes: tuple = ()  # (name, milliseconds) of the last sample
    warnings: tuple = ()
    error: str = ""
    exchange: Exchange = None
    budget: str = ""  # what came of it, without a full stop


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


def redraw_panels():
    """The panels that show it; nothing else redraws them after a viewport."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()
