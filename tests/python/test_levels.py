"""Grains that are seen small are looked at less closely: what that leaves out, when it is done, and what is told."""

import time

import mesograin_native as native
import numpy
import pytest
from test_heap_light import SPHERES, heap_light

SIZE = 96
TURNS = numpy.linalg.qr(numpy.random.default_rng(3).normal(size=(len(SPHERES), 3, 3)))[0]
TURNS *= numpy.sign(numpy.linalg.det(TURNS))[:, None, None]


def medium(albedo, radius):
    albedo, radius = (numpy.broadcast_to(numpy.asarray(of, float), 3) for of in (albedo, radius))
    return native.Material(model="model_2", boundary="index_matched", sigma_s=tuple(albedo * radius),
                           sigma_a=tuple((1.0 - albedo) * radius))


def refracting(albedo, radius, eta=1.5, model="transport"):
    albedo = numpy.asarray(albedo)
    return native.Material(model=model, eta=eta, roughness=0.3, sigma_s=tuple(albedo * radius),
                           sigma_a=tuple((1.0 - albedo) * radius))


def heap(grains, *materials):
    """The stored heap's places four times over, as an array of each material that has its share of them."""
    offsets = numpy.array([(x, y, 0.0) for x in (0.0, 25.0) for y in (0.0, 25.0)])
    transforms = numpy.tile(numpy.eye(4), (len(offsets) * len(SPHERES), 1, 1))
    turns = numpy.eye(3)[None].repeat(len(SPHERES), 0) if grains == "balls" else TURNS
    transforms[:, :3, :3] = numpy.tile(SPHERES[:, 3, None, None] * turns, (len(offsets), 1, 1))
    transforms[:, :3, 3] = (offsets[:, None] + SPHERES[None, :, :3]).reshape(-1, 3)
    return [native.InstanceArray(heap_light.mesh(native, grains), material, transforms[number::len(materials)])
            for number, material in enumerate(materials)]


def seen_by(view, pixels):
    """From aside, a grain of diameter 2 so many pixels across."""
    middle = numpy.array([25.0, 25.0, 5.0])
    high = 2.0 * SIZE / pixels
    away = 400.0
    view.set_camera(native.Camera.look_at(tuple(middle + away * numpy.array((0.0, -0.6, 0.8))), tuple(middle),
                                          (0.0, 0.0, 1.0), 2.0 * numpy.degrees(numpy.arctan(0.5 * high / away)), 1.0))


def until_known(view):
    while view.preparing is not None:
        time.sleep(0.002)
    view.take_news()


def image_of_a_sky():
    """With a low sun, of which grains see less than half of what shines."""
    radiances = numpy.full((64, 128, 3), 0.2, numpy.float32)
    radiances[:32] *= numpy.array((0.8, 1.0, 1.6), numpy.float32)
    radiances[27:29, 90:92] = 200.0
    return native.World(image=native.Surroundings(radiances))


SHINES = {
    "sun": {"lights": [native.DirectionalLight((1.0, 0.4, 1.0), (3.0,) * 3, angle=0.01)],
            "world": native.World((0.1, 0.1, 0.1))},
    "sky": {"world": native.World((0.3, 0.3, 0.4))},
    "image": {"world": image_of_a_sky()}}


def looked_at(arrays, pixels, by_size, samples, exchange="heaps", shines="sun", patient=True):
    """(picture, counts by level). patient: else as a viewport shows it once the light is known."""
    view = native.View(SIZE, SIZE, patient=patient)
    view.set_levels(by_size)
    view.set_scene(native.Scene(arrays=arrays, exchange=exchange, **SHINES[shines]))
    seen_by(view, pixels)
    if not patient:
        until_known(view)
    view.render(samples)
    told = view.statistics()["exchange"]
    assert told["walks_saved"] >= 4 * told["levels"]["told"]
    assert bool(told["walks_saved"]) == bool(told["levels"]["told"])
    return view.read(), told["levels"]


def blocks(picture):
    return picture[..., :3].reshape(SIZE // 8, 8, SIZE // 8, 8, 3).mean(axis=(1, 3))


# Sand, 12 samples of each way, whose own noise is in it.
@pytest.mark.parametrize("pixels, level, error", [(3.0, "told", 0.05), (6.0, "ball", 0.04)])
@pytest.mark.parametrize("shines", ["sun", "sky"])
def test_small_grains_send_as_much_light_as_looked_at_closely(pixels, level, error, shines):
    arrays = heap("sand", medium((0.999, 0.97, 0.8), (1.0, 3.0, 5.0)), medium(0.9, 8.0))
    close, _ = looked_at(arrays, pixels, False, 12, shines=shines)
    found, counts = looked_at(arrays, pixels, True, 12, shines=shines)
    assert counts[level] > 500 and sum(counts.values()) == counts[level]
    assert numpy.isfinite(found).all()
    assert found[..., :3].sum((0, 1)) == pytest.approx(close[..., :3].sum((0, 1)), rel=0.02)
    assert numpy.abs(blocks(found) - blocks(close)).sum() < error * blocks(close).sum()


def test_what_is_seen_through_thin_ones_is_as_bright():
    arrays = heap("cubes", medium(0.9, 0.5))
    close, _ = looked_at(arrays, 3.0, False, 12)
    found, counts = looked_at(arrays, 3.0, True, 12)
    assert counts["told"] > 500
    assert found[..., :3].sum() == pytest.approx(close[..., :3].sum(), rel=0.02)
    assert numpy.abs(blocks(found) - blocks(close)).sum() < 0.05 * blocks(close).sum()


@pytest.mark.parametrize("grains, pixels, told", [
    ("sand", 3.0, True), ("sand", 6.0, True), ("sand", 12.0, True), ("sand", 30.0, False),
    ("balls", 6.0, True), ("balls", 12.0, False)])
def test_a_viewports_first_sample_looks_closely_at_large_ones_alone(grains, pixels, told):
    """Whose noise is no less than what numbers lack; its next sample looks as closely as others do."""
    arrays = heap(grains, medium(0.9, 3.0))
    right, _ = looked_at(arrays, pixels, False, 12)
    found, counts = looked_at(arrays, pixels, True, 1, patient=False)
    assert (counts["told"] > 0) == told and (counts["own_shape"] + counts["ball"] > 0) != told
    assert numpy.abs(blocks(found) - blocks(right)).sum() < 0.07 * blocks(right).sum()
    _, further = looked_at(arrays, pixels, True, 2, patient=False)
    assert (further["told"] > 0) == (pixels < 4.0)


def test_what_has_become_known_is_looked_at_more_closely_than_what_is_dragged():
    """For the next picture does not depend on how soon it is there."""
    view = native.View(SIZE, SIZE, patient=False)
    view.set_scene(native.Scene(arrays=heap("sand", medium(0.9, 3.0)), exchange="heaps", **SHINES["sun"]))
    seen_by(view, 12.0)
    view.render(1)
    until_known(view)
    view.render(1)
    news = view.statistics()["exchange"]["levels"]
    assert news["own_shape"] > 0 and not news["told"]
    seen_by(view, 12.0)
    view.render(1)
    dragged = view.statistics()["exchange"]["levels"]
    assert dragged["told"] > 0 and not dragged["own_shape"]


@pytest.mark.parametrize("exchange, pixels", [("heaps", 12.0), ("order_1", 3.0), ("gathered", 3.0),
                                              ("path_traced", 3.0)])
def test_large_ones_and_those_that_are_gathered_are_looked_at_as_closely_as_ever(exchange, pixels):
    arrays = heap("sand", medium(0.9, 3.0))
    (close, _), (found, counts) = (looked_at(arrays, pixels, by_size, 2, exchange) for by_size in (False, True))
    assert not counts["ball"] and not counts["told"]
    assert numpy.array_equal(close, found)


BROWN = (0.99, 0.97, 0.9)


@pytest.mark.parametrize("grains, eta", [("sand", 1.5), ("balls", 1.3)])
@pytest.mark.parametrize("shines, samples", [("sun", 10), ("sky", 10), ("image", 24)])
def test_of_small_ones_that_refract_numbers_tell_what_has_entered(grains, eta, shines, samples):
    """The noise of so many samples of each way is in it; a material of each channel its own, and another."""
    arrays = heap(grains, refracting(BROWN, 5.0, eta), refracting((0.999,) * 3, 9.0, 1.5, "model_2"))
    close, none = looked_at(arrays, 3.0, False, samples, shines=shines)
    found, counts = looked_at(arrays, 3.0, True, samples, shines=shines)
    assert counts["surface"] > 500 and not none["surface"]
    assert numpy.isfinite(found).all()
    assert found[..., :3].sum((0, 1)) == pytest.approx(close[..., :3].sum((0, 1)), rel=0.04)
    assert numpy.abs(blocks(found) - blocks(close)).sum() < 0.04 * blocks(close).sum()


@pytest.mark.parametrize("pixels, least, most", [(4.0, 8, 8), (5.0, 2, 6), (6.0, 0, 0)])
def test_they_do_not_pop_where_they_grow(pixels, least, most):
    """About 5 pixels more and more samples look at them closely."""
    view = native.View(SIZE, SIZE)
    view.set_scene(native.Scene(arrays=heap("sand", refracting(BROWN, 5.0)), exchange="heaps",
                                world=native.World((0.3,) * 3)))
    seen_by(view, pixels)
    told = 0
    for _ in range(8):
        view.render(1)
        told += view.statistics()["exchange"]["levels"]["surface"] > 0
    assert least <= told <= most


@pytest.mark.parametrize("exchange, model, albedo, radius", [
    ("order_1", "transport", BROWN, 5.0), ("gathered", "transport", BROWN, 5.0), ("heaps", "model_1", BROWN, 5.0),
    ("heaps", "transport", (0.999,) * 3, 0.5)])
def test_nothing_else_is_shaded_by_its_surface_alone(exchange, model, albedo, radius):
    """Nor what is so clear that more is to be seen in it, nor what a model shows by its surface anyway."""
    arrays = heap("sand", refracting(albedo, radius, model=model))
    (close, _), (found, counts) = (looked_at(arrays, 3.0, by_size, 2, exchange) for by_size in (False, True))
    assert not counts["surface"]
    assert numpy.array_equal(close, found)


@pytest.mark.parametrize("shines", ["sun", "sky", "image"])
@pytest.mark.parametrize("pixels, told", [(3.0, True), (7.0, True), (12.0, False)])
def test_what_a_drag_shows_of_larger_ones_is_told_too(pixels, told, shines):
    """In a sky that is nearer than what one sample of directions shows, beneath a sun about as near."""
    arrays = heap("sand", refracting(BROWN, 5.0))
    found, counts = looked_at(arrays, pixels, True, 1, shines=shines, patient=False)
    assert (counts["surface"] > 300) == told
    if told:
        right, _ = looked_at(arrays, pixels, False, 12, shines=shines)
        assert numpy.abs(blocks(found) - blocks(right)).sum() < 0.06 * blocks(right).sum()
    _, further = looked_at(arrays, pixels, True, 2, shines=shines, patient=False)
    assert (further["surface"] > 0) == (pixels < 4.5)


def test_lights_that_move_are_seen_at_once():
    """Until it is known again what has entered grains their model is asked."""
    arrays = heap("sand", refracting(BROWN, 5.0))

    def lit(*towards):
        return native.Scene(arrays=arrays, exchange="heaps", lights=[native.DirectionalLight(towards, (3.0,) * 3)])

    view = native.View(SIZE, SIZE, patient=False)
    view.set_scene(lit(1.0, 0.4, 1.0))
    seen_by(view, 3.0)
    until_known(view)
    view.render(1)
    assert view.statistics()["exchange"]["levels"]["surface"] > 500
    view.set_scene(lit(-1.0, 0.4, 1.0))
    view.render(1)
    assert not view.statistics()["exchange"]["levels"]["surface"]
    at_once = view.read()
    until_known(view)
    view.render(8)
    assert view.statistics()["exchange"]["levels"]["surface"] > 500
    assert numpy.abs(blocks(at_once) - blocks(view.read())).sum() < 0.25 * blocks(at_once).sum()


def test_a_sliders_step_is_seen_in_what_has_entered():
    view = native.View(SIZE, SIZE, patient=False)
    shines = {"exchange": "heaps", "lights": [native.DirectionalLight((1.0, 0.4, 1.0), (3.0,) * 3)]}
    view.set_scene(native.Scene(arrays=heap("sand", refracting((0.9,) * 3, 5.0)), **shines))
    seen_by(view, 3.0)
    until_known(view)
    view.render(1)
    before = view.read()
    view.set_scene(native.Scene(arrays=heap("sand", refracting((0.97,) * 3, 5.0)), **shines))
    view.render(1)
    assert view.statistics()["exchange"]["levels"]["surface"] > 500
    at_once = view.read()
    until_known(view)
    view.render(8)
    settled = view.read()
    assert blocks(settled).sum() > 1.3 * blocks(before).sum()
    assert numpy.abs(blocks(at_once) - blocks(settled)).sum() < 0.12 * blocks(settled).sum()


def test_the_devices_rays_show_the_same():
    pictures = []
    for visibility in ("cast", "device_rays"):
        view = native.View(SIZE, SIZE)
        view.set_visibility(visibility)
        view.set_scene(native.Scene(arrays=heap("sand", refracting(BROWN, 5.0)), exchange="heaps",
                                    lights=[native.DirectionalLight((1.0, 0.4, 1.0), (3.0,) * 3)]))
        seen_by(view, 3.0)
        view.render(2)
        assert view.statistics()["exchange"]["levels"]["surface"] > 500
        pictures.append(view.read())
    assert numpy.abs(pictures[0] - pictures[1]).sum() < 1e-4 * pictures[0].sum()
