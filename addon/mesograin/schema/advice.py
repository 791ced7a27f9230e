# Which model serves a grain of this size and shape: the cheapest that was measured to be near enough.
"""See `advise`. The numbers are those of docs/accuracy.md and docs/shapes.md: relative L1 against photons, in %."""

from dataclasses import dataclass
from math import log

TOLERANCE = 10.0

# Of round grains, by radius in mean free paths. Model 1: exitance, mean over ten materials and three indices; models 2
# and 3: pictures, mean over eta 1.3 and 1.5, three albedos and three sides.
ROUND = {
    "model_1": {0.6: 105.7, 2.4: 60.4, 7.2: 26.8, 14.4: 13.9, 48.0: 4.3},
    "model_2": {1.0: 6.4, 3.0: 5.0, 10.0: 4.0},
}
# Of others: the mean over a cube, a flake and rice at a radius of 3, eta 1.3, albedo 0.9, three sides.
ANGULAR = {"transport": {3.0: 3.3}, "model_3": {3.0: 13.3}}
MOST_TRANSPORTED = 15.0
"""Radius in mean free paths from which the walks of `transport` take too long."""


@dataclass(frozen=True)
class Advice:
    """A model's name, its measured error in %, and why in one sentence."""

    model: str
    error: float
    sentence: str


def error_at(table, radius):
    """A table's error at a radius, straight in the logarithm between what was measured."""
    radii = sorted(table)
    radius = min(max(radius, radii[0]), radii[-1])
    for lower, upper in zip(radii, radii[1:]):
        if radius <= upper:
            share = log(radius / lower) / log(upper / lower)
            return (1.0 - share) * table[lower] + share * table[upper]
    return table[radii[-1]]


def advise(radius, is_round, closed=True):
    """Advice for a grain of this radius in mean free paths."""
    if is_round or radius > MOST_TRANSPORTED:
        shape = "a sphere" if is_round else "a grain too thick for transport"
        for model, table in ROUND.items():  # cheapest first
            error = error_at(table, radius)
            if error <= TOLERANCE:
                return _advice(model, error, shape, radius)
    if closed:
        return _advice("transport", ANGULAR["transport"][3.0], "cube, flake and rice", radius)
    error = ANGULAR["model_3"][3.0]
    return Advice("model_3", error, f"Model 3: its mesh is open, which transport cannot take; measured {error:.2g} % "
                  "off on cube, flake and rice.")


def _advice(model, error, shape, radius):
    name = model.replace("_", " ").capitalize()
    return Advice(model, error, f"{name}: measured {error:.2g} % off on {shape}, radius {radius:.2g} mean free paths.")
