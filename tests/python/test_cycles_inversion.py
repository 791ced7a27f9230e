"""The albedo inversion against the audited table, and the fit's own limits."""

import math

import pytest
from addon_rooms import room

inversion = room("cycles.inversion")

# Colour of the node for a single-scattering albedo at g = 0, .5 and .8, and the radius factor of the rescaling walk.
TABLE = [
    (0.2, (0.04578, 0.02233, 0.00857), (0.723, 0.724, 0.724)),
    (0.5, (0.14502, 0.08147, 0.03445), (1.072, 1.084, 1.091)),
    (0.8, (0.33837, 0.22905, 0.11646), (2.075, 2.212, 2.342)),
    (0.9, (0.47334, 0.35507, 0.20818), (3.204, 3.507, 3.874)),
    (0.95, (0.59124, 0.47920, 0.31959), (4.731, 5.279, 5.917)),
    (0.99, (0.78427, 0.70573, 0.58170), (11.14, 12.32, 13.97)),
    (0.999, (0.89527, 0.83428, 0.75904), (21.3, 37.0, 37.0)),
]


@pytest.mark.parametrize("albedo, colours, factors", TABLE)
def test_table(albedo, colours, factors):
    for g, colour in zip((0.0, 0.5, 0.8), colours):
        assert inversion.colour_of_albedo(albedo, g) == pytest.approx(colour, abs=6e-6)
    for ior, factor in zip((1.3, 1.4, 1.5), factors):
        assert inversion.skin_radius_factor(inversion.colour_of_albedo(albedo), ior) == pytest.approx(factor, rel=2e-3)


@pytest.mark.parametrize("g", [0.0, 0.25, 0.5, 0.8, 0.9])
@pytest.mark.parametrize("albedo", [1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99, 0.9999, 0.999999])
def test_inverse_of_the_fit(albedo, g):
    assert inversion.single_scattering_albedo(inversion.colour_of_albedo(albedo, g), g) == pytest.approx(
        albedo, rel=1e-12
    )


def test_ends():
    assert inversion.colour_of_albedo(0.0) == 0.0
    assert inversion.colour_of_albedo(1.0) == inversion.colour_of_albedo(inversion.ALBEDO_LIMIT) < 1.0
    for wrong in (-0.1, 1.1, math.nan):
        with pytest.raises(ValueError, match="between 0 and 1"):
            inversion.colour_of_albedo(wrong)


def test_radius():
    assert inversion.radius_of_extinction(1.0) == pytest.approx(4.0 * math.pi)
    assert inversion.radius_of_extinction(20.0, 0.5) == pytest.approx(4.0 * math.pi / 10.0)
    with pytest.raises(ValueError, match="positive"):
        inversion.radius_of_extinction(0.0)
