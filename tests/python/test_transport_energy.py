"""The furnace in pictures: in an even white world a grain that absorbs nothing is as bright as the world wherever it is
seen, between the nodes that its transport is stored at and at its rim and edges, too."""
import math
import pathlib
import sys

import mesograin_native as native
import numpy
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import shape_pictures  # noqa: E402
import sphere_mesh  # noqa: E402


def cube():
    """Of half a side 0.8, with flat faces."""
    corners, normals, triangles = [], [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            face = numpy.roll(numpy.eye(3), -axis, axis=0)
            across, along = (face[1], face[2]) if sign > 0.0 else (face[2], face[1])
            first = len(corners)
            corners += [0.8 * (sign * face[0] + u * across + v * along)
                        for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            normals += [sign * face[0]] * 4
            triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return native.Mesh(numpy.float32(corners), numpy.float32(normals), numpy.uint32(triangles))


def seen_in_even_world(mesh, medium, samples):
    """What the camera sees where it sees the grain."""
    view = native.View(48, 48)
    place = (300.0, 200.0, 1000.0)
    view.set_camera(native.Camera.look_at(place, (0, 0, 0), (0, 1, 0), math.degrees(2.0 * math.atan(1.5 / 1077.0))))
    view.set_scene(native.Scene(instances=[native.Instance(mesh, medium)], lights=[],
                                world=native.World(radiance=(1, 1, 1), seen=True)))
    view.render(samples)
    assert not view.warnings
    return view.read()[..., :3][view.read_surfaces()["position"][..., 3] > 0.0]


SHAPES = {"sphere": lambda: native.Mesh(*sphere_mesh.sphere(96, 48)), "cube": cube}


# Measured .990 to 1.000, pixels .90 to 1.02. With what was scattered linear between nodes, and nothing seen through
# thin rims and edges of thick grains, a cube's total was .90 of the world and its edges .59; where light is refracted,
# they were .83. A rough surface's total was .973 to .984 while what left it was balanced for a half-space.
@pytest.mark.parametrize("boundary, radius, roughness", [
    ("index_matched", 1.0, 0.0), ("index_matched", 6.0, 0.0), ("index_matched", 10.0, 0.0), ("dielectric", 10.0, 0.0),
    ("dielectric", 1.0, 0.4), ("dielectric", 6.0, 0.6)])
@pytest.mark.parametrize("shape", SHAPES)
def test_a_grain_without_absorption_is_not_seen_in_an_even_world(shape, boundary, radius, roughness):
    medium = native.Material(model="transport", sigma_s=(radius,) * 3, sigma_a=(0.0,) * 3, boundary=boundary,
                             eta=1.5 if roughness else 1.3, roughness=roughness)
    seen = seen_in_even_world(SHAPES[shape](), medium, 96)[..., 1]
    print(shape, boundary, radius, roughness, f"{seen.mean():.4f} {seen.min():.3f} {seen.max():.3f}")
    assert abs(seen.mean() - 1.0) < 0.015
    assert seen.min() > 0.85 and seen.max() < 1.05


@pytest.mark.parametrize("boundary, radii", [
    ("index_matched", (1.0, 1.5, 3.0)), ("index_matched", (10.0, 6.7, 3.3)), ("dielectric", (10.0, 6.7, 3.3))])
@pytest.mark.parametrize("shape", SHAPES)
def test_no_channel_of_a_grain_without_absorption_is_seen_in_an_even_world(shape, boundary, radii):
    medium = native.Material(model="transport", sigma_s=radii, sigma_a=(0.0,) * 3, boundary=boundary, eta=1.3)
    seen = seen_in_even_world(SHAPES[shape](), medium, 96)
    print(shape, boundary, radii, seen.mean(0), seen.min(0), seen.max(0))
    assert numpy.abs(seen.mean(0) - 1.0).max() < 0.015
    assert seen.min() > 0.85 and seen.max() < 1.05


# Four directions of the world in each sample, the same for all pixels, tell next to nothing of what a narrow phase
# function shows: alone they said 1.01 to 1.30 of these four after so many samples, of single pixels 3 to 24.
@pytest.mark.parametrize("boundary, radius, g", [("index_matched", 1.0, 0.85), ("dielectric", 1.0, 0.95)])
@pytest.mark.parametrize("shape", SHAPES)
def test_a_few_samples_tell_what_a_grain_that_scatters_forwards_shows_of_an_even_world(shape, boundary, radius, g):
    medium = native.Material(model="transport", sigma_s=(radius,) * 3, sigma_a=(0.0,) * 3, g=g, boundary=boundary,
                             eta=1.3)
    seen = seen_in_even_world(SHAPES[shape](), medium, 16)
    print(shape, boundary, radius, g, f"{seen.mean():.4f} {seen.min():.3f} {seen.max():.3f}")
    assert abs(seen.mean() - 1.0) < 0.015
    # Its grain is .16 to .17: of ten seeds' thousands of pixels the brightest were 1.7 to 2.0.
    assert seen.std() < 0.2 and seen.max() < 2.2


def benched(shape):
    """One of shape_pictures.MESHES, smooth and all of it seen, and the radius of the sphere of equal volume."""
    vertices, triangles = shape_pictures.mesh(shape)
    vertices *= 1.4 / numpy.linalg.norm(vertices, axis=1).max()
    corners = vertices[triangles]
    across = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = numpy.zeros_like(vertices)
    for corner in range(3):
        numpy.add.at(normals, triangles[:, corner], across)
    normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
    volume = abs(float((corners[:, 0] * across).sum())) / 6.0
    mesh = native.Mesh(numpy.float32(vertices), numpy.float32(normals), numpy.uint32(triangles))
    return mesh, (0.75 * volume / math.pi) ** (1.0 / 3.0)


# A little too dense to be told, they are stored as if they were not: .998 to 1.003. Model 3 makes 1.02 of the flake and
# .96 of the torus.
@pytest.mark.parametrize("shape", ["flake", "torus"])
def test_a_grain_that_is_thinned_keeps_its_energy(shape):
    mesh, size = benched(shape)
    medium = native.Material(model="transport", sigma_s=(20.0 / size,) * 3, sigma_a=(0.0,) * 3, eta=1.3,
                             boundary="dielectric")
    seen = seen_in_even_world(mesh, medium, 24)[..., 1]
    print(shape, f"{seen.mean():.4f} {seen.min():.3f} {seen.max():.3f}")
    assert abs(seen.mean() - 1.0) < 0.015
    assert seen.min() > 0.85 and seen.max() < 1.05


def uneven_world():
    """Brighter above, with a small bright place."""
    heights = numpy.cos(math.pi * (numpy.arange(64) + 0.5) / 64)
    texels = numpy.ones((64, 128, 3)) * (1.0 + 0.9 * heights)[:, None, None]
    texels[20:24, 30:34] = 60.0
    return native.World(image=native.Surroundings(texels.astype(numpy.float32)))


# Where something else is in the scene, here black and far off, drawn directions alone find the world.
@pytest.mark.parametrize("boundary", ["index_matched", "dielectric"])
def test_walks_and_drawn_directions_share_the_world(boundary):
    medium = native.Material(model="transport", sigma_s=(1.0,) * 3, sigma_a=(0.01,) * 3, g=0.6, boundary=boundary,
                             eta=1.3, specular=False)
    away = numpy.eye(4)
    away[:3, 3] = (0.0, -300.0, 0.0)
    black = native.Instance(SHAPES["cube"](), native.Material(model="lambert", reflectance=(0.0,) * 3), away)
    pictures = []
    for others in ([], [black]):
        view = native.View(32, 32)
        view.set_camera(native.Camera.look_at((0.0, 0.0, 6.0), (0, 0, 0), (0, 1, 0), 24.0))
        view.set_scene(native.Scene(instances=[native.Instance(SHAPES["sphere"](), medium), *others], lights=[],
                                    world=uneven_world()))
        view.render(256)
        pictures.append(view.read()[..., 1].reshape(4, 8, 4, 8).sum(axis=(1, 3)))
    walked, drawn = pictures
    off = numpy.abs(walked - drawn).sum() / drawn.sum()
    print(boundary, f"{walked.sum() / drawn.sum():.4f} {off:.4f}")
    assert abs(walked.sum() / drawn.sum() - 1.0) < 0.015
    assert off < 0.03
