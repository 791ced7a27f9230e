"""Light from grain to grain against path-traced truth: a heap of 696 spheres (tests/data/heaps; its own noise in
blocks is below half a percent, one percent under the low sun)."""

import json
import pathlib
import sys
import time

import mesograin_native as native
import numpy
import pytest

TESTS = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TESTS / "bench"))
import heap_light  # noqa: E402
import sphere_mesh  # noqa: E402

DATA = TESTS / "data/heaps"
MANIFEST = json.loads((DATA / "manifest.json").read_text())
SPHERES = numpy.loadtxt(DATA / "spheres.csv", delimiter=",", skiprows=1)
IMAGES = {image["file"]: image for image in MANIFEST["images"]}
ROUND = native.Mesh(*sphere_mesh.sphere(64, 32))


def camera(part=1.0):
    """That of the stored truth; of its picture's middle, such a part of its width and height."""
    seen = MANIFEST["camera"]
    axes = numpy.array([seen["right"], seen["up"], [-x for x in seen["direction"]]])
    world_to_camera = numpy.eye(4)
    world_to_camera[:3, :3] = axes
    world_to_camera[:3, 3] = -axes @ (numpy.array(seen["centre"]) - 60.0 * numpy.array(seen["direction"]))
    clip = numpy.diag([1.0 / (part * seen["half_width"]), 1.0 / (part * seen["half_height"]), -2.0 / 199.0, 1.0])
    clip[2, 3] = -201.0 / 199.0
    return native.Camera(world_to_camera, clip)


def material(of, model):
    if of["kind"] == "diffuse":
        return native.Material(model=model, reflectance=(of["reflectance"],) * 3)
    return native.Material(model=model, sigma_a=(of["sigma_a"],) * 3, sigma_s=(of["sigma_s"],) * 3, g=of["g"],
                           boundary=of["boundary"])


def heap(of):
    """native.InstanceArray of the spheres, of this native.Material."""
    transforms = numpy.zeros((len(SPHERES), 4, 4))
    transforms[:, :3, 3] = SPHERES[:, :3]
    for axis in range(3):
        transforms[:, axis, axis] = SPHERES[:, 3]
    transforms[:, 3, 3] = 1.0
    return native.InstanceArray(ROUND, of, transforms)


def shown(scene, part=1.0, samples=16):
    """The green channel of a native.Scene, of such a part of the picture's width and height."""
    view = native.View(*(round(part * side) for side in MANIFEST["resolution"]))
    view.set_scene(scene)
    view.set_camera(camera(part))
    view.render(samples)
    return view.read()[..., 1]


def part_for(exchange):
    """Light that is followed to its end takes ten times as long: of the picture's middle it tells as much."""
    return 0.5 if exchange == "path_traced" else 1.0


def samples_for(exchange):
    """Where grains are told of each other by numbers alone, half as many tell as much."""
    return 8 if exchange == "order_1" else 16


def middle(image, part):
    """Of pixels, or of blocks."""
    return image[tuple(slice(round(0.5 * (1.0 - part) * side), round(0.5 * (1.0 + part) * side))
                       for side in image.shape)]


def picture(image, model, exchange, part=1.0, samples=16):
    """The green channel."""
    return shown(native.Scene(arrays=[heap(material(image["material"], model))], exchange=exchange,
                              **light(image["light"])), part, samples)


def light(of):
    if of["type"] == "distant":
        return {"lights": [native.DirectionalLight(tuple(of["direction_to_light"]), (numpy.pi,) * 3)]}
    sky = numpy.zeros((64, 128, 3), numpy.float32)
    sky[:32] = of["radiance"]
    return {"world": native.World(image=native.Surroundings(sky))}


def blocks(image):
    return image.reshape(image.shape[0] // 8, 8, image.shape[1] // 8, 8).mean(axis=(1, 3))


# Measured of model 2 and Lambert, `order_1` and `gathered`, total and blocks: .999, 2.4 %; .996, 1.0; .995, 1.6; 1.001,
# 1.1; 1.018, 3.3; 1.004, 1.7; 1.003, 2.2; 1.003, 1.5.
@pytest.mark.parametrize("file, model, exchange, total, error", [
    ("L8_s45.exr", "lambert", "order_1", 0.01, 0.025),
    ("L8_s45.exr", "lambert", "gathered", 0.015, 0.02),
    ("M9_3_s45.exr", "model_2", "order_1", 0.01, 0.025),
    ("M9_3_s45.exr", "model_3", "order_1", 0.01, 0.025),
    ("M9_3_s45.exr", "model_2", "gathered", 0.01, 0.015),
    ("M999_3_sky.exr", "model_2", "order_1", 0.025, 0.038),
    ("M999_3_sky.exr", "model_3", "order_1", 0.02, 0.037),
    ("M999_3_sky.exr", "model_2", "gathered", 0.01, 0.023),
    ("M9_1_low.exr", "model_2", "order_1", 0.015, 0.03),
    ("M9_1_low.exr", "model_3", "gathered", 0.01, 0.02),
    ("M9_3_s45.exr", "model_2", "heaps", 0.01, 0.015),
    ("M999_3_sky.exr", "model_2", "heaps", 0.01, 0.028),
    ("L8_s45.exr", "lambert", "path_traced", 0.01, 0.015),
    ("M999_3_sky.exr", "model_2", "path_traced", 0.01, 0.025),
    ("M9_1_low.exr", "model_1", "path_traced", 0.01, 0.02),
    ("M9_1_low.exr", "model_1", "heaps", 0.01, 0.02)])
def test_a_heap_is_as_bright_as_it_is(file, model, exchange, total, error):
    part = part_for(exchange)
    truth = middle(native.read_exr(DATA / file)[0][..., 1], part)
    found = picture(IMAGES[file], model, exchange, part, samples_for(exchange))
    assert found.sum() == pytest.approx(truth.sum(), rel=total)
    assert numpy.abs(blocks(found) - blocks(truth)).sum() < error * blocks(truth).sum()


# White and ten mean free paths to the radius, an even sky (its lower half dark), as mesograin-referee heap has it from
# 1024 paths (noise in blocks .2 %). The bounds are what is asked for; told by numbers alone of what walks meet,
# `gathered` was 3.0 % off.
@pytest.mark.parametrize("model, exchange, error", [("transport", "order_1", 0.04), ("model_2", "heaps", 0.04),
                                                    ("model_2", "gathered", 0.025)])
def test_white_thick_grains_are_darker_where_others_stand_about_them(model, exchange, error):
    truth = numpy.loadtxt(DATA / "M999_10_sky.csv", delimiter=",")
    image = {"material": {"kind": "subsurface", "sigma_s": 9.99, "sigma_a": 0.01, "g": 0.0,
                          "boundary": "index_matched"}, "light": {"type": "hemisphere", "radiance": 1.0}}
    found = blocks(picture(image, model, exchange, samples=12))
    assert found.sum() == pytest.approx(truth.sum(), rel=0.015)
    assert numpy.abs(found - truth).sum() < error * truth.sum()


# What was scattered in one ball alone, and went straight through all others, as mesograin-referee heap has it from 512
# paths. The bounds are what is asked for.
@pytest.mark.parametrize("name, model", [("M9_3_s45", "model_2"), ("M9_3_s45", "model_3"), ("M9_1_low", "model_2"),
                                         ("M999_3_sky", "model_2")])
def test_light_that_meets_one_grain_alone(name, model):
    truth = numpy.loadtxt(DATA / f"{name}_own.csv", delimiter=",")
    found = blocks(picture(IMAGES[f"{name}.exr"], model, "off", samples=8))
    assert found.sum() == pytest.approx(truth.sum(), rel=0.02)
    assert numpy.abs(found - truth).sum() < 0.04 * truth.sum()


# Balls that refract, eta 1.5 at .2 mean free paths to the radius and 1.3 at 3, albedo .999, under a sun of 20 degrees
# as mesograin-referee heap has it (1024 and 512 paths; its noise in blocks 4.1 and 6.2 %); measured: 1.009, 6.3 %;
# .978, 6.5.
@pytest.mark.parametrize("file, eta, radius, to_light, total, error", [
    ("clear_s45.csv", 1.5, 0.2, (1.0, 0.0, 1.0), 0.03, 0.08),
    ("D13_3_low.csv", 1.3, 3.0, (0.0, numpy.cos(numpy.pi / 12.0), numpy.sin(numpy.pi / 12.0)), 0.03, 0.075)])
def test_what_refracts_sends_light_on_as_much_forward_as_it_does(file, eta, radius, to_light, total, error):
    truth = numpy.loadtxt(DATA / file, delimiter=",")
    look = native.Material(model="model_2", sigma_a=(0.001 * radius,) * 3, sigma_s=(0.999 * radius,) * 3, eta=eta,
                           boundary="dielectric")
    sun = native.DirectionalLight(to_light, (numpy.pi,) * 3, angle=numpy.pi / 9.0)
    view = native.View(*MANIFEST["resolution"])
    view.set_scene(native.Scene(arrays=[heap(look)], exchange="order_1", lights=[sun]))
    view.set_camera(camera())
    view.render(16)
    found = blocks(view.read()[..., 1])
    assert found.sum() == pytest.approx(truth.sum(), rel=total)
    assert numpy.abs(found - truth).sum() < error * truth.sum()


# Albedo .99 under an even sky (its lower half dark), as mesograin-referee heap has it: two mean free paths to the
# radius and g .9, 128 paths (noise in blocks 1.5 %), and one at g .5, 64 paths (1.3 %). Numbers a grain alone do not
# tell that light goes on as it came: they made 1.77 and 1.15 of it, 77 and 15 %. Measured: 1.012, 3.9 %, and
# .996, 1.8.
# Path traced the second is .999, 1.8 %.
@pytest.mark.parametrize("file, radius, g, exchange, total, error", [
    ("forward_sky.csv", 2.0, 0.9, "heaps", 0.05, 0.09), ("forward_thin_sky.csv", 1.0, 0.5, "heaps", 0.03, 0.04),
    ("forward_thin_sky.csv", 1.0, 0.5, "path_traced", 0.01, 0.03)])
def test_light_goes_on_forwards_from_grain_to_grain(file, radius, g, exchange, total, error):
    part = part_for(exchange)
    truth = middle(numpy.loadtxt(DATA / file, delimiter=","), part)
    look = native.Material(model="model_2", sigma_a=(0.01 * radius,) * 3, sigma_s=(0.99 * radius,) * 3, g=g,
                           boundary="index_matched")
    sky = numpy.zeros((64, 128, 3), numpy.float32)
    sky[:32] = 1.0
    found = blocks(shown(native.Scene(arrays=[heap(look)], world=native.World(image=native.Surroundings(sky)),
                                      exchange=exchange), part, 12))
    assert found.sum() == pytest.approx(truth.sum(), rel=total)
    assert numpy.abs(found - truth).sum() < error * truth.sum()


# So thin that light is scattered once, and one grain stands before others: a picture's light goes as the phase function
# (Henyey and Greenstein 1941, eq. 2). Grains that are seen through others scattered evenly what they do not scatter
# forwards: 2.4 times as much.
@pytest.mark.parametrize("mesh", ["balls", "sand"])
def test_thin_heaps_scatter_forwards_wherever_a_grain_stands(mesh):
    to_sun = numpy.array([0.3, 0.1, 1.0]) / numpy.linalg.norm([0.3, 0.1, 1.0])
    sun = native.DirectionalLight(tuple(to_sun), (1.0,) * 3, angle=0.02)
    light = []
    for g in (0.0, 0.83):
        look = native.Material(model="model_2", sigma_a=(0.0,) * 3, sigma_s=(1e-3,) * 3, g=g, boundary="index_matched")
        view = native.View(*MANIFEST["resolution"])
        view.set_scene(native.Scene(arrays=[heap_light.heap(native, look, mesh)], lights=[sun],
                                    world=native.World((0.0, 0.0, 0.0))))
        view.set_camera(camera())
        view.render(4)
        light.append(view.read()[..., :3].sum())
    cosine = to_sun @ numpy.array(MANIFEST["camera"]["direction"])
    phase = (1.0 - 0.83**2) / (1.0 + 0.83**2 - 2.0 * 0.83 * cosine) ** 1.5
    assert light[1] / light[0] == pytest.approx(phase, rel=0.03)


@pytest.mark.parametrize("file, model", [("L8_s45.exr", "lambert"), ("M9_3_s45.exr", "model_2")])
def test_a_heap_without_exchange_is_too_dark(file, model):
    truth = native.read_exr(DATA / file)[0][..., 1]
    assert picture(IMAGES[file], model, "off", samples=2).sum() < 0.8 * truth.sum()


def test_an_unknown_exchange_is_refused_with_what_is_allowed():
    with pytest.raises(native.Error, match="off, heaps, order_1"):
        native.Scene(exchange="order_9")


# As they are seen in a viewport

def white(sigma_s=1.0):
    return native.Material(model="model_2", sigma_a=(0.001, 0.002, 0.005), sigma_s=(sigma_s,) * 3,
                           boundary="index_matched")


def lit(array, to_light=(0.0, 0.6, 0.8)):
    return native.Scene(arrays=[array], lights=[native.DirectionalLight(to_light, (numpy.pi,) * 3)], exchange="order_1")


def green(view, samples=4):
    view.render(samples)
    return blocks(view.read()[..., 1])


def patiently(scene):
    view = native.View(*MANIFEST["resolution"])
    view.set_scene(scene)
    view.set_camera(camera())
    return green(view)


def wait_for_news(view):
    deadline = time.monotonic() + 60.0
    while not view.take_news():
        assert time.monotonic() < deadline, "The light was not found in a minute."
        time.sleep(0.002)


def each_news(view):
    """What a view that waits for nothing draws, whenever more is known."""
    deadline = time.monotonic() + 60.0
    while time.monotonic() < deadline:
        known = view.preparing is None  # asked first, so that the last news is not missed
        if view.take_news():
            yield green(view)
        if known:
            return
        time.sleep(0.002)
    raise AssertionError("The light was not found in a minute.")


def apart(found, right):
    return numpy.abs(found - right).sum() / right.sum()


def found(view):
    return view.statistics()["exchange"]["found"]


@pytest.fixture
def viewport():
    """(view, array): a viewport at rest that shows a white heap."""
    view = native.View(*MANIFEST["resolution"], patient=False)
    array = heap(white())
    view.set_scene(lit(array))
    view.set_camera(camera())
    assert list(each_news(view))
    return view, array


# Measured: a sixth of a second to the coarse answer, which is 3 % from the final one.
def test_a_viewport_shows_what_is_known_of_a_heaps_light_and_then_more():
    view = native.View(*MANIFEST["resolution"], patient=False)
    view.set_scene(lit(heap(white())))
    view.set_camera(camera())
    assert view.preparing is not None
    first = green(view, 1)
    right = patiently(lit(heap(white())))
    assert apart(first, right) > 0.3, "it has waited for the light"
    pictures = list(each_news(view))
    assert apart(pictures[0], right) < 0.1
    assert numpy.array_equal(pictures[-1], right)
    statistics = view.statistics()["exchange"]
    assert statistics["final"] and statistics["grains"] == len(SPHERES) and statistics["others"] == 0
    assert statistics["links"] > 50 * len(SPHERES) and statistics["residual"] < 1e-3 < statistics["milliseconds"]


@pytest.mark.parametrize("exchange, changed, means", [
    ("heaps", {}, "walked"), ("order_1", {}, "modelled"), ("heaps", {"sigma_s": (40.0,) * 3}, "modelled"),
    ("heaps", {"boundary": "dielectric", "sigma_s": (3.0,) * 3}, "modelled"),
    ("heaps", {"boundary": "dielectric", "sigma_s": (0.01,) * 3}, "looked_into")])
def test_it_tells_by_which_means_grains_are_shown(exchange, changed, means):
    of = native.Material(**{"model": "model_2", "sigma_a": (0.001,) * 3, "sigma_s": (1.0,) * 3,
                            "boundary": "index_matched", **changed})
    view = native.View(16, 16, patient=False)
    view.set_scene(native.Scene(arrays=[heap(of)], lights=lit(heap(of)).lights, exchange=exchange))
    wait_for_news(view)
    told = view.statistics()["exchange"]["means"]
    assert told == {**dict.fromkeys(("walked", "looked_into", "modelled", "sharing"), 0), means: len(SPHERES)}


def test_it_tells_how_many_grains_share_numbers():
    places = numpy.tile(numpy.eye(4), (40 ** 3, 1, 1))
    places[:, :3, 3] = 2.0 * numpy.stack(numpy.meshgrid(*[numpy.arange(40.0)] * 3), axis=-1).reshape(-1, 3)
    view = native.View(16, 16, patient=False)
    view.set_scene(lit(native.InstanceArray(ROUND, native.Material(model="lambert", reflectance=(0.3,) * 3), places)))
    wait_for_news(view)
    told = view.statistics()["exchange"]["means"]
    assert told["modelled"] == 40 ** 3 and 0.5 < told["sharing"] / 40 ** 3 < 0.9


def test_the_device_sums_it_where_it_is_asked_to_and_it_is_the_same():
    def summed(by):
        view = native.View(*MANIFEST["resolution"])
        view.set_summing(by)
        view.set_scene(lit(heap(white())))
        view.set_camera(camera())
        return green(view), view.statistics()["exchange"]["summed_on_device"]

    right, by_device = summed("processor")
    assert not by_device
    found, by_device = summed("device")
    assert by_device and apart(found, right) < 1e-4
    with pytest.raises(native.Error, match="automatic, processor, device; got 'nobody'"):
        native.View(1, 1).set_summing("nobody")


def test_who_waits_for_the_light_sees_how_far_it_is_and_can_cancel():
    view = native.View(*MANIFEST["resolution"])
    view.set_scene(lit(heap(white(3.0))))
    view.set_camera(camera())
    task = view.start(4)
    assert not task.wait(0.01) and 0.0 <= view.preparing < 1.0 and view.samples == 0
    assert view.awaited == ["exchange"]
    view.cancel()
    assert task.wait(5.0) and view.samples == 0
    view.render(1)
    assert view.preparing is None and view.awaited == [] and view.samples == 1


def test_a_camera_finds_no_light_anew(viewport):
    view, _ = viewport
    before = found(view)
    view.set_camera(native.Camera.look_at((60.0, 0.0, 80.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 30.0))
    assert view.preparing is None and not view.take_news()
    view.render(1)
    assert found(view) == before


@pytest.mark.parametrize("change, redone", [
    (lambda array: lit(array, (0.0, 0.5, 0.8)), {"tables": 0, "links": 0, "sources": 2}),
    (lambda array: lit(array.with_material(white(1.2))), {"tables": 2, "links": 1, "sources": 1}),
    (lambda array: lit(native.InstanceArray(ROUND, array.material, array.transforms * MOVED)),
     {"tables": 0, "links": 2, "sources": 2})],
    ids=["light", "slider", "grains"])
def test_a_change_finds_anew_what_it_touches(viewport, change, redone):
    view, array = viewport
    before = found(view)
    scene = change(array)
    view.set_scene(scene)
    right = patiently(scene)
    at_once = green(view)
    pictures = list(each_news(view))
    assert apart(pictures[0], right) < 0.1
    assert apart(at_once, right) < 0.2, "what was known before is shown until more is known"
    # It began from what it had: no further from the answer than the tolerance of either.
    assert apart(pictures[-1], right) < 1e-3
    assert {name: found(view)[name] - before[name] for name in redone} == redone


# Measured: 8.9 %; with the rays of a heap of 10^4, 14.4 %.
def test_the_first_answer_after_grains_moved_is_within_a_tenth(viewport):
    view, array = viewport
    view.set_scene(lit(native.InstanceArray(ROUND, array.material, array.transforms * MOVED)))
    pictures = list(each_news(view))
    assert len(pictures) == 2
    assert apart(pictures[0], pictures[1]) < 0.1


def test_a_sun_that_is_turned_down_glares_no_longer(viewport):
    view, array = viewport
    scene = native.Scene(arrays=[array], exchange="order_1",
                         lights=[native.DirectionalLight((0.0, 0.6, 0.8), (0.1, 0.01, 0.02))])
    view.set_scene(scene)
    assert apart(green(view), patiently(scene)) < 0.01


def test_a_slope_of_grains_that_turns_is_seen_where_it_is():
    """Under a light from above. Rays from where grains are, to where the slope was, began below it: 36 % off."""
    corners = numpy.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    cube = native.Mesh(corners, None, numpy.array([
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
        [1, 5, 7], [1, 7, 3]]))
    flat = numpy.array([[x, y, 0.0] for x in range(-10, 11) for y in range(-10, 11)])
    ground = native.Mesh(numpy.array([[-12, -12, -0.5], [12, -12, -0.5], [12, 12, -0.5], [-12, 12, -0.5]], float),
                         numpy.tile([0.0, 0.0, 1.0], (4, 1)), numpy.array([[0, 1, 2], [0, 2, 3]]))

    def scene(turned):
        tilt, turn = numpy.eye(4), numpy.eye(4)
        tilt[1:3, 1:3] = [[numpy.cos(0.4), -numpy.sin(0.4)], [numpy.sin(0.4), numpy.cos(0.4)]]
        turn[:2, :2] = [[numpy.cos(turned), -numpy.sin(turned)], [numpy.sin(turned), numpy.cos(turned)]]
        grains = numpy.tile(numpy.diag([0.3, 0.3, 0.3, 1.0]), (len(flat), 1, 1))
        grains[:, :3, 3] = flat
        clear = native.Material(model="model_2", sigma_a=(0.01,) * 3, sigma_s=(0.3,) * 3, eta=1.5)
        grey = native.Material(model="lambert", reflectance=(0.5,) * 3)
        return native.Scene(arrays=[native.InstanceArray(cube, clear, turn @ tilt @ grains)], exchange="heaps",
                            instances=[native.Instance(ground, grey, turn @ tilt)],
                            lights=[native.DirectionalLight((0.0, 0.0, 1.0), (numpy.pi,) * 3)])

    def shown(scene, patient):
        view = native.View(96, 96, patient=patient)
        view.set_scene(scene)
        view.set_camera(native.Camera.look_at((0.0, -30.0, 30.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 40.0))
        return view

    view = shown(scene(0.0), False)
    assert list(each_news(view))
    view.set_scene(scene(0.5))
    at_once = green(view)
    assert apart(at_once, green(shown(scene(0.5), True))) < 0.1


MOVED = numpy.ones((len(SPHERES), 4, 4))
MOVED[::7, :3, 3] = 1.01


def test_a_slider_that_does_not_rest_is_seen_in_the_light_of_a_moment_ago(viewport):
    view, array = viewport
    lights, step = 0, 0
    deadline = time.monotonic() + 60.0
    while lights < 3 and time.monotonic() < deadline:
        step += 1
        scene = lit(array.with_material(white(1.0 + 1e-4 * step)))
        view.set_scene(scene)
        lights += view.take_news()
    assert lights == 3, f"{step} changes, and the light was seen to change {lights} times"
    *_, last = each_news(view)
    assert apart(last, patiently(scene)) < 1e-3


@pytest.mark.parametrize("before, now, eta", [(0.9, 0.97, 1.0), (0.97, 0.9, 1.0), (0.9, 0.97, 1.5)])
@pytest.mark.parametrize("exchange", ["order_1", "heaps"])
def test_the_picture_after_a_sliders_step_is_within_a_tenth_before_its_light_is_known(before, now, eta, exchange):
    """In the light that grains of the colour before had sent it was 20 to 50 % off."""
    def scene(albedo):
        boundary = {"boundary": "index_matched"} if eta == 1.0 else {"eta": eta}
        material = native.Material(model="model_2", sigma_a=(3.0 * (1.0 - albedo),) * 3, sigma_s=(3.0 * albedo,) * 3,
                                   **boundary)
        lights = [native.DirectionalLight((0.0, 0.6, 0.8), (numpy.pi,) * 3)]
        return native.Scene(arrays=[array.with_material(material)], lights=lights, exchange=exchange)

    array = heap(white())
    view = native.View(*MANIFEST["resolution"], patient=False)
    view.set_scene(scene(before))
    view.set_camera(camera())
    *_, was = each_news(view)
    view.set_scene(scene(now))
    at_once = green(view)
    assert view.preparing is not None
    *_, right = each_news(view)
    assert apart(at_once, right) < min(0.1, 0.3 * apart(was, right))


def test_what_is_no_heap_pays_nothing():
    view = native.View(16, 16)
    view.set_scene(native.Scene(instances=[native.Instance(ROUND, white())], exchange="order_1"))
    view.set_camera(native.Camera.look_at((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 40.0))
    assert view.preparing is None
    view.render(1)
    assert view.statistics()["exchange"] is None


# What is bent through the surface has a mirror direction that leaves it; it was seen through, endlessly bright or no
# number at all.
def test_bumps_that_look_away_from_the_viewer_are_numbers():
    positions, normals, triangles = sphere_mesh.sphere(64, 32)
    bumpy = native.Mesh(positions, normals, triangles, numpy.ascontiguousarray(0.5 + 0.5 * positions[:, :2]))
    told = numpy.full((1, 1, 4), (0.8, 0.5, 0.1, 1.0), numpy.float32)
    look = native.Material(model="lambert", reflectance=(0.8,) * 3,
                           finish=native.Finish(normal=native.TextureMap(native.Picture(told))))
    transforms = numpy.tile(numpy.eye(4), (9, 1, 1))
    transforms[:, 0, 3] = 2.1 * numpy.arange(9) - 8.4
    view = native.View(96, 16)
    view.set_scene(native.Scene(arrays=[native.InstanceArray(bumpy, look, transforms)], exchange="order_1",
                                world=native.World(radiance=(1.0, 1.0, 1.0))))
    view.set_camera(native.Camera.look_at((0.0, 0.0, 60.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 3.0))
    view.render(4)
    assert numpy.isfinite(view.read()).all()


# What others leave of a sun where light came into a thick grain is all or nothing at each place: a sample looks at
# some. Measured after it did: 12 %; looking at one place 19. The bound was set between them.
def test_one_sample_of_grains_in_each_others_shadow_is_no_speckle():
    grain = heap_light.KINDS["eta 1.5"]
    view = native.View(192, 192)
    view.set_scene(heap_light.scene(native, grain, "model_2", heap_light.light_of("low", grain), "heaps"))
    view.set_camera(heap_light.camera(native))
    view.render(1)
    one = view.read()[..., :3]
    view.render(23)
    many = view.read()[..., :3]
    assert numpy.abs(one - many).sum() < 0.15 * many.sum()
