"""One sample, which is what a drag shows, is lit as many are."""

import mesograin_native as native
import numpy
import pytest

from test_heap_light import ROUND

WIDTH, HEIGHT = 96, 64


def grain_on_ground(model, samples):
    corners = numpy.float32([[-100, -100, 0], [100, -100, 0], [100, 100, 0], [-100, 100, 0]])
    ground = native.Mesh(corners, None, numpy.uint32([[0, 1, 2], [0, 2, 3]]))
    raised = numpy.eye(4)
    raised[2, 3] = 1.0
    material = native.Material(model=model, sigma_a=(0.05, 0.1, 0.2), sigma_s=(5.0,) * 3, eta=1.3)
    view = native.View(WIDTH, HEIGHT)
    view.set_scene(native.Scene(instances=[native.Instance(ROUND, material, raised),
                                           native.Instance(ground, native.Material(model="lambert"), numpy.eye(4))],
                                world=native.World(radiance=(1.0, 0.8, 0.5)), exchange="order_1"))
    view.set_camera(native.Camera.look_at((0.0, -12.0, 8.0), (0.0, 0.0, 0.7), (0.0, 0.0, 1.0), 30.0))
    view.render(samples)
    return view.read()[..., :3]


# One direction, which came from below, left ground at .014 of what it is, and a grain at .25.
@pytest.mark.parametrize("model, tolerance", [("model_1", 0.25), ("model_2", 0.1), ("model_3", 0.1)])
def test_a_single_grain_and_its_ground_are_lit_by_a_grey_world_in_one_sample(model, tolerance):
    one, many = (grain_on_ground(model, samples) for samples in (1, 64))
    ground, grain = (slice(36, 60), slice(2, 20)), (slice(24, 40), slice(42, 54))
    numpy.testing.assert_allclose(one[ground].mean((0, 1)), many[ground].mean((0, 1)), rtol=0.05)
    numpy.testing.assert_allclose(one[grain].mean((0, 1)), many[grain].mean((0, 1)), rtol=tolerance)
