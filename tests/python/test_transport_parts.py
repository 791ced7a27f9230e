"""The model `transport` in a grain that a line leaves and enters again: what lies beyond is seen through the rest."""

import mesograin_native as native
import numpy
import pytest

SIZE = 48
THIN = 0.005  # mean free paths a unit of length: light is scattered once at most


def boxes(*middles):
    """Cubes of side 1 in one mesh, flat faces towards the viewer."""
    corners = numpy.array([(x, y, z) for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)])
    faces = numpy.array([(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3),
                         (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)])
    places = numpy.concatenate([(corners + middle)[faces].reshape(-1, 3) for middle in middles])
    sides = places.reshape(-1, 3, 3)
    normals = numpy.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
    return native.Mesh(places.astype(numpy.float32), numpy.repeat(normals, 3, 0).astype(numpy.float32),
                       numpy.arange(len(places), dtype=numpy.uint32).reshape(-1, 3))


@pytest.fixture(scope="module")
def held():
    """Views, which hold on to what rays found in their grains: it serves each g."""
    return []


def middle_of(held, mesh, g, **medium):
    """What is seen in the middle of the picture, far from edges; lit from the side."""
    material = native.Material(model="transport", sigma_s=(THIN,) * 3, sigma_a=(0.0,) * 3, g=g, specular=False,
                               **medium)
    view = native.View(SIZE, SIZE)
    light = native.DirectionalLight((0.8, 0.6, 0.0), (1.0,) * 3)
    view.set_scene(native.Scene(instances=[native.Instance(mesh, material, numpy.eye(4))], lights=[light]))
    view.set_camera(native.Camera.look_at((0.0, 0.0, 100.0), (0.0,) * 3, (0.0, 1.0, 0.0), 0.8))
    view.render(256 if g else 16)
    assert not view.warnings
    held.append(view)
    inner = slice(SIZE // 2 - 12, SIZE // 2 + 12)
    return float(view.read()[inner, inner, 0].mean())


@pytest.mark.parametrize("medium", [{"boundary": "index_matched"}, {"eta": 1.3}], ids=["matched", "refracting"])
@pytest.mark.parametrize("g", [0.0, 0.5])
def test_a_part_behind_another_is_seen_through_it(held, medium, g):
    """The further part sends as much as the nearer one, and most of it crosses that: of its light inside a face lets
    out 1 - .017 (eta 1.3), and the nearer part's two let through as much of it each."""
    apart = 2.5  # farther than light that is refracted through one at this slant meets the other
    alone = middle_of(held, boxes((0.0, 0.0, 0.0)), g, **medium)
    both = middle_of(held, boxes((0.0, 0.0, 0.5 * apart), (0.0, 0.0, -0.5 * apart)), g, **medium)
    assert both / alone == pytest.approx(1.96, abs=0.1)
