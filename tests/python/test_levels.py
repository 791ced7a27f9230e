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


def heap(grains, *materials):
    """The stored heap's places four times over, as an array of each material that has its share of them."""
    offsets = numpy.array([(x, y, 0.0) for x in (0.0, 25.0) for y in (0.0, 25.0)])
    transforms = numpy.tile(numpy.eye(4), (len(offsets) * len(SPHERES), 1, 1))
    turns = numpy.eye(3)[None].repeat(len(SPHERES), 0) if grains == "balls" else TURNS
    transforms[:, :3, :3] = numpy.tile(SPHERES[:, 3, None, None] * turns, (len(offsets), 1, 1))
    transforms[:, :3, 3] = (offsets[:, None] + SPHERES[None, :, :3]).reshape(-1, 3)
    return [native.InstanceArray(heap_light.mesh(native, grains), material, transforms[number::len(materials)])
            for number, material in enumerate(materials)]


def looked_at(arrays, pixels, by_size, samples, exchange="heaps", sky=False, patient=True):
    """(picture, counts by level): from aside, a grain of diameter 2 so many pixels across. patient: else as a viewport
    shows it once the light is known."""
    shines = ({"world": native.World((0.3, 0.3, 0.4))} if sky else
              {"lights": [native.DirectionalLight((1.0, 0.4, 1.0), (3.0,) * 3, angle=0.01)],
               "world": native.World((0.1, 0.1, 0.1))})
    view = native.View(SIZE, SIZE, patient=patient)
    view.set_levels(by_size)
    view.set_scene(native.Scene(arrays=arrays, exchange=exchange, **shines))
    middle = numpy.array([25.0, 25.0, 5.0])
    high = 2.0 * SIZE / pixels
    away = 400.0
    view.set_camera(native.Camera.look_at(tuple(middle + away * numpy.array((0.0, -0.6, 0.8))), tuple(middle),
                                          (0.0, 0.0, 1.0), 2.0 * numpy.degrees(numpy.arctan(0.5 * high / away)), 1.0))
    if not patient:
        while view.preparing is not None:
            time.sleep(0.002)
        view.take_news()
    view.render(samples)
    told = view.statistics()["exchange"]
    assert told["walks_saved"] >= 4 * told["levels"]["told"]
    assert bool(told["walks_saved"]) == bool(told["levels"]["told"])
    return view.read(), told["levels"]


def blocks(picture):
    return picture[..., :3].reshape(SIZE // 8, 8, SIZE // 8, 8, 3).mean(axis=(1, 3))


# Sand, 24 samples of each way, whose own noise of 1 % is in it.
@pytest.mark.parametrize("pixels, level, error", [(3.0, "told", 0.05), (6.0, "ball", 0.04)])
@pytest.mark.parametrize("sky", [False, True])
def test_small_grains_send_as_much_light_as_looked_at_closely(pixels, level, error, sky):
    arrays = heap("sand", medium((0.999, 0.97, 0.8), (1.0, 3.0, 5.0)), medium(0.9, 8.0))
    close, _ = looked_at(arrays, pixels, False, 24, sky=sky)
    found, counts = looked_at(arrays, pixels, True, 24, sky=sky)
    assert counts[level] > 500 and sum(counts.values()) == counts[level]
    assert numpy.isfinite(found).all()
    assert found[..., :3].sum((0, 1)) == pytest.approx(close[..., :3].sum((0, 1)), rel=0.02)
    assert numpy.abs(blocks(found) - blocks(close)).sum() < error * blocks(close).sum()


def test_what_is_seen_through_thin_ones_is_as_bright():
    arrays = heap("cubes", medium(0.9, 0.5))
    close, _ = looked_at(arrays, 3.0, False, 24)
    found, counts = looked_at(arrays, 3.0, True, 24)
    assert counts["told"] > 500
    assert found[..., :3].sum() == pytest.approx(close[..., :3].sum(), rel=0.02)
    assert numpy.abs(blocks(found) - blocks(close)).sum() < 0.05 * blocks(close).sum()


@pytest.mark.parametrize("pixels, told", [(3.0, True), (6.0, True), (12.0, False)])
def test_a_viewports_first_sample_looks_closely_at_large_ones_alone(pixels, told):
    """Whose noise is no less than what numbers lack; its next sample looks as closely as others do."""
    arrays = heap("sand", medium(0.9, 3.0))
    right, _ = looked_at(arrays, pixels, False, 24)
    found, counts = looked_at(arrays, pixels, True, 1, patient=False)
    assert (counts["told"] > 0) == told and (counts["own_shape"] + counts["ball"] > 0) != told
    assert numpy.abs(blocks(found) - blocks(right)).sum() < 0.07 * blocks(right).sum()
    _, further = looked_at(arrays, pixels, True, 2, patient=False)
    assert (further["told"] > 0) == (pixels < 4.0)


@pytest.mark.parametrize("exchange, pixels", [("heaps", 12.0), ("order_1", 3.0), ("gathered", 3.0),
                                              ("path_traced", 3.0)])
def test_large_ones_and_those_that_are_gathered_are_looked_at_as_closely_as_ever(exchange, pixels):
    arrays = heap("sand", medium(0.9, 3.0))
    (close, _), (found, counts) = (looked_at(arrays, pixels, by_size, 2, exchange) for by_size in (False, True))
    assert not counts["ball"] and not counts["told"]
    assert numpy.array_equal(close, found)
