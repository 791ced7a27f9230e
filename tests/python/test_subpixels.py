"""The edges of a picture's first two samples are smooth where light is gathered: a pixel looks at three more places."""

import mesograin_native as native
import numpy
import pytest
from test_heap_light import camera, heap, white

SUN = [native.DirectionalLight((0.6, 0.3, 1.0), (3.0,) * 3)]
BLACK = native.Material(model="model_2", boundary="index_matched", sigma_a=(30.0,) * 3, sigma_s=(0.0,) * 3)


def sparse(of):
    """What lies behind shows between them."""
    array = heap(of)
    return native.InstanceArray(array.mesh, of, array.transforms[::12])


def view_of(of, seed=0, **scene):
    view = native.View(96, 96, seed=seed)
    view.set_visibility("cast")
    view.set_scene(native.Scene(**{"arrays": [sparse(of)], "lights": SUN, **scene}))
    view.set_camera(camera())
    return view


def after(view, samples):
    view.render(samples)
    return view.read()


def passes(view):
    return {entry["pass"] for entry in view.timings()}


def off(found, truth):
    return numpy.abs(found - truth).mean()


def next_sample(view):
    """The next one alone."""
    before = view.samples * view.read()
    return after(view, 1) * view.samples - before


# Measured: .0097 and .029, .0104 and .035.
@pytest.mark.parametrize("seed", [0, 1])
def test_a_silhouette_is_nearer_to_that_of_many_samples(seed):
    view = view_of(white(), seed)
    first = after(view, 1)[..., 3]
    assert "subpixels" in passes(view)
    view.render(1)
    third = next_sample(view)[..., 3]
    assert "subpixels" not in passes(view)
    truth = after(view_of(white(), 7), 64)[..., 3]
    assert set(numpy.unique(third)) == {0.0, 1.0}
    assert set(numpy.unique(first)) == {0.0, 0.25, 0.5, 0.75, 1.0}
    assert off(first, truth) < 0.5 * off(third, truth)


# Measured of three seeds: .0083 to .0088, and .0121 to .0131.
def test_an_edge_between_two_grains_takes_from_both():
    places = heap(white()).transforms[::3]
    halves = [native.InstanceArray(heap(white()).mesh, of, places[i::2]) for i, of in enumerate((white(), BLACK))]
    view = view_of(white(), arrays=halves)
    first = after(view, 1)[..., 1]
    view.render(1)
    third = next_sample(view)[..., 1]
    truth = view_of(white(), 7, arrays=halves)
    truth = after(truth, 256)[..., 1]
    assert off(first, truth) < 0.8 * off(third, truth)


def test_portions_are_of_the_same_places():
    view = view_of(white())
    told = ("subsurface", "single_scattering", "exchange")
    view.set_portions(list(told))
    picture = after(view, 1)
    total = sum(view.read_portion(portion)[..., :3] for portion in told)
    numpy.testing.assert_allclose(total, picture[..., :3], rtol=1e-4, atol=1e-5)


def test_where_light_costs_no_more_than_rays_there_are_none():
    lambert = native.Material(model="lambert", reflectance=(0.5,) * 3)
    view = view_of(lambert, exchange="off")
    assert set(numpy.unique(after(view, 1)[..., 3])) == {0.0, 1.0}
    assert "subpixels" not in passes(view)
