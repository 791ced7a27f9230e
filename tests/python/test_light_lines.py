"""Where nothing refracts, how far light has gone inside a grain is looked up in lines that were cut at its surface."""

import mesograin_native as native
import numpy
import pytest
from test_torus import torus

CAMERA = native.Camera.look_at((0.0, -2.2, 3.0), (0.0,) * 3, (0.0, 0.0, 1.0), 46.0)
LOW, ABOVE, BEHIND = (0.2, 1.0, 0.15), (0.3, -0.4, 1.0), (0.1, 0.9, -0.8)
# A lamp that hardly shines: pixels look at each light by themselves.
EMBER = native.PointLight((0.0, 0.0, 30.0), (1e-12,) * 3)


def medium(scale, **changed):
    return native.Material(**{"model": "transport", "sigma_s": (0.9,) * 3, "sigma_a": (0.1,) * 3, "scale": scale,
                              "boundary": "index_matched", **changed})


def sun(to_light, irradiance=(1.0,) * 3):
    return native.DirectionalLight(to_light, irradiance)


def picture(grain, lights, samples, size=240):
    view = native.View(size, size)
    view.set_scene(native.Scene(instances=[native.Instance(torus(), grain, numpy.eye(4))], lights=list(lights)))
    view.set_camera(CAMERA)
    view.render(samples)
    return view.read()[..., :3]


def blocks(image):
    side = image.shape[0] // 8
    return image.reshape(side, 8, side, 8, 3).mean((1, 3))


def apart(image, other):
    return float(numpy.abs(image - other).sum() / other.sum())


@pytest.mark.parametrize("scale", [2.0, 6.0])
@pytest.mark.parametrize("to_light", [LOW, ABOVE, BEHIND])
def test_a_ring_is_as_where_each_pixel_follows_light(to_light, scale):
    """Its far side stands in the light of the near one: lines have two pieces."""
    grain = medium(scale)
    looked_up = blocks(picture(grain, [sun(to_light)], samples=4))
    followed = blocks(picture(grain, [sun(to_light), EMBER], samples=4))
    assert apart(looked_up, followed) < 0.006


def test_walks_in_it_find_as_much():
    grain = medium(4.0, g=0.7)
    looked_up = picture(grain, [sun(LOW)], samples=8)
    followed = picture(grain, [sun(LOW), EMBER], samples=8)
    assert looked_up.sum() == pytest.approx(followed.sum(), rel=0.01)


def test_suns_together_are_the_sum_of_each():
    grain = medium(5.0, sigma_a=(0.1, 0.2, 0.4))
    suns = [sun(LOW, (1.0, 0.5, 0.2)), sun(ABOVE, (0.2, 0.4, 1.0)), sun(BEHIND)]
    each = sum(picture(grain, [light], samples=2) for light in suns)
    assert apart(picture(grain, suns, samples=2), each) < 0.005
