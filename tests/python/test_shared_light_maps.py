"""Instances of an array share their prototype's light maps, drawn from directions on a grid: lit from between those
they look as a single grain does, whose maps are drawn from where its light is."""

import pathlib
import sys

import mesograin_native as native
import numpy
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import sphere_mesh  # noqa: E402

ROUND, SIZE = native.Mesh(*sphere_mesh.sphere(128, 64)), 64
NOWHERE = (1000.0, 0.0, 0.0)


def pictures(towards, samples, **parameters):
    """Of a ball by itself, and of one of two in an array, each lit by a sun."""
    look = native.Material(model="model_3", sigma_a=(2.5,) * 3, sigma_s=(22.5,) * 3, **parameters)
    places = numpy.tile(numpy.eye(4), (2, 1, 1))
    places[1, :3, 3] = NOWHERE
    shown = {"instances": [native.Instance(ROUND, look)]}, {"arrays": [native.InstanceArray(ROUND, look, places)]}
    found = []
    for what in shown:
        view = native.View(SIZE, SIZE)
        sun = native.DirectionalLight(tuple(towards), (numpy.pi,) * 3)
        view.set_scene(native.Scene(lights=[sun], exchange="off", **what))
        view.set_camera(native.Camera.look_at((0.0, 0.0, 6.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 22.0, 1.0))
        view.render(samples)
        found.append(view.read()[..., :3])
    return found


# Where the octahedron's faces meet, and amid one.
@pytest.mark.parametrize("towards", [(0.0, 0.966, 0.259), (0.966, 0.0, -0.259), (0.5, 0.7, 0.0), (0.3, 0.5, 0.8)])
def test_light_comes_from_where_it_shines(towards):
    alone, among = pictures(towards, 64, boundary="index_matched")
    assert among.sum() == pytest.approx(alone.sum(), rel=0.03)
    assert numpy.abs(among - alone).sum() < 0.04 * alone.sum()


def test_a_highlight_is_one():
    alone, among = pictures((0.31, 0.48, 0.8), 16, boundary="dielectric", eta=1.5, roughness=0.05)
    bright = alone > 0.5 * alone.max()
    assert 3 <= bright.sum() <= 60
    assert among[bright].mean() == pytest.approx(alone[bright].mean(), rel=0.03)
    assert (among > 0.5 * alone.max()).sum() == pytest.approx(bright.sum(), rel=0.1)
