"""What smooth and rough surfaces mirror of the world, against mirrors that are known and a quadrature of the BRDF."""
import math
import pathlib
import sys

import mesograin_native as native
import numpy
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))

import sphere_exitance  # noqa: E402

UP = (0.0, 0.0, 1.0)
EYE = numpy.array((0.0, -6.0, 2.0))


def ball(centre=(0.0, 0.0, 0.0)):
    mesh = sphere_exitance.sphere(native, 128, 64)
    placed = numpy.eye(4)
    placed[:3, 3] = centre
    return mesh, placed


def metal(alpha, reflectance=0.8):
    return native.Material(model="conductor", reflectance=(reflectance,) * 3, roughness=alpha)


def picture(instances, world, samples, size=48, field=24.0):
    view = native.View(size, size)
    view.set_scene(native.Scene(instances=instances, world=world))
    view.set_camera(native.Camera.look_at(tuple(EYE), (0, 0, 0), UP, field))
    view.render(samples)
    surfaces = view.read_surfaces()
    return view.read()[..., :3], surfaces["position"], surfaces["normal"]


def smooth_sky():
    """Brighter above, and towards +x; no edge anywhere."""
    rows, columns = numpy.meshgrid((numpy.arange(64) + 0.5) / 64, (numpy.arange(128) + 0.5) / 128, indexing="ij")
    texels = (1.0 + 0.8 * numpy.cos(math.pi * rows) + 0.3 * numpy.cos(2 * math.pi * (0.5 - columns)) *
              numpy.sin(math.pi * rows))[..., None] * numpy.array((1.0, 0.7, 0.4))
    return native.World(image=native.Surroundings(texels.astype(numpy.float32)))


def seen(world, directions):
    flat = directions.reshape(-1, 3)
    return numpy.array([world.look(tuple(one)) for one in flat]).reshape(directions.shape)


def mirrored(positions, normals):
    """(directions that a mirror shows, cosines towards the eye)"""
    to_viewer = EYE - positions[..., :3]
    to_viewer /= numpy.linalg.norm(to_viewer, axis=-1, keepdims=True)
    cosines = (to_viewer * normals).sum(axis=-1, keepdims=True)
    return 2.0 * cosines * normals - to_viewer, cosines[..., 0]


def test_one_sample_of_an_even_world_is_enough_for_a_mirror():
    mesh, placed = ball()
    found, positions, normals = picture([native.Instance(mesh, metal(0.0), placed)], native.World((1.0, 0.5, 2.0)), 1)
    inner = mirrored(positions, normals)[1] > 0.4  # no silhouette
    assert inner.sum() > 400
    off = numpy.abs(found[inner] / (0.8, 0.4, 1.6) - 1.0)
    # GGX has long tails: a facet in a hundred looks far aside, where other directions tell more.
    assert numpy.median(off) < 2e-3 and off.mean() < 0.02


def test_a_mirror_shows_the_picture_of_the_world():
    mesh, placed = ball()
    world = smooth_sky()
    found, positions, normals = picture([native.Instance(mesh, metal(0.0), placed)], world, 16)
    directions, cosines = mirrored(positions, normals)
    inner = cosines > 0.5
    expected = 0.8 * seen(world, directions[inner])
    assert numpy.abs(found[inner] - expected).mean() < 0.02 * expected.mean()


def test_a_smooth_grain_mirrors_by_fresnel():
    mesh, placed = ball()
    black = native.Material(model="model_1", sigma_a=(50.0,) * 3, sigma_s=(0.0,) * 3, eta=1.5, roughness=0.0)
    found, positions, _ = picture([native.Instance(mesh, black, placed)], native.World(), 4)
    to_viewer = EYE / numpy.linalg.norm(EYE)
    middle = numpy.abs(positions[..., :3] - to_viewer).max(axis=-1) < 0.1
    assert middle.any()
    assert found[middle].mean() == pytest.approx(0.04, rel=0.02)


def ggx_mirrored(world, normal, to_viewer, alpha, steps=256):
    """Integral over the hemisphere of D G2 / (4 mu_o), height-correlated (Heitz 2014), times the world."""
    mu = (numpy.arange(steps) + 0.5) / steps
    azimuth = 2.0 * math.pi * (numpy.arange(2 * steps) + 0.5) / (2 * steps)
    mu, azimuth = (each.ravel() for each in numpy.meshgrid(mu, azimuth))
    x = numpy.cross(normal, (1.0, 0.0, 0.0) if abs(normal[0]) < 0.9 else (0.0, 1.0, 0.0))
    x /= numpy.linalg.norm(x)
    y = numpy.cross(normal, x)
    across = numpy.sqrt(1.0 - mu * mu)
    to_light = (across * numpy.cos(azimuth))[:, None] * x + (across * numpy.sin(azimuth))[:, None] * y
    to_light += mu[:, None] * normal
    half = to_light + to_viewer
    half /= numpy.linalg.norm(half, axis=1, keepdims=True)
    cosine = numpy.clip(half @ normal, 0.0, 1.0)
    distribution = alpha ** 2 / (math.pi * (cosine ** 2 * (alpha ** 2 - 1.0) + 1.0) ** 2)
    mu_o = float(normal @ to_viewer)

    def smith(value):
        return 0.5 * (numpy.sqrt(1.0 + alpha ** 2 * (1.0 / value ** 2 - 1.0)) - 1.0)

    both = distribution / (1.0 + smith(mu) + smith(mu_o)) / (4.0 * mu_o)
    return (both[:, None] * seen(world, to_light)).mean(axis=0) * 2.0 * math.pi


@pytest.mark.parametrize("alpha", [0.2, 0.5, 1.0])
@pytest.mark.parametrize("behind", [False, True], ids=["alone", "beside another"])
def test_a_rough_metal_gathers_as_the_integral_says(alpha, behind):
    mesh, placed = ball()
    world = smooth_sky()
    instances = [native.Instance(mesh, metal(alpha, 1.0), placed)]
    if behind:  # rays are cast, and meet nothing
        instances.append(native.Instance(mesh, native.Material(model="lambert"), ball((0.0, 60.0, 0.0))[1]))
    found, positions, normals = picture(instances, world, 256, size=24)
    for pixel in ((12, 12), (8, 12), (14, 15)):
        to_viewer = EYE - positions[pixel][:3]
        expected = ggx_mirrored(world, normals[pixel].astype(float), to_viewer / numpy.linalg.norm(to_viewer), alpha)
        assert found[pixel] == pytest.approx(expected, rel=0.03)


def test_what_stands_before_the_world_hides_it_in_a_mirror():
    mesh, placed = ball()
    corners = numpy.array([(-90, -90, 0), (90, -90, 0), (90, 90, 0), (-90, 90, 0)], dtype=numpy.float32)
    plane = native.Mesh(corners, None, numpy.array([(0, 1, 2), (0, 2, 3)], dtype=numpy.uint32))
    below = numpy.eye(4)
    below[2, 3] = -1.0
    black = native.Material(model="lambert", reflectance=(0.0,) * 3)
    instances = [native.Instance(mesh, metal(0.0, 1.0), placed), native.Instance(plane, black, below)]
    found, positions, normals = picture(instances, native.World(), 4)
    of_ball = (positions[..., 3] > 0) & (positions[..., 2] > -0.97)
    rise = mirrored(positions, normals)[0][..., 2]
    above, under = of_ball & (rise > 0.2), of_ball & (rise < -0.2)
    assert above.sum() > 100 and under.sum() > 100
    # But where another sample sees the silhouette or the plane.
    assert numpy.percentile(found[above], 10) > 0.99
    assert numpy.percentile(found[under], 90) < 0.01
