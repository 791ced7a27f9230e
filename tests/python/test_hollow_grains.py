"""A bowl by `transport`: light leaves its wall and enters it again across, and its rim has sharp edges. Beside walks of
photons here, which ask only whether a place is in the wall and share no code with the product."""
import math
import pathlib
import sys

import mesograin_native as native
import numpy
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import sphere_mesh  # noqa: E402

SIGMA_T, ALBEDO = 5.0, 0.95
OUTER, INNER, RIM = 1.0, 0.75, 0.3  # radii of the wall, and how high it is
LAMP = numpy.array((math.sqrt(3.0), 0.0, 1.0))
INTENSITY = 3.0
SIDE, BLOCK = 96, 12
AROUND, ALONG = 96, 24


def bowl():
    """A native.Mesh: the outer wall upwards, the rim, the inner wall downwards, each with normals of its own."""
    lowest = -math.pi / 2.0
    rows = []  # (radius, height, outwards and upwards parts of the normal)
    for radius, side in ((OUTER, 1.0), (INNER, -1.0)):
        angles = numpy.linspace(lowest, math.asin(RIM / radius), ALONG)[::int(side)]
        rows.append(numpy.stack((radius * numpy.cos(angles), radius * numpy.sin(angles), side * numpy.cos(angles),
                                 side * numpy.sin(angles)), axis=-1))
    rim = [(rows[0][-1][0], RIM, 0.0, 1.0), (rows[1][0][0], RIM, 0.0, 1.0)]
    profile = numpy.concatenate((rows[0], rim, rows[1]))
    profile[0, 0] = profile[-1, 0] = 0.0
    turn = numpy.linspace(0.0, 2.0 * math.pi, AROUND, endpoint=False)
    cosines, sines = numpy.cos(turn), numpy.sin(turn)

    def turned(outwards, upwards):
        return numpy.stack((outwards[:, None] * cosines, outwards[:, None] * sines,
                            numpy.broadcast_to(upwards[:, None], (len(upwards), AROUND))), axis=-1).reshape(-1, 3)

    number = numpy.arange(len(profile) * AROUND).reshape(len(profile), AROUND)
    triangles = []
    for below in range(len(profile) - 1):
        if below in (ALONG - 1, ALONG + 1):
            continue  # where walls and rim meet, they share places and no normals
        a, b = number[below], numpy.roll(number[below], -1)
        c, d = numpy.roll(number[below + 1], -1), number[below + 1]
        triangles += [numpy.stack((a, b, c), axis=-1), numpy.stack((a, c, d), axis=-1)]
    return native.Mesh(turned(profile[:, 0], profile[:, 1]).astype(numpy.float32),
                       turned(profile[:, 2], profile[:, 3]).astype(numpy.float32),
                       numpy.concatenate(triangles).astype(numpy.uint32))


def is_inside(places):
    squared = (places ** 2).sum(axis=1)
    return (squared < OUTER**2) & (squared > INNER**2) & (places[:, 2] < RIM)


def irradiance(kind, places):
    """On planes that face the light, and the direction to it."""
    if kind == "sun":
        return INTENSITY, numpy.broadcast_to(LAMP / 2.0, places.shape)
    to_lamp = LAMP - places
    squared = (to_lamp ** 2).sum(axis=1)
    return INTENSITY / squared, to_lamp / numpy.sqrt(squared)[:, None]


def arrives(places, directions, steps=64):
    """Which share of light comes straight to places from a direction: the way in the wall is summed."""
    step = 2.0 / steps
    inside = sum(is_inside(places + (number + 0.5) * step * directions) for number in range(steps))
    return numpy.exp(-SIGMA_T * step * inside)


def isotropic(random, count):
    directions = random.normal(size=(count, 3))
    return directions / numpy.sqrt((directions ** 2).sum(axis=1))[:, None]


def truth(kind, walks=2500):
    """Radiance of the bowl from far above, mean in blocks (8, 8). Flights are as if all were wall, and ended in the
    wall alone (Woodcock et al. 1965)."""
    random = numpy.random.default_rng(1)
    blocks = numpy.repeat(numpy.arange((SIDE // BLOCK) ** 2), walks)
    width = 2.0 / (SIDE // BLOCK)
    across = (random.random((blocks.size, 2)) + numpy.stack((blocks % 8, blocks // 8), axis=1)) * width - 1.0
    places = numpy.column_stack((across * (1.0, -1.0), numpy.full(blocks.size, RIM)))
    directions = numpy.broadcast_to((0.0, 0.0, -1.0), places.shape)
    left = numpy.ones(blocks.size)
    sums = numpy.zeros((SIDE // BLOCK) ** 2)
    for _ in range(400):
        places = places + random.exponential(1.0 / SIGMA_T, blocks.size)[:, None] * directions
        stays = ((places ** 2).sum(axis=1) < 2.0) & (left > 0.01)
        blocks, places, directions, left = blocks[stays], places[stays], directions[stays], left[stays]
        if not blocks.size:
            break
        met = is_inside(places)
        left = numpy.where(met, ALBEDO * left, left)
        reached, to_light = irradiance(kind, places[met])
        numpy.add.at(sums, blocks[met], left[met] / (4.0 * math.pi) * arrives(places[met], to_light) * reached)
        directions = directions.copy()
        directions[met] = isotropic(random, int(met.sum()))
    return sums.reshape(8, 8) / walks


def from_above():
    far = 1000.0
    return native.Camera.look_at((0, 0, far), (0, 0, 0), (0, 1, 0), math.degrees(2.0 * math.atan(1.0 / far)))


def picture(kind, camera, side=SIDE, samples=48):
    medium = native.Material(model="transport", sigma_s=(SIGMA_T * ALBEDO,) * 3,
                             sigma_a=(SIGMA_T * (1.0 - ALBEDO),) * 3, boundary="index_matched")
    light = (native.PointLight(LAMP, (INTENSITY,) * 3) if kind == "lamp" else
             native.DirectionalLight(tuple(LAMP / 2.0), (INTENSITY,) * 3))
    view = native.View(side, side)
    view.set_camera(camera)
    view.set_scene(native.Scene(instances=[native.Instance(bowl(), medium)], lights=[light]))
    view.render(samples)
    assert not view.warnings
    return view.read()[..., 1]


# Measured 3.5 and 5.6 percent, the truth's noise in them; where walks ended as they left the wall, 8.3 under the lamp.
@pytest.mark.parametrize("kind, most", [("sun", 0.05), ("lamp", 0.065)])
def test_light_crosses_a_bowl_to_its_other_wall(kind, most):
    expected = truth(kind)
    found = picture(kind, from_above()).reshape(8, BLOCK, 8, BLOCK).mean(axis=(1, 3))
    error = numpy.abs(found - expected).sum() / expected.sum()
    print(kind, f"{error:.4f}", f"{found.sum() / expected.sum():.4f}")
    assert error < most


def test_a_sharp_rim_is_no_dark_line():
    """A view ray that begins at an edge, which the stored surface rounds off, began outside and saw nothing."""
    image = picture("sun", native.Camera.look_at((0.0, -4.0, 2.7), (0.0, 0.0, -0.2), (0.0, 0.0, 1.0), 27.0), 240, 16)
    near = [numpy.roll(image, (down, right), (0, 1)) for down in range(-2, 3) for right in range(-2, 3)]
    within = numpy.min(near, axis=0) > 0.0
    assert within.sum() > 10000
    dark = image[within] < 0.75 * numpy.median(near, axis=0)[within]
    print(dark.sum())
    assert dark.sum() < 12


def ring():
    """A native.Mesh."""
    around, across = numpy.meshgrid(numpy.arange(48) * math.pi / 24, numpy.arange(24) * math.pi / 12, indexing="ij")
    normals = numpy.stack((numpy.cos(across) * numpy.cos(around), numpy.cos(across) * numpy.sin(around),
                           numpy.sin(across)), axis=-1)
    middles = 0.7 * numpy.stack((numpy.cos(around), numpy.sin(around), numpy.zeros_like(around)), axis=-1)
    number = numpy.arange(48 * 24).reshape(48, 24)
    a, b, c, d = (number, numpy.roll(number, -1, 0), numpy.roll(numpy.roll(number, -1, 0), -1, 1),
                  numpy.roll(number, -1, 1))
    triangles = numpy.concatenate((numpy.stack((a, b, c), axis=-1).reshape(-1, 3),
                                   numpy.stack((a, c, d), axis=-1).reshape(-1, 3)))
    return native.Mesh((middles + 0.3 * normals).reshape(-1, 3).astype(numpy.float32),
                       normals.reshape(-1, 3).astype(numpy.float32), triangles.astype(numpy.uint32))


def drawn_in_even_world(shape, model, thick, exchange="heaps", beside=()):
    """Radiance of its pixels, seen aslant, in a world of radiance 1."""
    view = native.View(48, 48)
    view.set_camera(native.Camera.look_at((3, 0, 4), (0, 0, 0), (0, 0, 1), 26.0))
    white = native.Material(model=model, sigma_s=(thick,) * 3, sigma_a=(0.0,) * 3, boundary="dielectric", eta=1.3)
    view.set_scene(native.Scene(instances=[native.Instance(shape, white), *beside], exchange=exchange,
                                world=native.World((1.0, 1.0, 1.0))))
    view.render(64 if model == "model_1" else 16)
    picture = view.read()
    return picture[picture[..., 3] > 0.999, 1]


# Measured 1.003 to 1.010; .953 to .955 without what its parts send each other.
@pytest.mark.parametrize("model, thick", [("model_1", 300.0), ("model_1", 1e6), ("model_3", 100.0),
                                          ("transport", 300.0)])
def test_a_thick_white_ring_is_as_bright_as_its_world(model, thick):
    """However it is drawn: one too thick for stored transport is by model 3."""
    assert drawn_in_even_world(ring(), model, thick).mean() == pytest.approx(1.0, abs=0.015)
    assert drawn_in_even_world(ring(), model, thick, "off").mean() < 0.97


def test_a_ring_beside_another_keeps_the_world_even():
    """Each is a surface to itself and to the other."""
    material = native.Material(model="model_1", sigma_s=(300.0,) * 3, sigma_a=(0.0,) * 3, boundary="dielectric",
                               eta=1.3)
    above = numpy.eye(4)
    above[2, 3] = 0.62
    assert drawn_in_even_world(ring(), "model_1", 300.0, beside=[native.Instance(ring(), material, above)]
                               ).mean() == pytest.approx(1.0, abs=0.02)


def test_what_is_convex_or_thin_or_known_to_its_model_pays_nothing():
    ball = native.Mesh(*sphere_mesh.sphere(48, 24))
    for shape, model, thick in ((ball, "model_1", 300.0), (ring(), "model_3", 10.0)):
        assert (drawn_in_even_world(shape, model, thick) == drawn_in_even_world(shape, model, thick, "off")).all()
