"""A picture is that of its scene, whatever the same view has drawn before."""

import pathlib
import sys

import mesograin_native as native
import numpy
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import sphere_exitance  # noqa: E402


def picture(view, mesh, model, radius, g=0.3):
    view.set_scene(native.Scene(
        instances=[native.Instance(mesh, native.Material(model=model, sigma_s=(0.9 * radius,) * 3,
                                                         sigma_a=(0.1 * radius,) * 3, g=g), numpy.eye(4))],
        lights=[native.DirectionalLight((0.0, 1.0, 0.3), (1.0, 1.0, 1.0))]))
    view.set_camera(native.Camera(numpy.eye(4), numpy.diag([1.0, 1.0, -0.5, 1.0])))
    view.render(2)
    return view.read()


@pytest.mark.parametrize("model", ["model_1", "model_2", "model_3"])
def test_a_thick_grain_before_changes_nothing_of_a_thin_one(model):
    mesh = sphere_exitance.sphere(native)
    alone = picture(native.View(64, 64, seed=3), mesh, model, 0.6)
    view = native.View(64, 64, seed=3)
    for radius, g in ((500.0, 0.0), (48.0, -0.5), (2.4, 0.85)):
        picture(view, mesh, model, radius, g)
    numpy.testing.assert_array_equal(picture(view, mesh, model, 0.6), alone)
