"""Grains of a heap share the tables of their material: those of about one size and colour, whatever their meshes."""
import mesograin_native as native
import numpy as np
import pytest
from test_heap_light import sphere_mesh

NUMBERS = np.random.default_rng(3)


def mesh(radius):
    """A sphere of its own."""
    positions, normals, triangles = sphere_mesh.sphere(32, 16)
    return native.Mesh((positions * radius).astype(np.float32), normals, triangles)


def sand(radius, scales, **varied):
    places = np.tile(np.eye(4), (len(scales), 1, 1))
    places[:, :3, :3] *= np.asarray(scales)[:, None, None]
    places[:, :3, 3] = NUMBERS.uniform(-20.0, 20.0, (len(scales), 3))
    material = native.Material(model="model_2", boundary="dielectric", eta=1.5, sigma_s=(30.0,) * 3, sigma_a=(0.3,) * 3)
    return native.InstanceArray(mesh(radius), material, places, varied)


def tables(arrays):
    """How many materials the device is sent for them."""
    before = native.sent()["materials"]
    view = native.View(8, 8, patient=False)
    view.set_scene(native.Scene(arrays=arrays, lights=[native.DirectionalLight((0.0, 0.0, 1.0), (3.0,) * 3)]))
    return native.sent()["materials"] - before


def test_meshes_of_any_radius_share_what_is_computed_for_a_size():
    scales = 2.0 ** NUMBERS.uniform(0.0, 0.9, 200)
    of_one = tables([sand(1.03, scales)])
    of_three = tables([sand(radius, scales / radius) for radius in (1.04, 1.31, 0.77)])
    assert 7 <= of_one <= 10, "eight to an octave"
    assert of_three <= of_one + 2


def test_colours_are_shared_too():
    arrays = [sand(radius, 2.0 ** NUMBERS.uniform(0.0, 0.9, 300) / radius,
                   sigma_a=NUMBERS.uniform(0.5, 2.0, (300, 3)).astype(np.float32)) for radius in (1.0, 1.3, 0.8)]
    assert tables(arrays) <= 80, "64 and those at the ends; each mesh had as many"


@pytest.mark.parametrize("scale", [0.7, 1.0, 1.234])
def test_grains_of_one_size_have_its_own_tables(scale):
    assert tables([sand(1.0 + 1e-3 * scale, np.full(20, scale))]) == 1


@pytest.mark.parametrize("radius", [0.4, 0.73, 1.0])
def test_grains_of_one_size_are_as_thick_to_others_as_they_are(radius):
    positions, normals, triangles = sphere_mesh.sphere(96, 48)
    places = np.tile(np.eye(4), (12, 1, 1))
    places[:, :3, :3] *= radius
    places[:, 0, 3] = 2.0 * radius * np.arange(12)
    material = native.Material(model="model_2", boundary="index_matched", sigma_s=(9.0,) * 3, sigma_a=(1.0,) * 3)
    array = native.InstanceArray(native.Mesh(positions.astype(np.float32), normals, triangles), material, places)
    view = native.View(8, 8)
    view.set_scene(native.Scene(arrays=[array], lights=[native.DirectionalLight((0.0, 0.0, 1.0), (3.0,) * 3)]))
    view.render(1)
    (stuff,) = view.statistics()["exchange"]["stuff"]
    assert stuff["thickness"] == pytest.approx((10.0 * radius,) * 2, rel=0.008)
