"""A channel of models 2 and 3 is what it is whatever the others are."""
import pathlib
import sys

import mesograin_native as native
import numpy
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import shapes  # noqa: E402
import sphere_exitance  # noqa: E402

ALONE = ((0.9,) * 3, (1.0,) * 3)
BESIDE = [((0.9, 0.3, 0.999), (1.0, 1.0, 1.0)), ((0.9, 0.999, 0.9), (1.0, 0.2, 0.5)),
          ((0.9, 0.0, 0.5), (1.0, 1.0, 0.1))]


def red(model, albedos, densities, eta, radius):
    """Blocks of a channel of a sphere's picture, lit from behind."""
    material = native.Material(
        model=model, sigma_s=tuple(radius * a * d for a, d in zip(albedos, densities)),
        sigma_a=tuple(radius * (1.0 - a) * d for a, d in zip(albedos, densities)), eta=eta, specular=False,
        boundary="index_matched" if eta == 1.0 else "dielectric")
    view = native.View(48, 48)
    instance = native.Instance(sphere_exitance.sphere(native), material, numpy.eye(4))
    light = native.DirectionalLight((-0.3, 0.4, -0.866), (1.0, 1.0, 1.0))
    view.set_scene(native.Scene(instances=[instance], lights=[light]))
    view.set_camera(native.Camera.look_at((0.0, 0.0, 2.7), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0))
    view.set_taps(64)
    view.render(16)
    return shapes.blocks(view.read()[..., 0])


@pytest.mark.parametrize("model", ["model_2", "model_3"])
@pytest.mark.parametrize(("eta", "radius"), [(1.3, 10.0), (1.0, 10.0), (1.3, 2.0)])
def test_a_channel_does_not_depend_on_its_neighbours(model, eta, radius):
    """Within 1 %, wherever one looks: one flow for three channels moved red by 15 %."""
    alone = red(model, *ALONE, eta, radius)
    for albedos, densities in BESIDE:
        beside = red(model, albedos, densities, eta, radius)
        assert abs(beside.sum() / alone.sum() - 1.0) < 0.01
        assert numpy.abs(beside - alone).sum() < 0.01 * alone.sum()
