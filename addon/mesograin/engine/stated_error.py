# How far off light between grains was measured to be for grains like those that are drawn.
"""See `sentence`. The numbers are those of docs/heaps.md."""

import dataclasses


@dataclasses.dataclass(frozen=True)
class Measured:
    """Heaps that were held against path tracing. surface: as native.View.statistics names it. thickness: mean free
    paths to the radius, albedo: of one scattering or of the surface, both from least to most. balls: whether grains
    are such. gathered: whether what is seen was found by rays, or told by numbers a grain. total, blocks: the
    largest error of the light in all, and relative L1 in blocks of 8 x 8 pixels. low_sun: the same in blocks under
    a sun 15 degrees above the horizon, or None."""

    surface: str
    thickness: tuple
    albedo: tuple
    balls: bool
    gathered: bool
    total: float
    blocks: float
    low_sun: float = None

    def holds(self, stuff, exchange):
        """Whether grains of such stuff, so drawn, lie within what was measured."""
        return (stuff["surface"] == self.surface and (exchange["balls"] or not self.balls)
                and (exchange["gathered"] or not self.gathered)
                and all(low <= 1.02 * least and most <= 1.02 * high
                        for (low, high), (least, most) in ((self.thickness, stuff["thickness"]),
                                                           (self.albedo, stuff["albedo"]))))


MEASURED = (
    Measured("lambert", (0.0, 0.0), (0.8, 0.8), True, False, 0.032, 0.045),
    Measured("index_matched", (1.0, 10.0), (0.9, 0.999), True, True, 0.03, 0.033, 0.036),
    Measured("index_matched", (1.0, 3.0), (0.9, 0.999), True, False, 0.03, 0.051, 0.05),
    Measured("index_matched", (2.68, 6.2), (0.914, 0.991), False, True, 0.03, 0.044),
    Measured("index_matched", (2.68, 6.2), (0.914, 0.991), False, False, 0.03, 0.052),
    Measured("lambert_lambert", (2.68, 6.2), (0.914, 0.991), False, False, 0.042, 0.048),
)


def sentence(exchange):
    """One sentence about native.View.statistics()["exchange"], without a full stop."""
    found = [next((known for known in MEASURED if known.holds(stuff, exchange)), None)
             for stuff in exchange["stuff"]]
    if not found or None in found:
        return "how far off was not measured for grains like these"
    low = [known.low_sun for known in found if known.low_sun]
    under = f", {max(low):.0%} under a low sun" if low else ""
    return (f"within {max(known.total for known in found):.0%} in all and {max(known.blocks for known in found):.1%} in"
            f" blocks of 8 x 8 pixels where it was measured{under}")
