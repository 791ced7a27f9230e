# A mesh of many grains falls apart into them: what is found is put together again and held against what was joined.
import mesograin_native as native
import numpy as np
import pytest

CUBE = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64)
CUBE_TRIANGLES = np.array([(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6),
                           (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)])


def turn(random):
    """A rotation, (3, 3)."""
    matrix, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return matrix * np.sign(np.linalg.det(matrix))


def rock(random):
    """(positions, triangles) of an irregular closed grain, about as large as the unit sphere."""
    base = native.Mesh(CUBE.astype(np.float32), None, CUBE_TRIANGLES.astype(np.uint32)).arrays()[0]
    return base * random.uniform(0.5, 1.0, (8, 1)) + random.uniform(-0.1, 0.1, (8, 3)), CUBE_TRIANGLES


def joined(pieces):
    """(native.Mesh, vertices) of (positions, triangles) pieces, in one."""
    starts = np.cumsum([0] + [len(positions) for positions, _ in pieces])
    positions = np.concatenate([positions for positions, _ in pieces]).astype(np.float32)
    triangles = np.concatenate([triangles + start for (_, triangles), start in zip(pieces, starts)]).astype(np.uint32)
    return native.Mesh(positions, None, triangles), np.arange(len(positions), dtype=np.uint32)


def corners(mesh, placing=None):
    """(t, 9): the places of its triangles' corners, in order."""
    positions, _, triangles = mesh.arrays()
    placing = np.eye(4) if placing is None else placing
    places = (positions @ placing[:3, :3].T + placing[:3, 3])[triangles].reshape(-1, 9)
    return places[np.lexsort(np.round(places, 3).T)]


def put_together(bodies):
    all_corners = np.concatenate([corners(mesh, placing) for mesh, placings in bodies for placing in placings])
    return all_corners[np.lexsort(np.round(all_corners, 3).T)]


def counts(bodies):
    return sorted(len(placings) for _, placings in bodies)


def moved(piece, by, scale=1.0, turned=None):
    positions, triangles = piece
    return scale * positions @ (np.eye(3) if turned is None else turned).T + by, triangles


def inside_out(piece):
    return piece[0], piece[1][:, ::-1]


CUBES = CUBE, CUBE_TRIANGLES


def bodies_of(*pieces, copies=True):
    mesh, vertices = joined(pieces)
    return mesh.bodies(vertices, copies)


def test_one_grain_has_no_bodies():
    assert bodies_of(CUBES) == []


@pytest.mark.parametrize("seed", range(5))
def test_copies_are_placings_of_one_and_all_is_where_it_was(seed):
    random = np.random.default_rng(seed)
    kinds = [rock(random) for _ in range(3)]
    of_kind = random.integers(3, size=40)
    pieces = [moved(kinds[kind], random.uniform(-30.0, 30.0, 3), random.uniform(0.3, 3.0), turn(random))
              for kind in of_kind]
    mesh, vertices = joined(pieces)
    bodies = mesh.bodies(vertices)
    assert counts(bodies) == sorted(np.bincount(of_kind).tolist())
    np.testing.assert_allclose(put_together(bodies), corners(mesh), atol=2e-4)
    for _, placings in bodies:
        linear = placings[:, :3, :3]
        scale = np.cbrt(np.linalg.det(linear))[:, None, None]
        np.testing.assert_allclose(linear @ linear.transpose(0, 2, 1) / scale**2, np.eye(3)[None] + 0 * linear,
                                   atol=1e-9)


def test_what_only_looks_alike_is_no_copy():
    random = np.random.default_rng(7)
    one = rock(random)
    bent = one[0].copy()
    bent[3] += 0.01
    stretched = one[0] * (1.0, 1.0, 1.02)
    mirrored = one[0] * (-1.0, 1.0, 1.0)
    bodies = bodies_of(one, moved((bent, one[1]), 5.0), moved((stretched, one[1]), 10.0),
                       moved((mirrored, one[1][:, ::-1]), 15.0), moved(one, 20.0))
    assert counts(bodies) == [1, 1, 1, 2]


def test_a_thousand_shapes_of_one_making_are_told_apart():
    random = np.random.default_rng(8)
    pieces = [moved(rock(random), (4.0 * (number % 10), 4.0 * (number // 10 % 10), 4.0 * (number // 100)))
              for number in range(1000)]
    mesh, vertices = joined(pieces)
    bodies = mesh.bodies(vertices)
    assert len(bodies) == 1000
    np.testing.assert_allclose(put_together(bodies), corners(mesh), atol=1e-4)


def test_a_cavity_belongs_to_its_grain():
    hollow = CUBES, inside_out(moved(CUBES, 0.0, 0.5))
    assert bodies_of(*hollow) == []
    bodies = bodies_of(moved(CUBES, (5.0, 0.0, 0.0)), *hollow, moved(CUBES, (9.0, 0.0, 0.0)))
    assert counts(bodies) == [1, 2]
    assert sorted(mesh.triangle_count for mesh, _ in bodies) == [12, 24]


def test_a_grain_in_a_cavity_is_one_of_its_own():
    bodies = bodies_of(moved(CUBES, 0.0, 4.0), inside_out(moved(CUBES, 0.0, 3.0)), CUBES)
    assert sorted(mesh.triangle_count for mesh, _ in bodies) == [12, 24]


def test_a_grain_within_another_belongs_to_it():
    assert bodies_of(moved(CUBES, 0.0, 4.0), moved(CUBES, 0.5)) == []


def test_grains_that_cross_are_two():
    assert counts(bodies_of(CUBES, moved(CUBES, 1.5))) == [2]


def test_grains_that_touch_are_two_unless_they_share_vertices():
    beside = CUBES, moved(CUBES, (2.0, 0.0, 0.0))
    assert counts(bodies_of(*beside)) == [2]
    mesh, _ = joined(beside)
    shared = np.unique(mesh.arrays()[0], axis=0, return_inverse=True)[1].ravel().astype(np.uint32)
    assert mesh.bodies(shared) == []


def test_faces_that_share_no_vertices_are_welded():
    pieces = [(CUBE[triangle] + offset, np.arange(3)[None]) for offset in (0.0, 4.0) for triangle in CUBE_TRIANGLES]
    assert counts(bodies_of(*pieces)) == [2]


def volume(mesh):
    positions, _, triangles = mesh.arrays()
    a, b, c = positions[triangles].astype(np.float64).transpose(1, 0, 2)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0


def test_what_is_inside_out_is_turned():
    [(turned, placings)] = bodies_of(inside_out(moved(CUBES, 3.0)))
    assert volume(turned) == pytest.approx(8.0) and (placings == np.eye(4)).all()
    hollow = inside_out(CUBES), moved(CUBES, 0.0, 0.5)
    [(turned, _)] = bodies_of(*hollow)
    assert volume(turned) == pytest.approx(7.0)
    rock_of = rock(np.random.default_rng(1))
    bodies = bodies_of(rock_of, inside_out(moved(rock_of, 5.0)), moved(rock_of, 9.0))
    assert all(volume(mesh) > 0.0 for mesh, _ in bodies)


def test_what_is_open_is_one_body_and_comes_last():
    sheet = CUBE[:4] - (0.0, 0.0, 5.0), np.array([(0, 1, 3), (0, 3, 2)])
    bodies = bodies_of(sheet, CUBES, moved(sheet, 9.0), moved(CUBES, 5.0))
    assert [(mesh.triangle_count, len(placings)) for mesh, placings in bodies] == [(12, 2), (4, 1)]
    np.testing.assert_array_equal(bodies[1][1], np.eye(4)[None])
    assert bodies_of(sheet, CUBES) == [], "one closed body and what is open may be one grain with a hole"


def test_without_copies_each_is_where_it_is_with_its_own_uvs():
    mesh, vertices = joined([CUBES, moved(CUBES, 5.0)])
    positions, _, triangles = mesh.arrays()
    uvs = np.random.default_rng(1).random((len(positions), 2)).astype(np.float32)
    bodies = native.Mesh(positions, None, triangles, uvs).bodies(vertices, copies=False)
    assert all((placings == np.eye(4)).all() and len(placings) == 1 for _, placings in bodies)
    for (part, _), rows in zip(bodies, (slice(8), slice(8, 16))):
        np.testing.assert_array_equal(part.arrays()[0], positions[rows])
        np.testing.assert_array_equal(part.arrays()[1], uvs[rows])


def test_vertices_are_as_many_as_positions():
    mesh, vertices = joined([CUBES, moved(CUBES, 5.0)])
    with pytest.raises(native.Error, match="16 positions.*got 15"):
        mesh.bodies(vertices[1:])
