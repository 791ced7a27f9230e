"""What is one object and what are several: parts of one share a number, and a place in common makes none."""

import json

import mesograin_native as native
import numpy
import pytest

SIZE = 96
WHITE = native.Material(model="lambert", reflectance=(0.8,) * 3)
RED = native.Material(model="lambert", reflectance=(0.8, 0.2, 0.1))


def ball(middle):
    """A sphere of radius 0.5 whose vertices are placed, as one whose transform was applied is."""
    polar, azimuth = numpy.meshgrid(numpy.linspace(0, numpy.pi, 17), numpy.linspace(0, 2 * numpy.pi, 33), indexing="ij")
    normals = numpy.stack([numpy.sin(polar) * numpy.cos(azimuth), numpy.sin(polar) * numpy.sin(azimuth),
                           numpy.cos(polar)], axis=-1).reshape(-1, 3)
    corner = numpy.arange(17 * 33).reshape(17, 33)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    triangles = numpy.concatenate([numpy.stack((a, b, c), -1)[:-1].reshape(-1, 3),
                                   numpy.stack((a, c, d), -1)[1:].reshape(-1, 3)])
    return (normals * 0.5 + middle).astype(numpy.float32), normals.astype(numpy.float32), triangles


def torus():
    around, tube = numpy.meshgrid(numpy.linspace(0, 2 * numpy.pi, 49), numpy.linspace(0, 2 * numpy.pi, 25),
                                  indexing="ij")
    out = numpy.stack([numpy.cos(around), numpy.sin(around), numpy.zeros_like(around)], axis=-1)
    normals = (numpy.cos(tube)[..., None] * out + numpy.sin(tube)[..., None] * [0, 0, 1]).reshape(-1, 3)
    corner = numpy.arange(49 * 25).reshape(49, 25)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    triangles = numpy.concatenate([numpy.stack(each, -1).reshape(-1, 3) for each in ((a, b, c), (a, c, d))])
    return (0.8 * out.reshape(-1, 3) + 0.3 * normals).astype(numpy.float32), normals.astype(numpy.float32), triangles


def moved(x):
    transform = numpy.eye(4)
    transform[0, 3] = x
    return transform


def scene(instances):
    return native.Scene(instances=instances, lights=[native.DirectionalLight((1.0, -0.3, 0.6), (2.0,) * 3)])


def picture(instances):
    view = native.View(SIZE, SIZE)
    view.set_scene(scene(instances))
    view.set_camera(native.Camera.look_at((0, -2, 3.5), (0, 0, 0), (0, 0, 1), 40.0))
    view.render(4)
    return view.read()[..., :3]


# When a place in common made them parts of one, a pixel was .13 off and a block of 8 x 8 16 %.
def test_objects_whose_transforms_were_applied_are_objects():
    meshes = [native.Mesh(*ball(middle)) for middle in ((-0.5, 0.0, 0.0), (0.55, 0.0, 0.2))]
    ground = native.Mesh(numpy.float32([[-3, -3, -0.5], [3, -3, -0.5], [3, 3, -0.5], [-3, 3, -0.5]]), None,
                         numpy.uint32([[0, 1, 2], [0, 2, 3]]))
    applied = picture([native.Instance(mesh, WHITE) for mesh in (*meshes, ground)])
    told_apart = picture([native.Instance(mesh, WHITE, moved(1e-9 * i)) for i, mesh in enumerate((*meshes, ground))])
    numpy.testing.assert_allclose(applied, told_apart, atol=1e-5)


def test_parts_of_an_object_are_what_the_whole_is():
    positions, normals, triangles = torus()
    whole = picture([native.Instance(native.Mesh(positions, normals, triangles), WHITE)])
    halves = [native.Mesh(positions, normals, half) for half in numpy.split(triangles, 2)]
    materials = (WHITE, native.Material(model="lambert", reflectance=(0.8, 0.8, 0.79)))
    off = []
    for number in (7, None):
        parts = picture([native.Instance(mesh, material, object=number) for mesh, material in zip(halves, materials)])
        off.append(numpy.abs(parts - whole)[..., 0].max())
    # Measured: .017 at two pixels of its shadow's edge, and as two objects .26.
    assert off[0] < 0.03 < off[1]


def test_parts_are_written_and_read(tmp_path):
    parts = [native.Instance(native.Mesh(*ball((x, 0.0, 0.0))), material, object=number)
             for x, material, number in ((-0.5, WHITE, 4), (0.2, RED, 4), (1.5, RED, None))]
    path = tmp_path / "parts.json"
    native.write_scene(path, scene(parts), native.Camera.look_at((0, -2, 3.5), (0, 0, 0), (0, 0, 1), 40.0), (8, 8))
    read, _, _ = native.load_scene(path)
    assert [each.object for each in read.instances] == [4, 4, None]
    described = json.loads(path.read_text())
    described["objects"][0]["part_of"] = -1
    path.write_text(json.dumps(described))
    with pytest.raises(native.Error, match="part_of must lie between 0"):
        native.load_scene(path)
