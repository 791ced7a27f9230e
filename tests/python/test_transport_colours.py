"""The model `transport` where red, green and blue are unlike and nothing refracts: what is scattered once is known."""

import math

import mesograin_native as native
import numpy
import pytest

SIZE = 48
DISTANCE = 6.5
FIELD_OF_VIEW = 22.0
TO_LIGHT = {"front": (0.5, 0.5, math.sqrt(0.5)), "side": (0.8, 0.6, 0.0), "aside": (0.8, -0.36, -0.48)}


def sphere(around=96, rings=48):
    theta = numpy.linspace(0.0, math.pi, rings + 1)
    phi = 2.0 * math.pi * numpy.arange(around) / around
    ring = [(math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)) for t in theta[1:-1] for p in phi]
    places = numpy.array([*ring, (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)])
    faces = []
    for step in range(around):
        beside = (step + 1) % around
        for first in range(0, (rings - 2) * around, around):
            a, b = first + step, first + beside
            faces += [(a, a + around, b + around), (a, b + around, b)]
        last = (rings - 2) * around
        faces += [(len(ring), step, beside), (len(ring) + 1, last + beside, last + step)]
    return native.Mesh(places.astype(numpy.float32), places.astype(numpy.float32), numpy.array(faces, numpy.uint32))


def picture(mesh, sigma_t, albedo, to_light, of_array=False, boundary="index_matched"):
    """(SIZE, SIZE, 3). In an array no sun is found by itself: few functions of its direction tell of it."""
    sigma_t = numpy.array(sigma_t)
    material = native.Material(model="transport", boundary=boundary, eta=1.3, specular=False,
                               sigma_s=tuple(sigma_t * albedo), sigma_a=tuple(sigma_t * (1.0 - numpy.array(albedo))))
    view = native.View(SIZE, SIZE)
    light = native.DirectionalLight(to_light, (1.0,) * 3)
    grain = {"arrays": [native.InstanceArray(mesh, material, numpy.eye(4)[None])]} if of_array else \
        {"instances": [native.Instance(mesh, material, numpy.eye(4))]}
    view.set_scene(native.Scene(**grain, lights=[light], exchange="off"))
    camera = native.Camera.look_at((0.0, 0.0, DISTANCE), (0.0,) * 3, (0.0, 1.0, 0.0), FIELD_OF_VIEW)
    view.set_camera(camera)
    view.render(16)
    return view.read()[..., :3]


def blocks(values, side=4):
    return values.reshape(SIZE // side, side, SIZE // side, side, -1).mean((1, 3))


def way_out(places, directions):
    """Out of the unit sphere, from inside."""
    along = (places * directions).sum(-1)
    return numpy.sqrt(numpy.maximum(along**2 + 1.0 - (places**2).sum(-1), 0.0)) - along


def scattered_once(sigma_t, albedo, to_light, rays=4, steps=64):
    """(SIZE, SIZE, 3): the integral of the light that comes straight in, along each view ray (Chandrasekhar 1960)."""
    count = SIZE * rays
    across = ((numpy.arange(count) + 0.5) / count * 2.0 - 1.0) * math.tan(math.radians(FIELD_OF_VIEW / 2.0))
    x, y = numpy.meshgrid(across, -across)
    rays_towards = numpy.stack([x, y, -numpy.ones_like(x)], -1)
    rays_towards /= numpy.linalg.norm(rays_towards, axis=-1, keepdims=True)
    beside = rays_towards[..., 2] * DISTANCE
    inside = beside**2 - DISTANCE**2 + 1.0
    half = numpy.sqrt(numpy.maximum(inside, 0.0))[..., None]
    entry = (0.0, 0.0, DISTANCE) - (beside[..., None] + half) * rays_towards
    radiance = numpy.zeros((count, count, 3))
    for step in range(steps):
        way = (step + 0.5) / steps * 2.0 * half
        places = entry + way * rays_towards
        there = way + way_out(places, numpy.array(to_light))[..., None]
        radiance += numpy.exp(-there * sigma_t) * (2.0 * half / steps)
    radiance *= numpy.array(sigma_t) * albedo / (4.0 * math.pi)
    return radiance.reshape(SIZE, rays, SIZE, rays, 3).mean((1, 3))


def differences(ours, truth):
    """Of each channel, in blocks."""
    return numpy.abs(blocks(ours) - blocks(truth)).sum((0, 1)) / blocks(truth).sum((0, 1))


@pytest.fixture(scope="module")
def ball():
    return sphere()


@pytest.mark.parametrize("to_light", TO_LIGHT.values(), ids=TO_LIGHT)
def test_light_that_is_scattered_once_is_exact_in_every_colour(ball, to_light):
    sigma_t, albedo = (1.0, 2.0, 3.5), (0.003,) * 3
    ours, truth = picture(ball, sigma_t, albedo, to_light), scattered_once(sigma_t, albedo, to_light)
    # Ten intervals along a view ray serve all channels; light from the side of the thickest is 4 % off.
    assert differences(ours, truth).max() < 0.05
    lit = blocks(truth).min(-1) > 0.02 * blocks(truth).max()
    numpy.testing.assert_allclose(blocks(ours)[lit], blocks(truth)[lit], rtol=0.2)


@pytest.mark.parametrize("to_light", TO_LIGHT.values(), ids=TO_LIGHT)
def test_a_colour_looks_the_same_alone_and_beside_others(ball, to_light):
    sigma_t, albedo = (1.0, 2.0, 3.5), (0.99, 0.9, 0.8)
    coloured = picture(ball, sigma_t, albedo, to_light)
    alone = [picture(ball, (sigma_t[i],) * 3, (albedo[i],) * 3, to_light)[..., i] for i in range(3)]
    assert differences(coloured, numpy.stack(alone, -1)).max() < 0.04


# What few functions tell of a sun in an array beside what is found for that very sun in a single grain: thin and thick,
# where the same places are seen of all three colours, and where they are not. Measured .007 nearer to .005 less near,
# of the thick one to .016.
@pytest.mark.parametrize("boundary, sigma_t, less_near", [
    ("index_matched", (3.0, 3.0, 3.0), 0.01), ("dielectric", (1.0, 1.5, 3.0), 0.01),
    ("dielectric", (9.0, 6.0, 3.0), 0.02)])
def test_colours_of_an_array_share_functions_of_the_place_and_are_as_near_as_alone(ball, boundary, sigma_t, less_near):
    albedo = (0.999, 0.95, 0.6)

    def off(sigma_t, albedo, to_light):
        right = picture(ball, sigma_t, albedo, to_light, False, boundary)
        return differences(picture(ball, sigma_t, albedo, to_light, True, boundary), right)

    for to_light in TO_LIGHT.values():
        together = off(sigma_t, albedo, to_light)
        alone = numpy.array([off((sigma_t[i],) * 3, (albedo[i],) * 3, to_light)[i] for i in range(3)])
        assert (together - alone).max() < less_near
