"""A sample that is no longer wanted ends amid its shading, and leaves no trace in what is drawn next."""
import pathlib
import sys
import time

import mesograin_native as native
import numpy
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import sphere_exitance  # noqa: E402

SIZE = 900


def view():
    """Of a sphere that fills it, and of which a sample takes long without a GPU."""
    drawn = native.View(SIZE, SIZE)
    made_of = native.Material(model="model_3", sigma_s=(3.0, 4.0, 5.0), sigma_a=(0.1, 0.2, 0.3), eta=1.3)
    drawn.set_scene(native.Scene(
        instances=[native.Instance(sphere_exitance.sphere(native), made_of, numpy.eye(4))],
        lights=[native.DirectionalLight((0.0, 1.0, 0.0), (1.0, 1.0, 1.0))]))
    drawn.set_camera(native.Camera.look_at((2.0, -2.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 40.0))
    return drawn


def test_a_sample_is_given_up_amid_its_shading():
    if native.device_info()["hardware"]:
        pytest.skip("a GPU is through too soon")
    given_up, whole = view(), view()
    given_up.render(1)
    shares = []
    for _ in range(5):
        whole_seconds = whole.start(1).result()
        task = given_up.start(1)
        time.sleep(0.1 * whole_seconds)
        given_up.cancel()
        shares.append(task.result() / whole_seconds)
        assert given_up.samples == 1
    assert min(shares) < 0.6, "it went on to the end"
    given_up.render(4)
    numpy.testing.assert_array_equal(given_up.read(), whole.read())
