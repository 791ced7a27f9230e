"""A grain on red paper against path tracing: it blushes, the paper is darkened under it and lit beside it."""

import mesograin_native as native
import numpy
import pytest

from test_heap_light import ROUND

GREY = numpy.array((0.8, 0.8, 0.8))
RED = numpy.array((0.8, 0.05, 0.05))
TO_SUN = numpy.array((0.6, 0.0, 0.8))
MIDDLE = numpy.array((0.0, 0.0, 1.0))
EYE = numpy.array((0.0, -12.0, 8.0))
SIZE = 64
SAMPLES = 64


def picture(sky, sun, exchange):
    paper = numpy.array([[-100, -100, 0], [100, -100, 0], [100, 100, 0], [-100, 100, 0]], numpy.float32)
    paper = native.Mesh(paper, None, numpy.array([[0, 1, 2], [0, 2, 3]], numpy.uint32))
    raised = numpy.eye(4)
    raised[2, 3] = 1.0
    instances = [native.Instance(ROUND, native.Material(model="lambert", reflectance=tuple(GREY)), raised),
                 native.Instance(paper, native.Material(model="lambert", reflectance=tuple(RED)), numpy.eye(4))]
    lights = [native.DirectionalLight(tuple(TO_SUN), (sun,) * 3)] if sun else []
    view = native.View(SIZE, SIZE)
    view.set_scene(native.Scene(instances=instances, lights=lights, world=native.World(radiance=(sky,) * 3),
                                exchange=exchange))
    view.set_camera(native.Camera.look_at(tuple(EYE), (0, 0, 0.7), (0, 0, 1), 30.0))
    view.render(SAMPLES)
    return view.read()[..., :3]


def meet(origin, direction):
    """How far to the sphere or the paper, and whether it is the sphere."""
    from_middle = origin - MIDDLE
    half = (from_middle * direction).sum(1)
    root = half * half - (from_middle * from_middle).sum(1) + 1.0
    near = numpy.where(root > 0.0, -half - numpy.sqrt(numpy.maximum(root, 0.0)), numpy.inf)
    near = numpy.where(near > 1e-4, near, numpy.inf)
    below = numpy.where(direction[:, 2] < -1e-9, -origin[:, 2] / numpy.minimum(direction[:, 2], -1e-9), numpy.inf)
    below = numpy.where(below > 1e-4, below, numpy.inf)
    return numpy.minimum(near, below), near <= below


def path_traced(sky, sun):
    random = numpy.random.default_rng(1)
    forward = (0, 0, 0.7) - EYE
    forward /= numpy.linalg.norm(forward)
    right = numpy.cross(forward, (0, 0, 1))
    right /= numpy.linalg.norm(right)
    up = numpy.cross(right, forward)
    y, x = numpy.mgrid[0:SIZE, 0:SIZE].reshape(2, -1)
    sum_ = numpy.zeros((SIZE * SIZE, 3))
    for _ in range(SAMPLES):
        across = (x + random.random(x.shape)) / SIZE * 2 - 1
        above = 1 - (y + random.random(y.shape)) / SIZE * 2
        direction = forward + numpy.tan(numpy.radians(15)) * (across[:, None] * right + above[:, None] * up)
        direction /= numpy.linalg.norm(direction, axis=1)[:, None]
        origin = numpy.broadcast_to(EYE, direction.shape)
        weight = numpy.ones_like(sum_)
        alive = numpy.arange(len(sum_))
        for _ in range(16):
            far, on_sphere = meet(origin, direction)
            met = numpy.isfinite(far)
            sum_[alive[~met]] += sky * weight[alive[~met]]
            alive = alive[met]
            place = origin[met] + far[met, None] * direction[met]
            on_sphere = on_sphere[met, None]
            normal = numpy.where(on_sphere, place - MIDDLE, (0.0, 0.0, 1.0))
            weight[alive] *= numpy.where(on_sphere, GREY, RED)
            origin = place + 1e-4 * normal
            if sun:
                lit = ~numpy.isfinite(meet(origin, numpy.broadcast_to(TO_SUN, origin.shape))[0])
                sum_[alive] += weight[alive] * (sun / numpy.pi * numpy.maximum(normal @ TO_SUN, 0) * lit)[:, None]
            direction = random.normal(size=origin.shape)
            direction = normal + direction / numpy.linalg.norm(direction, axis=1)[:, None]
            direction /= numpy.linalg.norm(direction, axis=1)[:, None]
    return (sum_ / SAMPLES).reshape(SIZE, SIZE, 3)


def blocks(image):
    return image.reshape(SIZE // 8, 8, SIZE // 8, 8, 3).mean(axis=(1, 3))


# Measured at 96 x 96: red's total 1.008 and 1.003, its blocks .9 and .5 % off; 3.4 and 3.1 % without exchange.
@pytest.mark.parametrize("sky, sun", [(1.0, 0.0), (0.0, numpy.pi)])
def test_a_grain_on_red_paper_blushes(sky, sun):
    truth = path_traced(sky, sun)
    found = picture(sky, sun, "order_1")
    alone = picture(sky, sun, "off")
    for channel in (0, 1):
        total = truth[..., channel].sum()
        assert found[..., channel].sum() == pytest.approx(total, rel=0.02)
        error = numpy.abs(blocks(found) - blocks(truth))[..., channel].sum() / blocks(truth)[..., channel].sum()
        off = numpy.abs(blocks(alone) - blocks(truth))[..., channel].sum() / blocks(truth)[..., channel].sum()
        assert error < 0.02
        if channel == 0:
            assert error < 0.5 * off
    # Under the grain's edge, where it sees the paper only.
    under = found[SIZE // 2:, SIZE // 2 - 4:SIZE // 2 + 4]
    assert (under[..., 0] - under[..., 1]).max() > 0.1


def bowl(*radii):
    """The lower caps of spheres, 1.2 high and open: of two, its inside and its outside, with little between them."""
    places, triangles = [], []
    polar, azimuth = numpy.meshgrid(numpy.linspace(numpy.pi, numpy.arccos(-1.0 / 2.2), 13),
                                    numpy.linspace(0, 2 * numpy.pi, 33), indexing="ij")
    cap = numpy.stack([numpy.sin(polar) * numpy.cos(azimuth), numpy.sin(polar) * numpy.sin(azimuth),
                       numpy.cos(polar)], axis=-1).reshape(-1, 3)
    corner = numpy.arange(13 * 33).reshape(13, 33)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    for number, radius in enumerate(radii):
        places.append(radius * cap)
        for each in ((a, b, c), (a, c, d)):
            triangles.append(number * len(cap) + numpy.stack(each[::1 - 2 * number], -1).reshape(-1, 3))
    if len(radii) == 2:
        inner, outer = corner[-1], corner[-1] + len(cap)
        for each in ((inner[:-1], outer[:-1], outer[1:]), (inner[:-1], outer[1:], inner[1:])):
            triangles.append(numpy.stack(each, -1))
    return native.Mesh(numpy.concatenate(places).astype(numpy.float32), None,
                       numpy.concatenate(triangles).astype(numpy.uint32))


# An open bowl was taken for a ball, for what it seems to enclose seen from its sphere's middle. Measured: 1.5 %, and
# .986 in all; it was 17 % and .83.
def test_an_open_bowl_is_no_ball():
    grey = native.Material(model="lambert", reflectance=(0.8,) * 3)
    places = numpy.stack([numpy.diag([0.3, 0.3, 0.3, 1.0])] * 14)
    places[:, :3, 3] = [(0.62 * (i % 4) - 0.93, 0.62 * (i // 4) - 0.93, 0.75) for i in range(14)]
    stands = numpy.eye(4)
    stands[2, 3] = 2.2
    pictures = []
    for mesh in (bowl(2.2), bowl(2.2, 2.22)):
        view = native.View(SIZE, SIZE)
        view.set_scene(native.Scene(instances=[native.Instance(mesh, grey, stands)],
                                    arrays=[native.InstanceArray(ROUND, grey, places)],
                                    lights=[native.DirectionalLight((1.0, -0.6, 2.0), (2.0,) * 3)],
                                    world=native.World(radiance=(0.3,) * 3, seen=False)))
        view.set_camera(native.Camera.look_at(tuple(EYE), (0, 0, 0.7), (0, 0, 1), 22.0))
        view.render(16)
        pictures.append(view.read()[..., 0].reshape(8, 8, 8, 8).mean(axis=(1, 3)))
    of_open, of_thick = pictures
    error = numpy.abs(of_open - of_thick).sum() / of_thick.sum()
    print(f"{error:.4f} {of_open.sum() / of_thick.sum():.4f}")
    assert error < 0.03


# What goes straight through it is exp(-sigma_t d) of what shines behind; none of it was seen, for it is no light that
# walls send on.
@pytest.mark.parametrize("exchange", ["heaps", "gathered", "path_traced"])
def test_a_wall_that_shines_is_seen_through_thin_grains_of_a_heap(exchange):
    shining = native.Material(model="lambert", reflectance=(0.0,) * 3, finish=native.Finish(radiance=(1.0, 0.5, 0.2)))
    sigma = numpy.array((0.2, 0.5, 1.0))
    thin = native.Material(model="model_2", sigma_a=tuple(sigma), sigma_s=(1e-6,) * 3, boundary="index_matched")
    side = 0.8
    places = numpy.stack([numpy.eye(4)] * 16)
    places[:, :3, 3] = [(i % 4 - 1.5, i // 4 - 1.5, 0.0) for i in range(16)]
    corners = numpy.float32([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * side - side / 2
    faces = numpy.uint32([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    flat = numpy.concatenate([corners[face] for face in faces])
    normals = numpy.repeat(numpy.cross(flat[1::4] - flat[::4], flat[2::4] - flat[::4]), 4, axis=0)
    normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
    triangles = numpy.concatenate([[(4 * i, 4 * i + 1, 4 * i + 2), (4 * i, 4 * i + 2, 4 * i + 3)] for i in range(6)])
    cube = native.Mesh(flat, normals.astype(numpy.float32), triangles.astype(numpy.uint32))
    wall = native.Mesh(numpy.float32([[-9, -9, -2], [9, -9, -2], [9, 9, -2], [-9, 9, -2]]), None,
                       numpy.uint32([[0, 1, 2], [0, 2, 3]]))
    view = native.View(SIZE, SIZE)
    view.set_scene(native.Scene(instances=[native.Instance(wall, shining)], exchange=exchange,
                                arrays=[native.InstanceArray(cube, thin, places)]))
    view.set_camera(native.Camera.look_at((0, 0, 200.0), (0, 0, 0), (0, 1, 0), numpy.degrees(2 * numpy.arctan(0.01))))
    view.render(8)
    # The camera sees 4 x 4, and a cube in the middle of each quarter of a half.
    cell = SIZE // 4
    middles = view.read()[cell // 2::cell, cell // 2::cell, :3]
    numpy.testing.assert_allclose(middles, numpy.broadcast_to(numpy.exp(-side * sigma) * (1.0, 0.5, 0.2), (4, 4, 3)),
                                  rtol=0.02)
