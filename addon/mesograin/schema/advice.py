# Which model serves a grain of this size and shape: the cheapest that was measured to be near enough.
"""See `advise`. The numbers are those of docs/accuracy.md and docs/shapes.md: relative L1 against photons, in %.

ROUND: of spheres, by radius in mean free paths. Model 1: exitance, mean over ten materials and three indices; model 2:
pictures, mean over eta 1.3 and 1.5, three albedos and three sides (below a radius of 1 eta 1.3 alone). LESS_ROUND: of
an ellipsoid whose isoperimetric quotient is LESS_ROUND["roundness"], and from a radius of 20 on of a grain of sand from
the front and the side, where it is not dark. FLAT: the same of a flake, whose quotient is FLAT["roundness"], at a
radius of 100 of albedo 0.999 alone. ANGULAR: of others, the mean over a cube, a flake and rice at a radius of 3, eta
1.3, albedo 0.9, three sides. THICK: of those that are nearly or quite too thick for `transport`, the mean over these
three, sand and a torus at a radius of 20, three albedos, front and side. FORWARDS: where |g| is more than most_g, of a
grain of sand by `transport`, by the largest |g| for which an error is told.
"""

from dataclasses import dataclass

from . import AUTO

TOLERANCE = AUTO["tolerance"]
ROUND = {model: {radius: error for radius, error in table} for model, table in AUTO["round"].items()}
LESS_ROUND = AUTO["less_round"]
FLAT = AUTO["flat"]
ANGULAR = AUTO["angular"]
THICK = AUTO["thick"]
FORWARDS = AUTO["forwards"] | {"transport": dict(AUTO["forwards"]["transport"])}


@dataclass(frozen=True)
class Advice:
    """A model's name, its measured error in %, and why in one sentence."""

    model: str
    error: float
    sentence: str


def advise(native, material, volume, area, closed, tolerance=TOLERANCE):
    """Advice for a grain of a native.Material, whatever its model, and of this volume and area in its unit of length,
    whose surface is closed or not. tolerance: in %."""
    return Advice(*native.advise(material, volume, area, closed, tolerance))
