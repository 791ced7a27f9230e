"""What rays of each pixel find of light between grains is shared among pixels that show the same, less and less."""

import mesograin_native as native
import numpy
import pytest
from test_clear_heaps import cube
from test_heap_light import ROUND, camera, heap, white

SUN = [native.DirectionalLight((0.6, 0.3, 1.0), (3.0,) * 3)]


def picture(arrays, denoise, samples, seed=0, exchange="heaps"):
    """(96, 96, 4) after so many samples, and after one."""
    view = native.View(96, 96, seed=seed)
    view.set_visibility("cast")
    view.set_scene(native.Scene(arrays=arrays, lights=SUN, exchange=exchange, denoise=denoise))
    view.set_camera(camera())
    view.render(1)
    first = view.read()
    view.render(samples - 1)
    return view.read(), first


def off(found, truth):
    return numpy.abs(found - truth)[..., :3].sum() / truth[..., :3].sum()


@pytest.fixture(scope="module")
def pictures():
    """{denoise: (picture of 64 samples, of one)}; the two have nothing in common but the scene."""
    return {denoise: picture([heap(white())], denoise, 64, seed) for seed, denoise in enumerate((True, False))}


# Measured: 16.6 and 7.6 %.
def test_one_sample_has_less_than_half_of_its_noise(pictures):
    truth = pictures[False][0]
    assert 0.1 < off(pictures[False][1], truth)
    assert off(pictures[True][1], truth) < 0.5 * off(pictures[False][1], truth)


def test_as_much_light_is_there(pictures):
    for with_it, without in zip(pictures[True], pictures[False]):
        assert with_it[..., :3].sum() == pytest.approx(without[..., :3].sum(), rel=0.004)


@pytest.mark.parametrize("of", [white(), native.Material(model="model_2", eta=1.5, sigma_a=(0.01,) * 3,
                                                         sigma_s=(0.3, 0.2, 0.1))])
def test_no_light_comes_or_goes(of):
    def total(denoise):
        """Of the third sample: edges of those before it show what stands beside, with whose noise there is."""
        means = [picture([heap(of)], denoise, samples)[0][..., :3].sum(dtype=float) for samples in (2, 3)]
        return 3.0 * means[1] - 2.0 * means[0]
    assert total(True) == pytest.approx(total(False), rel=1e-5)


def cubes(of):
    """Turned any way round in the balls' places."""
    places = heap(of).transforms
    turns = numpy.linalg.qr(numpy.random.default_rng(3).normal(size=(len(places), 3, 3)))[0]
    places[:, :3, :3] = places[:, :3, :3] @ turns
    return native.InstanceArray(cube(1.1), of, places)


# One look in a hundred finds a small sun through clear cubes, a hundred times as bright. Measured of the brightest
# percent of pixels' share of all light: .31 with Denoise and .88 without; shared no wider than all else .45.
def test_a_small_sun_through_clear_grains_is_no_white_dots():
    clear = native.Material(model="model_2", eta=1.5, sigma_a=(0.001,) * 3, sigma_s=(0.0,) * 3)
    shares = []
    for denoise in (True, False):
        light = picture([cubes(clear)], denoise, 2)[1][..., 1].ravel()
        brightest = numpy.sort(light)[-len(light) // 100:]
        shares.append(brightest.sum() / light.sum())
    assert shares[0] < 0.38 < 0.7 < shares[1]


def test_many_samples_are_not_blurred(pictures):
    other = picture([heap(white())], False, 64, 7)[0]
    assert off(pictures[True][0], pictures[False][0]) < 1.1 * off(other, pictures[False][0])


def test_grains_tell_others_nothing():
    black = native.Material(model="model_2", boundary="index_matched", sigma_a=(3.0,) * 3, sigma_s=(0.0,) * 3)
    places = heap(white()).transforms
    arrays = [native.InstanceArray(ROUND, white(), places[::2]), native.InstanceArray(ROUND, black, places[1::2])]
    view = native.View(96, 96)
    view.set_visibility("cast")
    found = []
    for denoise in (True, False):
        view.set_scene(native.Scene(arrays=arrays, lights=SUN, denoise=denoise))
        view.set_portions(["subsurface"])
        view.set_camera(camera())
        view.render(1)
        found.append(view.read_portion("subsurface")[..., 1])
    dark = found[1] == 0.0
    assert 0.05 < dark.mean() < 0.9
    # Black grains scatter nothing, and the black about the heap shows none of it.
    assert (found[0][dark] > 0.0).mean() < 0.1


def test_light_that_no_rays_found_is_as_it_was():
    for exchange, sigma_s in (("order_1", 1.0), ("off", 25.0)):  # so thick ones ask their model
        pair = [picture([heap(white(sigma_s))], denoise, 2, exchange=exchange)[0] for denoise in (True, False)]
        numpy.testing.assert_array_equal(*pair)


def test_the_scene_says_it(tmp_path):
    array = heap(white())
    for denoise in (True, False):
        native.write_scene(tmp_path / "scene.json", native.Scene(arrays=[array], denoise=denoise), camera(), (8, 8))
        assert native.load_scene(tmp_path / "scene.json")[0].denoise == denoise
    assert native.Scene().denoise
