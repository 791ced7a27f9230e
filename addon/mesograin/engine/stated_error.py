# How far off light between grains was measured to be for grains like those that are drawn.
"""See `sentence`. The numbers are those of docs/heaps.md."""

import dataclasses


@dataclasses.dataclass(frozen=True)
class Measured:
    """Heaps that were held against path tracing. surface: as native.View.statistics names it. thickness: mean free
    paths to the radius of the ball that stands for a grain; albedo: of one scattering or of the surface; g; eta: all
    from least to most. balls: whether grains are such. gathered: whether what is seen was found by rays, or told by
    numbers a grain. total, blocks: the largest error of the light in all, and relative L1 in blocks of 8 x 8 pixels.
    low_sun: the same in blocks under a sun 15 degrees above the horizon, or None. by_chance: how many heaps of such
    media and any shapes were drawn by chance, under a wide lamp in a sky, of which nine in ten were within total and
    blocks; 0 where kinds were chosen."""

    surface: str
    thickness: tuple
    albedo: tuple
    balls: bool
    gathered: bool
    total: float
    blocks: float
    low_sun: float = None
    g: tuple = (0.0, 0.0)
    eta: tuple = (1.0, 1.0)
    by_chance: int = 0

    def holds(self, stuff, exchange):
        """Whether grains of such stuff, so drawn, lie within what was measured."""
        return (stuff["surface"] == self.surface and (exchange["balls"] or not self.balls)
                and (exchange["gathered"] or not self.gathered)
                and all(low <= 1.02 * least and most <= 1.02 * high
                        for name in ("thickness", "albedo", "g", "eta")
                        for (low, high), (least, most) in [(getattr(self, name), stuff[name])]))


MEASURED = (
    Measured("lambert", (0.0, 0.0), (0.8, 0.8), True, True, 0.03, 0.033, 0.036),
    Measured("lambert", (0.0, 0.0), (0.8, 0.8), True, False, 0.032, 0.045, 0.067),
    Measured("lambert", (0.0, 0.0), (0.8, 0.8), False, False, 0.02, 0.03),
    Measured("index_matched", (1.0, 10.0), (0.9, 0.999), True, True, 0.03, 0.033, 0.036),
    Measured("index_matched", (1.0, 10.0), (0.99, 0.99), True, True, 0.02, 0.037, g=(0.0, 0.7)),
    Measured("index_matched", (1.0, 3.0), (0.9, 0.999), True, False, 0.03, 0.051, 0.05),
    Measured("index_matched", (0.35, 6.49), (0.8, 0.999), False, True, 0.03, 0.034, 0.081),
    Measured("index_matched", (2.25, 5.69), (0.914, 0.991), False, False, 0.03, 0.052),
    Measured("dielectric", (0.2, 5.0), (0.8, 0.999), True, False, 0.035, 0.075, 0.12, eta=(1.3, 1.55)),
    Measured("dielectric", (0.11, 2.9), (0.8, 0.999), False, False, 0.04, 0.09, 0.09, eta=(1.3, 1.55)),
    Measured("index_matched", (0.0274, 6.37), (0.544, 0.998), False, False, 0.056, 0.057, g=(0.0, 0.827), by_chance=16),
    Measured("dielectric", (0.0339, 3.05), (0.519, 0.998), False, False, 0.045, 0.045, g=(0.0, 0.792),
             eta=(1.22, 1.65), by_chance=18),
    Measured("lambert_lambert", (2.25, 5.69), (0.914, 0.991), False, False, 0.042, 0.048),
)


SMALL = 0.06
"""What blocks are off, at most, where grains below 8 pixels across are looked at less closely, from looking closely."""


def _found(exchange):
    """Measured of all that grains are made of; empty if anything was not."""
    found = [next((known for known in MEASURED if known.holds(stuff, exchange)), None)
             for stuff in exchange["stuff"]]
    return [] if None in found else found


def in_blocks(exchange):
    """The share that blocks of 8 x 8 pixels are off at most where it was measured for grains like those that
    native.View.statistics()["exchange"] tells of; None where it was not."""
    return max((known.blocks for known in _found(exchange)), default=None)


def sentence(exchange):
    """One sentence about native.View.statistics()["exchange"], without a full stop."""
    found = _found(exchange)
    if not found:
        return "how far off was not measured for grains like these"
    small = ""
    if any(exchange["levels"][name] for name in ("ball", "told", "surface")):
        small = f", and {SMALL:.0%} more in blocks of grains below 8 pixels across"
    total, blocks = (f"{max(getattr(known, name) for known in found):.1%}" for name in ("total", "blocks"))
    heaps = [known.by_chance for known in found if known.by_chance]
    if heaps:
        return (f"within {total} in all and {blocks} in blocks of 8 x 8 pixels for nine in ten of {min(heaps)} heaps of"
                " such media that were drawn by chance under a wide lamp, of grains that do not lie in each"
                f" other{small}")
    low = [known.low_sun for known in found if known.low_sun]
    under = f", {max(low):.0%} under a low sun" if low else ""
    return (f"within {max(known.total for known in found):.0%} in all and {max(known.blocks for known in found):.1%} in"
            f" blocks of 8 x 8 pixels where it was measured, of grains that do not lie in each other{under}{small}")
