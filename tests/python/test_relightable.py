"""Light from anywhere as a few textures: the maps of directions, and the shader's recipe in a picture of its own."""


import mesograin_native as native
import numpy
import pytest
from addon_rooms import room
from gl_picture import draw

lobes = room("studies.baking.lobes")
relightable = room("studies.baking.relightable")
files = room("studies.baking.relightable_files")


def test_a_map_tells_what_a_direction_is():
    maps = lobes.map_directions().T.reshape(3, lobes.SIDE, lobes.SIDE)
    directions = lobes.even_directions(500)
    told = lobes.look_up(maps, directions)
    # Lines between texels' middles cut off what is folded.
    assert numpy.abs(told - directions).max() < 0.06 and numpy.abs(told - directions).mean() < 0.004
    numpy.testing.assert_allclose(lobes.look_up(maps, lobes.map_directions()), lobes.map_directions(), atol=1e-9)


def test_solid_angles_are_those_of_even_directions():
    assert lobes.solid_angles().sum() == pytest.approx(4.0 * numpy.pi)
    upper = lobes.map_directions()[:, 2] > 0.5
    assert lobes.solid_angles()[upper].sum() == pytest.approx(numpy.pi, rel=0.06)


def test_a_few_maps_tell_smooth_light():
    """Of even functions of the second order there are five, and the constant."""
    x, y, z = lobes.map_directions().T
    numbers = numpy.random.default_rng(1).normal(size=(6, 40))
    seen = numpy.stack((numpy.ones_like(x), x * y, y * z, x * z, x * x - y * y, 3 * z * z - 1), axis=1) @ numbers
    maps = lobes.principal_maps(seen, 6)
    basis = maps.reshape(6, -1).T
    numpy.testing.assert_allclose(basis @ numpy.linalg.lstsq(basis, seen, rcond=None)[0], seen, atol=1e-5)


def ball(segments=24, rings=12):
    """A unit sphere, unwrapped by longitude and latitude."""
    u, v = numpy.meshgrid(numpy.linspace(0, 1, segments + 1), numpy.linspace(0, 1, rings + 1), indexing="ij")
    places = numpy.stack((numpy.cos(2 * numpy.pi * u) * numpy.sin(numpy.pi * v),
                          numpy.sin(2 * numpy.pi * u) * numpy.sin(numpy.pi * v), -numpy.cos(numpy.pi * v)), axis=-1)
    number = numpy.arange(u.size).reshape(u.shape)
    corner = [number[a:segments + a, b:rings + b].ravel() for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    triangles = numpy.concatenate((numpy.stack(corner[:3], axis=1), numpy.stack((corner[0], *corner[2:]), axis=1)))
    flat = places.reshape(-1, 3).astype(numpy.float32)
    return native.Mesh(flat, flat, triangles.astype(numpy.uint32),
                       numpy.stack((u, v), axis=-1).reshape(-1, 2).astype(numpy.float32))


@pytest.fixture(scope="module")
def made():
    """A Relightable of paint with 25 textures, and the Lit that it was made of."""
    paint = native.Material(model="lambert", reflectance=(0.8, 0.4, 0.2))
    instances = [native.Instance(ball(), paint, numpy.eye(4))]
    small, large = (relightable.Lit(native, instances, numpy.eye(3), size, 1) for size in ((24, 24), (48, 24)))
    shares = []
    found = relightable.bake(small, large, 25, shares.append)
    assert shares == sorted(shares) and shares[-1] == pytest.approx(1.0)
    return found, large


def test_what_was_baked_comes_back(made):
    found, large = made
    direction = lobes.even_directions(9)[5]
    baked = large(direction)[..., :3]
    assert numpy.abs(found.relit(direction) - baked).sum() / baked.sum() < 0.06
    assert found.errors.mean() < 0.06 and found.errors.max() < 0.12


def test_a_cancelled_bake_says_so():
    with pytest.raises(relightable.Cancelled):
        small = relightable.Lit(native, [native.Instance(ball(), native.Material(model="lambert"), numpy.eye(4))],
                                numpy.eye(3), (8, 8), 1)
        relightable.bake(small, small, 4, lambda share: setattr(type(small), "__call__", lambda self, to: None))


@pytest.mark.parametrize("direction", lobes.even_directions(4).tolist() + [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
def test_the_shaders_recipe_draws_the_same(made, tmp_path, direction):
    found, _ = made
    output = tmp_path / "paint.exr"
    files.write(native, output, "Paint", found, {"margin": 0}, "made")
    written = files.paths(output)
    textures = {"coefficients": native.read_exr(written["atlas"])[0], "lobes": native.read_exr(written["lobes"])[0]}
    height, width = found.coverage.shape
    main = f"in vec2 uv; out vec4 radiance; void main() {{ radiance = vec4(relit(uv, vec3{tuple(direction)}), 1.0); }}"
    drawn = draw(written["recipe"].read_text() + main, textures, (width, height))
    covered = found.coverage == 1.0
    expected = found.relit(numpy.array(direction))
    numpy.testing.assert_allclose(drawn[covered][:, :3], expected[covered], atol=2e-3 * expected.max())
