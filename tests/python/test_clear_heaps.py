"""Clear grains of a heap show what is around them: through their own facets, where light is gathered."""

import mesograin_native as native
import numpy
import pytest
from test_heap_light import ROUND

GLASS = native.Material(model="model_2", sigma_a=(0.0,) * 3, sigma_s=(1e-6,) * 3, boundary="dielectric", eta=1.5)


def milk(sigma_s):
    return native.Material(model="model_2", sigma_a=(0.0,) * 3, sigma_s=(sigma_s,) * 3, boundary="index_matched")


def picture(places, world, reach, samples=16, exchange="gathered", material=GLASS):
    """(radiance of the green channel, coverage), each (48, 48), row 0 at the top: from the side, along y."""
    transforms = numpy.tile(numpy.eye(4), (len(places), 1, 1))
    transforms[:, :3, 3] = places
    view = native.View(48, 48)
    view.set_scene(native.Scene(arrays=[native.InstanceArray(ROUND, material, transforms)], world=world,
                                exchange=exchange))
    view.set_camera(native.Camera.look_at((0.0, -60.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0),
                                          numpy.degrees(2.0 * numpy.arctan(reach / 60.0))))
    view.render(samples)
    pixels = view.read()
    return pixels[..., 1], pixels[..., 3]


# Nothing is lost or found: they cannot be told from the world. Measured: 1.00; without what crosses them, 0.2.
def test_clear_grains_in_even_light_look_like_the_light():
    places = 2.02 * numpy.stack(numpy.meshgrid(*[numpy.arange(3) - 1.0] * 3), -1).reshape(-1, 3)
    radiance, coverage = picture(places, native.World(radiance=(1.0, 1.0, 1.0)), 3.0)
    inside = coverage > 0.999
    assert inside.mean() > 0.5
    assert radiance[inside].mean() == pytest.approx(1.0, abs=0.02)


# Nor by a few numbers a grain. Measured, mean and deviation: glass .971, .056; .02 and .2 mean free paths to the radius
# 1.000, .004 and .996, .032; gathered 1.0000, 0.
@pytest.mark.parametrize("material, exchange, total, deviation", [
    (GLASS, "order_1", 0.04, 0.075), (milk(0.02), "order_1", 0.01, 0.02), (milk(0.2), "order_1", 0.01, 0.05),
    (milk(0.2), "gathered", 0.001, 0.002)])
def test_clear_grains_leave_of_even_light_what_they_had(material, exchange, total, deviation):
    places = 2.02 * numpy.stack(numpy.meshgrid(*[numpy.arange(3) - 1.0] * 3), -1).reshape(-1, 3)
    radiance, coverage = picture(places, native.World(radiance=(1.0, 1.0, 1.0)), 3.0, 8, exchange, material)
    found = radiance[coverage > 0.999]
    assert found.mean() == pytest.approx(1.0, abs=total)
    assert found.std() < deviation


def test_a_clear_ball_turns_the_world_upside_down():
    sky = numpy.zeros((64, 128, 3), numpy.float32)
    sky[:32] = 1.0
    # Nine make an array; all but one stand out of the picture.
    places = [(100.0 * i, 0.0, 0.0) for i in range(9)]
    radiance, _ = picture(places, native.World(image=native.Surroundings(sky)), 1.2, samples=4)
    above, below = radiance[10:20, 20:28].mean(), radiance[28:38, 20:28].mean()
    assert above < 0.15 and below > 0.8
