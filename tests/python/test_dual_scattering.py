"""The benchmark that holds dual scattering beside the exchange: what it takes a ball to do, and what is in the way."""

import pathlib
import sys

import numpy
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import dual_scattering  # noqa: E402
import heap_light  # noqa: E402


@pytest.mark.parametrize("thickness", [0.3, 3.0])
def test_a_white_ball_sends_on_all_that_comes(thickness):
    ball = dual_scattering.Ball(heap_light.medium(1.0, thickness))
    assert ball.forwards + ball.backwards == pytest.approx(1.0, abs=0.003)
    # Of a sphere, van de Hulst 1957, section 11.23: 1 - Q / 2 with Q = 2 (1 - through).
    through = (1.0 - (1.0 + 2.0 * thickness) * numpy.exp(-2.0 * thickness)) / (2.0 * thickness**2)
    assert ball.through == pytest.approx(through, abs=0.003)


def test_an_opaque_ball_throws_light_back_as_a_diffuse_sphere_does():
    ball = dual_scattering.Ball({"kind": "diffuse", "reflectance": 0.6})
    assert (ball.scattered, ball.through) == (pytest.approx(0.6), 0.0)
    # Where light comes in is where it leaves: at a mean cosine of 2 / 3.
    assert ball.slope == pytest.approx(0.6 * 2.0 / 3.0, abs=0.003)
    assert ball.backwards == pytest.approx(0.6 * 5.0 / 6.0, abs=0.003)


def test_balls_in_the_way_are_counted():
    balls = numpy.array([(0, 0, 0, 1), (0, 0, 3, 1), (0, 0, 6, 1), (5, 0, 3, 1), (0, 0, -3, 1)], float)
    origins = numpy.array([(0, 0, 1.001), (0.6, 0, 0.9), (0, 0, 7.1)])
    counts, chords = dual_scattering.crossed(origins, numpy.array([0.0, 0.0, 1.0]), balls, numpy.array([0, 0, 2]))
    assert counts.tolist() == [2, 2, 0]
    numpy.testing.assert_allclose(chords, [4.0, 3.2, 0.0])
