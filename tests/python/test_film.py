"""A transparent film, and a world that the camera sees otherwise: what goes straight through grains shows them."""

import math

import mesograin_native as native
import numpy
import pytest
from test_heap_light import ROUND

SIZE = 32
SIGMA_A, SIGMA_S = (0.1, 0.2, 0.3), (0.2, 0.2, 0.2)
SIGMA_T = numpy.add(SIGMA_A, SIGMA_S)
FILM = native.World(radiance=(0.3, 0.6, 1.0), film_transparent=True)
DARK_FILM = native.World(radiance=(0.0, 0.0, 0.0), film_transparent=True)


def medium(model, **more):
    return native.Material(model=model,
                           **{"sigma_a": SIGMA_A, "sigma_s": SIGMA_S, "boundary": "index_matched", **more})


def place(x, y, z):
    matrix = numpy.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def wall(y, half=8.0):
    corners = numpy.float32([(-half, y, -half), (half, y, -half), (half, y, half), (-half, y, half)])
    return native.Mesh(corners, numpy.float32([(0, -1, 0)] * 4), numpy.uint32([(0, 1, 2), (0, 2, 3)]))


def parallel(half):
    """Along +y, which is as far from what is seen as a camera is that sees it from the front."""
    world_to_camera = numpy.float64([(1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, -20), (0, 0, 0, 1)])
    camera_to_clip = numpy.diag([1.0 / half, 1.0 / half, -2.0 / 40.0, 1.0])
    camera_to_clip[2, 3] = -1.0
    return native.Camera(world_to_camera, camera_to_clip)


# What lone grains and others send each other is beside what goes straight through them.
def picture(world, instances=(), arrays=(), exchange="off", half=1.25, samples=16, lights=(), view=None):
    view = view or native.View(SIZE, SIZE)
    view.set_scene(native.Scene(instances=list(instances), arrays=list(arrays), world=world, exchange=exchange,
                                lights=list(lights)))
    view.set_camera(parallel(half))
    view.render(samples)
    return view.read()


def transmittances(half, spheres=1):
    """(SIZE, SIZE, 3): the mean over each pixel of exp(-sigma_t d), d across unit spheres one behind the other."""
    side = (numpy.arange(8 * SIZE) + 0.5) / (4 * SIZE) - 1.0
    x, z = numpy.meshgrid(half * side, half * side)
    way = 2.0 * spheres * numpy.sqrt(numpy.maximum(1.0 - x * x - z * z, 0.0))
    passed = numpy.exp(-way[..., None] * SIGMA_T)
    return passed.reshape(SIZE, 8, SIZE, 8, 3).mean(axis=(1, 3))


def inside(half):
    """(SIZE, SIZE) bool: off the rim, which a mesh has elsewhere."""
    side = (numpy.arange(SIZE) + 0.5) / (0.5 * SIZE) - 1.0
    x, z = numpy.meshgrid(half * side, half * side)
    return numpy.hypot(x, z) < 0.9


# Cycles' alpha is 1 less the mean of the channels' transmittances. Measured: within .006; 1 before.
@pytest.mark.parametrize("model", ["model_2", "model_3", "transport"])
@pytest.mark.parametrize("world", [FILM, DARK_FILM])
def test_what_crosses_a_grain_makes_the_film_transparent(model, world):
    pixels = picture(world, [native.Instance(ROUND, medium(model))])
    passed = transmittances(1.25)
    within = inside(1.25)
    numpy.testing.assert_allclose(pixels[within, 3], 1.0 - passed[within].mean(axis=-1), atol=0.02)


# The rest is what it scatters: over a backdrop the film is the picture that has it.
@pytest.mark.parametrize("model", ["model_2", "model_3", "transport"])
def test_a_film_and_what_crosses_are_the_whole_picture(model):
    grain = [native.Instance(ROUND, medium(model))]
    film = picture(FILM, grain)
    whole = picture(native.World(radiance=(0.3, 0.6, 1.0), seen=True), grain)
    passed = transmittances(1.25)
    within = inside(1.25)
    numpy.testing.assert_allclose(film[within, :3] + passed[within] * (0.3, 0.6, 1.0), whole[within, :3], atol=0.02)
    assert whole[within, 3].min() == 1.0
    assert (film[within, :3].mean(axis=0) < 0.6 * whole[within, :3].mean(axis=0)).all()


def of_two(world, exchange):
    places = numpy.array([place(0, 0, 0), place(0, 3, 0)])
    return picture(world, arrays=[native.InstanceArray(ROUND, medium("model_2"), places)], exchange=exchange)


# One behind the other; their light is followed. What is seen straight through is not blurred: .9 % off, 1.4 with it.
@pytest.mark.parametrize("exchange", ["heaps", "gathered", "off", "order_1"])
def test_grains_of_an_array_are_crossed_one_after_the_other(exchange):
    passed = transmittances(1.25, spheres=2)
    within = inside(1.25)
    numpy.testing.assert_allclose(of_two(FILM, exchange)[within, 3], 1.0 - passed[within].mean(axis=-1), atol=0.01)


@pytest.mark.parametrize("exchange", ["heaps", "off", "order_1"])
def test_the_film_lacks_as_much_as_the_world_gives(exchange):
    film = of_two(native.World(film_transparent=True), exchange)
    whole = of_two(native.World(seen=True), exchange)
    within = inside(1.25)
    crossed = (whole - film)[within, :3].mean(axis=-1)
    assert crossed.mean() > 0.2
    numpy.testing.assert_allclose(1.0 - film[within, 3], crossed, atol=0.01)


@pytest.mark.parametrize("material", [medium("model_2", boundary="dielectric", eta=1.5),
                                      medium("transport", boundary="dielectric", eta=1.5),
                                      native.Material(model="lambert")])
def test_what_refracts_or_is_opaque_covers_the_film(material):
    pixels = picture(FILM, [native.Instance(ROUND, material)])
    assert pixels[inside(1.25), 3].min() == 1.0


# As Cycles has it: its film shows no world, and a ground behind a grain is no film. Measured: 1 and within .001.
@pytest.mark.parametrize("model", ["model_2", "model_3", "transport"])
@pytest.mark.parametrize("world", [DARK_FILM, native.World(radiance=(0.0, 0.0, 0.0))])
def test_what_stands_behind_a_grain_is_seen_through_it(model, world):
    grain = native.Instance(ROUND, medium(model))
    shining = native.Material(model="lambert", reflectance=(0.0,) * 3, finish=native.Finish(radiance=(1.0, 0.5, 0.2)))
    view = native.View(SIZE, SIZE)
    # Of one transform, as parts of an object are.
    pixels = picture(world, [grain, native.Instance(wall(4.0), shining)], view=view)
    passed = transmittances(1.25)
    within = inside(1.25)
    numpy.testing.assert_allclose(pixels[..., 3], 1.0, atol=1e-6)
    numpy.testing.assert_allclose(pixels[within, :3], passed[within] * (1.0, 0.5, 0.2), atol=0.02)
    # Half of the picture: the film is seen through the other half.
    beside = native.Instance(wall(4.0), shining, place(8.0, 0.0, 0.0))
    view.set_portions(["transmission", "emission"])
    pixels = picture(world, [grain, beside], view=view)
    through = view.read_portion("transmission")[..., :3]
    left = within & (numpy.arange(SIZE) < SIZE // 2 - 1)
    right = within & (numpy.arange(SIZE) > SIZE // 2)
    expected = 1.0 - passed[left].mean(axis=-1) if world.film_transparent else 1.0
    numpy.testing.assert_allclose(pixels[left, 3], expected, atol=0.02)
    numpy.testing.assert_allclose(pixels[right, :3], passed[right] * (1.0, 0.5, 0.2), atol=0.02)
    numpy.testing.assert_allclose(through[right], pixels[right, :3], atol=1e-6)
    assert pixels[left, :3].max() < 1e-6


# One before the other, each an object of its own, or the last within the first, which is twice as thin. The world
# alone was seen through the second. Measured: within .006.
@pytest.mark.parametrize("model", ["model_2", "model_3", "transport"])
@pytest.mark.parametrize(("count", "nested"), [(2, False), (3, False), (2, True)])
@pytest.mark.parametrize("film", [False, True])
def test_lone_grains_are_crossed_one_after_the_other(model, count, nested, film):
    grains = [native.Instance(ROUND, medium(model), place(0, 3 * i, 0)) for i in range(count)]
    passed = transmittances(1.25, spheres=count)
    if nested:
        large = numpy.diag([2.0, 2.0, 2.0, 1.0])
        halved = medium(model, sigma_a=tuple(numpy.multiply(SIGMA_A, 0.5)), sigma_s=tuple(numpy.multiply(SIGMA_S, 0.5)))
        grains = [native.Instance(ROUND, halved, large), native.Instance(ROUND, medium(model))]
        side = 1.25 * ((numpy.arange(SIZE) + 0.5) / (0.5 * SIZE) - 1.0)
        x, z = numpy.meshgrid(side, side)
        passed = transmittances(1.25) * numpy.exp(-numpy.sqrt(4.0 - x * x - z * z)[..., None] * SIGMA_T)
    within = inside(1.25)
    world = native.World(radiance=(0.0,) * 3, film_transparent=film)
    if film:
        pixels = picture(world, grains)
        numpy.testing.assert_allclose(pixels[within, 3], 1.0 - passed[within].mean(axis=-1), atol=0.02)
    shining = native.Material(model="lambert", reflectance=(0.0,) * 3, finish=native.Finish(radiance=(1.0, 0.5, 0.2)))
    pixels = picture(world, [*grains, native.Instance(wall(11.0), shining)])
    numpy.testing.assert_allclose(pixels[..., 3], 1.0, atol=1e-6)
    numpy.testing.assert_allclose(pixels[within, :3], passed[within] * (1.0, 0.5, 0.2), atol=0.02)


# The camera sees it straight through both; a mirror shows the world that lights instead.
@pytest.mark.parametrize("model", ["model_2", "transport"])
def test_the_backdrop_is_seen_through_grains_in_line(model):
    world = native.World(radiance=(0.0, 0.0, 0.5), seen=True, backdrop=native.Backdrop(radiance=(1.0, 0.2, 0.0)))
    pixels = picture(world, [native.Instance(ROUND, medium(model), place(0, 3 * i, 0)) for i in range(2)])
    passed = transmittances(1.25, spheres=2)
    within = inside(1.25)
    numpy.testing.assert_allclose(pixels[within, :2], passed[within, :2] * (1.0, 0.2), atol=0.02)


# Measured in Cycles 3.4.1: camera rays that a volume did not scatter are camera rays.
@pytest.mark.parametrize("many", [False, True])
@pytest.mark.parametrize("backdrop", [native.Backdrop(radiance=(1.0, 0.2, 0.0)), native.Backdrop(
    image=native.Surroundings(numpy.float32([[(1.0, 0.2, 0.0)] * 4] * 2)))])
def test_the_backdrop_is_seen_through_grains_that_do_not_refract(many, backdrop):
    places = numpy.array([place(0, 0, 0), place(40, 0, 0)])
    if many:
        things = {"arrays": [native.InstanceArray(ROUND, medium("model_2"), places)], "exchange": "heaps"}
    else:
        things = {"instances": [native.Instance(ROUND, medium("model_2"))]}
    pixels = picture(native.World(radiance=(0.0, 0.0, 0.5), seen=True, backdrop=backdrop), **things)
    passed = transmittances(1.25)
    within = inside(1.25)
    numpy.testing.assert_allclose(pixels[within, :2], passed[within, :2] * (1.0, 0.2), atol=0.02)
    scattered = pixels[within, 2].mean()
    assert 0.01 < scattered < 0.25, "what it scatters is the world's light"
    numpy.testing.assert_allclose(pixels[0, 0], (1.0, 0.2, 0.0, 1.0), atol=1e-6)


def test_what_refracts_shows_the_world_that_lights():
    glass = native.Material(model="model_2", sigma_a=(0.0,) * 3, sigma_s=(1e-6,) * 3, boundary="dielectric", eta=1.5)
    world = native.World(radiance=(0.0, 0.0, 0.5), seen=True, backdrop=native.Backdrop(radiance=(1.0, 0.0, 0.0)))
    pixels = picture(world, [native.Instance(ROUND, glass)])
    assert pixels[inside(1.25), 0].max() < 1e-3
    assert pixels[inside(1.25), 2].mean() == pytest.approx(0.5, abs=0.02)


def test_a_world_is_seen_or_its_film_transparent():
    with pytest.raises(native.Error, match="not both"):
        native.World(seen=True, film_transparent=True)


def test_a_film_is_kept_in_files(tmp_path):
    native.write_scene(str(tmp_path / "scene.json"),
                       native.Scene(instances=[native.Instance(ROUND, medium("model_2"))], world=FILM),
                       parallel(1.25), (SIZE, SIZE))
    scene, camera, _ = native.load_scene(str(tmp_path / "scene.json"))
    assert scene.world.film_transparent and not scene.world.seen
    view = native.View(SIZE, SIZE)
    view.set_scene(scene)
    view.set_camera(camera)
    view.render(4)
    assert math.isclose(view.read()[SIZE // 2, SIZE // 2, 3], 1.0 - numpy.exp(-2.0 * SIGMA_T).mean(), abs_tol=0.02)


TO_LIGHT = numpy.array((-math.sqrt(0.5), -math.sqrt(0.5), 0.0))
# A wall 4 behind it has its shadow in the middle of the picture.
SHADING = numpy.array((-4.0, 0.0, 0.0))


def lit_through(light, middles):
    """(SIZE, SIZE, 3): radiance of a white wall at y = 4 that has light through unit spheres, and where the first
    one's shadow is, but for its rim."""
    side = 1.25 * ((numpy.arange(SIZE) + 0.5) / (0.5 * SIZE) - 1.0)
    x, z = numpy.meshgrid(side, side)
    places = numpy.stack([x, numpy.full_like(x, 4.0), z], axis=-1)
    if isinstance(light, native.PointLight):
        towards = numpy.asarray(light.position) - places
        square = (towards * towards).sum(axis=-1)
        towards /= numpy.sqrt(square)[..., None]
        irradiance = numpy.asarray(light.radiant_intensity) / square[..., None]
    else:
        towards = numpy.broadcast_to(TO_LIGHT, places.shape)
        irradiance = numpy.asarray(light.irradiance)
    radiance = irradiance / math.pi * -towards[..., 1:2]
    within = None
    for middle in middles:
        away = places - middle
        beside = (away * away).sum(axis=-1) - (away * towards).sum(axis=-1) ** 2
        radiance = radiance * numpy.exp(-2.0 * numpy.sqrt(numpy.maximum(1.0 - beside, 0.0))[..., None] * SIGMA_T)
        within = beside < 0.8 if within is None else within
    return radiance, within


# Opaque before. Measured: totals within .6 %; pixels 1.7 to 5.2 %, of which 64 samples know a share of light to 1/64.
@pytest.mark.parametrize("model", ["model_2", "model_3", "transport"])
@pytest.mark.parametrize("light", [native.DirectionalLight(tuple(TO_LIGHT), (3.0, 2.0, 1.0)),
                                   native.PointLight(tuple(SHADING + 3.0 * TO_LIGHT), (30.0, 20.0, 10.0))])
@pytest.mark.parametrize("count", [1, 2])
def test_a_lone_thin_grain_shades_by_what_goes_straight_through(light, model, count):
    white = native.Material(model="lambert", reflectance=(1.0,) * 3)
    # The second one is nearer to the wall, so that the light is behind both.
    middles = [SHADING, SHADING - 2.5 * TO_LIGHT][:count]
    grains = [native.Instance(ROUND, medium(model), place(*middle)) for middle in middles]
    pixels = picture(native.World(radiance=(0.0,) * 3), [*grains, native.Instance(wall(4.0), white)], lights=[light],
                     samples=64)[..., :3]
    expected, within = lit_through(light, middles)
    error = numpy.abs(pixels - expected)[within].sum(axis=0) / expected[within].sum(axis=0)
    assert within.sum() > 200
    numpy.testing.assert_allclose(pixels[within].sum(axis=0), expected[within].sum(axis=0), rtol=0.02)
    assert error.max() < 0.08


def slab(thickness, half):
    """Across +y, closed, of flat faces."""
    corners = numpy.float32([(x, y, z) for x in (-half, half) for y in (-thickness / 2, thickness / 2)
                             for z in (-half, half)])
    faces = numpy.uint32([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    flat = corners[faces].reshape(-1, 3)
    normals = numpy.repeat(numpy.cross(flat[1::4] - flat[::4], flat[2::4] - flat[::4]), 4, axis=0)
    normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
    triangles = numpy.concatenate([[(4 * i, 4 * i + 1, 4 * i + 2), (4 * i, 4 * i + 2, 4 * i + 3)] for i in range(6)])
    return native.Mesh(flat, normals, triangles.astype(numpy.uint32))


# Light comes into the second grain as if the first, which is grey and stands across all of its way, were none, times
# exp(-sigma_t d): none of it did. What models see past what is opaque, up to 5 %, they see past this, too. Measured:
# within .8 %.
@pytest.mark.parametrize("model", ["model_2", "model_3", "transport"])
@pytest.mark.parametrize("count", [1, 2])
def test_a_lone_thin_grain_lets_light_through_to_another(model, count):
    black = native.Material(model="lambert", reflectance=(0.0,) * 3)
    turned = numpy.eye(4)
    turned[:3, :3] = numpy.stack([(math.sqrt(0.5), -math.sqrt(0.5), 0.0), TO_LIGHT, (0.0, 0.0, -1.0)], axis=1)
    grey = native.Material(model="model_2", sigma_a=(1.4,) * 3, sigma_s=(1e-6,) * 3, boundary="index_matched")
    slabs, opaque = [], []
    for i in range(count):
        turned[:3, 3] = (6.0 + i) * TO_LIGHT
        slabs.append(native.Instance(slab(0.5, 1.6), grey, turned.copy()))
        opaque.append(native.Instance(slab(0.5, 1.6), black, turned.copy()))
    dark = native.World(radiance=(0.0,) * 3)
    sun = native.DirectionalLight(tuple(TO_LIGHT), (3.0, 2.0, 1.0))
    alone, shaded, hidden = (picture(dark, [native.Instance(ROUND, medium(model)), *others], lights=[sun],
                                     samples=16)[..., :3].sum(axis=(0, 1)) for others in ([], slabs, opaque))
    assert (hidden < 0.06 * alone).all()
    left = math.exp(-0.7 * count)
    print((shaded - hidden) / (alone - hidden), left)
    numpy.testing.assert_allclose(shaded, left * alone + (1.0 - left) * hidden, rtol=0.03)
