"""Grains of a heap without a surface that refracts: light is followed through what is seen of them, and no model is
asked; with what is known already, while more is being found."""

import time

import mesograin_native as native
import numpy
import pytest
from test_heap_light import ROUND, apart, camera, each_news, green, heap, lit, patiently, white

GROUND = native.Mesh(numpy.float32([(-40, -40, 0), (40, -40, 0), (40, 40, 0), (-40, 40, 0)]),
                     None, numpy.uint32([(0, 1, 2), (0, 2, 3)]))


def passes(view):
    return {timing["pass"] for timing in view.timings()}


def rendered(scene, exchange, samples=1, part=1.0):
    view = native.View(round(96 * part), round(96 * part))
    view.set_visibility("cast")
    view.set_scene(native.Scene(instances=scene.instances, arrays=scene.arrays, lights=scene.lights, world=scene.world,
                                exchange=exchange))
    view.set_camera(camera(part))
    view.render(samples)
    return view


def test_no_light_maps_are_made_for_them():
    scene = lit(heap(white()))
    assert {"light_maps", "gather"} & passes(rendered(scene, "order_1")) == {"light_maps", "gather"}
    assert {"light_maps", "gather"} & passes(rendered(scene, "heaps")) == {"gather"}


def test_their_models_tables_wait_until_something_asks_for_them():
    scene = lit(heap(native.Material(model="model_2", boundary="index_matched", sigma_s=(9.0, 7.7, 6.1))))
    rendered(lit(heap(white())), "order_1")  # the mesh is sent

    def sent(exchange):
        before = native.sent()
        rendered(scene, exchange)
        return {what: count - before[what] for what, count in native.sent().items()}
    followed = sent("heaps")
    assert followed["materials"] == 1 and followed["bytes"] < 1000
    assert sent("order_1")["bytes"] - followed["bytes"] > 16 * 33 * 9, "a table of 33 cosines and 9 radii at least"


def test_a_model_that_something_asks_for_later_is_as_it_would_have_been():
    scene = lit(heap(native.Material(model="model_2", boundary="index_matched", sigma_s=(9.0, 7.7, 6.2))))
    alone = rendered(scene, "order_1").read()
    view = rendered(scene, "heaps")
    view.set_scene(native.Scene(arrays=scene.arrays, lights=scene.lights, world=scene.world, exchange="order_1"))
    view.render(1)
    numpy.testing.assert_array_equal(view.read(), alone)


def test_they_are_followed_where_no_light_goes_between_them():
    view = rendered(lit(heap(white())), "off")
    assert {"light_maps", "gather"} & passes(view) == {"gather"}
    assert view.statistics()["exchange"] is None


def test_light_between_them_goes_and_comes():
    view = native.View(96, 96, patient=False)
    view.set_visibility("cast")
    view.set_camera(camera())
    scenes = {exchange: native.Scene(arrays=scene.arrays, lights=scene.lights, exchange=exchange)
              for scene in [lit(heap(white()))] for exchange in ("heaps", "off")}
    right = {exchange: patiently(scene) for exchange, scene in scenes.items()}
    assert right["off"].sum() < 0.8 * right["heaps"].sum()
    for exchange in ("heaps", "off", "heaps"):
        view.set_scene(scenes[exchange])
        *_, last = each_news(view)
        assert apart(last, right[exchange]) < 1e-3


def test_where_all_is_gathered_who_is_met_looks_once_more():
    scene = lit(heap(white()))
    heaps, gathered = (rendered(scene, exchange, 16) for exchange in ("heaps", "gathered"))
    assert passes(heaps) == passes(gathered)
    assert 0.002 < apart(green(gathered), green(heaps)) < 0.03


# Of a ground whose light goes round among grains and is followed, not told by numbers; at g .8, where the similar
# medium tells others; and in three channels, of which one is drawn for all of a way.
@pytest.mark.parametrize("g", [0.0, 0.8])
def test_paths_that_end_in_an_even_world_lose_nothing(g):
    sigma_s = (0.3, 2.0, 6.0)
    material = native.Material(model="model_2", boundary="index_matched", sigma_s=sigma_s,
                               sigma_a=(0.0,) * 3, g=g)
    ground = native.Instance(GROUND, native.Material(model="lambert", reflectance=(1.0,) * 3), numpy.eye(4))
    scene = native.Scene(instances=[ground], arrays=[heap(material)], world=native.World(radiance=(1.0,) * 3))
    found = rendered(scene, "path_traced", 6, part=0.5).read()[..., :3]
    numpy.testing.assert_allclose(found[:36].mean(axis=(0, 1)), 1.0, atol=0.03)
    assert found.max() < 3.5, "a channel counts three times at most"


def test_paths_are_followed_in_a_viewport_from_the_first_sample_on():
    scene = lit(heap(native.Material(model="model_2", boundary="index_matched", sigma_s=(1.5,) * 3,
                                     sigma_a=(0.5,) * 3)))
    right = green(rendered(scene, "path_traced"), 1)
    view = native.View(96, 96, patient=False)
    view.set_visibility("cast")
    view.set_camera(camera())
    view.set_scene(native.Scene(arrays=scene.arrays, lights=scene.lights, exchange="path_traced"))
    while view.preparing is not None:
        time.sleep(0.02)
    view.take_news()
    view.render(1)
    found = green(view, 1)
    assert apart(found, right) < 0.3
    assert abs(found.sum() / right.sum() - 1.0) < 0.03


def test_forward_scattering_is_told_once():
    """It counts as what crosses a grain that is met: to walk in that, too, would tell it twice."""
    material = native.Material(model="model_2", boundary="index_matched", sigma_s=(3.0,) * 3, g=0.7)
    scene = lit(heap(material))
    numpy.testing.assert_array_equal(rendered(scene, "heaps", 2).read(), rendered(scene, "gathered", 2).read())


@pytest.mark.parametrize("thickness, followed", [(19.0, True), (21.0, False)])
def test_thick_ones_ask_their_model(thickness, followed):
    array = heap(white(thickness / white().sigma_s[0]))
    assert ("gather" in passes(rendered(lit(array), "heaps"))) == followed


def test_the_ground_beside_them_has_the_shadows_that_it_had():
    scene = lit(heap(white()))
    ground = native.Instance(GROUND, native.Material(model="lambert", reflectance=(0.5,) * 3), numpy.eye(4))
    scene = native.Scene(instances=[ground], arrays=scene.arrays, lights=scene.lights, world=scene.world)
    pictures = []
    for exchange in ("order_1", "heaps"):
        view = rendered(scene, exchange)
        view.set_portions(["diffuse"])
        view.render(2)  # in whose edges the ground shows beside grains where light is gathered
        before = view.samples * view.read_portion("diffuse")[..., 1]
        view.render(4)
        pictures.append((view.samples * view.read_portion("diffuse")[..., 1] - before) / 4.0)
    assert pictures[0].max() > 0.1
    assert apart(pictures[1], pictures[0]) < 0.02


@pytest.fixture
def viewport():
    """(view, array): a viewport at rest that shows a white heap."""
    view = native.View(96, 96, patient=False)
    view.set_visibility("cast")
    array = heap(white())
    view.set_scene(heaped(lit(array)))
    view.set_camera(camera())
    assert list(each_news(view))
    return view, array


def test_a_slider_shows_it_in_the_light_of_a_moment_ago(viewport):
    view, array = viewport
    scene = heaped(lit(array.with_material(white(1.1))))
    view.set_scene(scene)
    at_once = green(view)
    assert "gather" in passes(view) and view.preparing is not None
    assert apart(at_once, patiently(scene)) < 0.1


def test_grains_that_moved_are_seen_in_the_light_of_a_moment_ago(viewport):
    view, array = viewport
    moved = numpy.array(array.transforms)
    moved[::7, :3, 3] *= 1.01
    scene = heaped(lit(native.InstanceArray(ROUND, array.material, moved)))
    view.set_scene(scene)
    at_once = green(view)
    assert "gather" in passes(view) and view.preparing is not None
    right = patiently(scene)
    assert apart(at_once, right) < 0.1
    *_, last = each_news(view)
    assert apart(last, right) < 1e-3


def heaped(scene):
    return native.Scene(arrays=scene.arrays, lights=scene.lights, world=scene.world, exchange="heaps")
