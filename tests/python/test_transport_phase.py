"""The model `transport` where light scatters forwards or backwards: thin grains show what the phase function says."""

import math

import mesograin_native as native
import numpy
import pytest
from test_transport_colours import sphere

THIN = 0.05  # mean free paths: light is scattered once at most
TO_LIGHT = {"front": (0.5, 0.5, math.sqrt(0.5)), "side": (0.8, 0.6, 0.0), "back": (-0.3, 0.4, -0.75**0.5)}


@pytest.fixture(scope="module")
def ball():
    return sphere()


def brightness(mesh, g, to_light, boundary):
    material = native.Material(model="transport", sigma_s=(THIN,) * 3, sigma_a=(0.0,) * 3, g=g, eta=1.3,
                               boundary=boundary, specular=False)
    view = native.View(48, 48)
    light = native.DirectionalLight(to_light, (1.0,) * 3)
    view.set_scene(native.Scene(instances=[native.Instance(mesh, material, numpy.eye(4))], lights=[light]))
    view.set_camera(native.Camera.look_at((0.0, 0.0, 200.0), (0.0,) * 3, (0.0, 1.0, 0.0), 0.7))
    view.render(64 if g else 4)
    return float(view.read()[..., 0].sum())


@pytest.mark.parametrize("g, side", [(-0.6, "front"), (-0.6, "side"), (-0.2, "back"), (0.3, "back")])
def test_a_thin_grain_shows_the_phase_function(ball, g, side):
    """Henyey and Greenstein 1941; light from `to_light` turns to the viewer at +z."""
    cosine = -TO_LIGHT[side][2]
    expected = (1.0 - g * g) / (1.0 + g * g - 2.0 * g * cosine) ** 1.5
    seen = brightness(ball, g, TO_LIGHT[side], "index_matched") / brightness(ball, 0.0, TO_LIGHT[side], "index_matched")
    assert seen == pytest.approx(expected, rel=0.05)
