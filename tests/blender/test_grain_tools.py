# Add > Grain: shapes that are closed, as large as they say, and unwrapped; piles whose grains rest on each other.
import bmesh
import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix, Vector
from mathutils.bvhtree import BVHTree

from mesograin.grains import kinds, objects, pile
from mesograin.scene import export, meshes
from mesograin.ui import look, notes


def read_scene():
    return export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache())


@pytest.mark.parametrize("kind", kinds.KINDS)
@pytest.mark.parametrize("segments", [4, 13])
def test_shapes_are_closed_and_as_large_as_the_unit_sphere(kind, segments):
    shape = kinds.make(kind, seed=3, segments=segments)
    edges = [(face[corner], face[(corner + 1) % 4]) for face in shape.faces.tolist() for corner in range(4)]
    assert len(set(edges)) == len(edges) and {(b, a) for a, b in edges} == set(edges)
    assert len(shape.vertices) - len(edges) // 2 + len(shape.faces) == 2  # Euler: a sphere
    assert shape.volume() == pytest.approx(4.0 * np.pi / 3.0)
    again = kinds.make(kind, seed=3, segments=segments)
    # NumPy's sums round as the arrays happen to lie in memory.
    np.testing.assert_allclose(again.vertices, shape.vertices, rtol=0.0, atol=1e-12)
    if kind != "bead":
        assert not np.allclose(kinds.make(kind, seed=4, segments=segments).vertices, shape.vertices, atol=1e-3)


def sides_met(shape, origin, direction):
    """Along a line, from where on it is outside, which side of the surface it meets at each crossing: 1 is its back."""
    corners = np.concatenate((shape.faces[:, [0, 1, 2]], shape.faces[:, [0, 2, 3]]))
    a, b, c = (shape.vertices[corners[:, corner]] for corner in range(3))
    # Möller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
    across = np.cross(direction, c - a)
    determinant = np.einsum("ij,ij->i", b - a, across)
    with np.errstate(divide="ignore", invalid="ignore"):
        u = np.einsum("ij,ij->i", origin - a, across) / determinant
        turned = np.cross(origin - a, b - a)
        v = turned @ direction / determinant
        distance = np.einsum("ij,ij->i", c - a, turned) / determinant
        met = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
    return -np.sign(determinant[met])[np.argsort(distance[met])]


@pytest.mark.parametrize("habit", [{}, {"angularity": 0.0, "roundness": 1.0}, {"angularity": 1.0, "roundness": 0.0}])
@pytest.mark.parametrize("kind", kinds.KINDS)
def test_shapes_do_not_cross_themselves(kind, habit):
    """What does is drawn by model 3 where `transport` is asked for."""
    random = np.random.default_rng(1)
    shape = kinds.make(kind, seed=3, **habit)
    lower, upper = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
    for _ in range(128):
        direction = random.normal(size=3)
        direction /= np.linalg.norm(direction)
        sides = sides_met(shape, random.uniform(lower, upper) - 10.0 * direction, direction)
        np.testing.assert_array_equal(sides, np.resize((-1.0, 1.0), len(sides)))


@pytest.mark.parametrize("kind", kinds.KINDS)
def test_textures_neither_overlap_nor_stretch_much(native, kind):
    data = objects.mesh(kind, segments=12)
    bpy.context.collection.objects.link(bpy.data.objects.new("Grain", data))
    shape = kinds.make(kind, segments=12)
    across = shape.uvs[:, 2] - shape.uvs[:, 0], shape.uvs[:, 3] - shape.uvs[:, 1]
    areas = 0.5 * (across[0][:, 0] * across[1][:, 1] - across[0][:, 1] * across[1][:, 0])
    assert (areas > 0.0).all(), "each face is the right way round"
    assert 0.85 < areas.sum() <= 1.0
    (values,) = read_scene().instances
    view = native.View(256, 256)
    sun = native.DirectionalLight((0, 0, 1), (1, 1, 1))
    view.set_scene(native.Scene(instances=[values.to_native(native, values.material.to_native(native))], lights=[sun]))
    view.set_bake([0])
    assert view.uv_use()["overlapping"] == 0


def test_sand_is_of_natural_proportions():
    ratios = []
    for seed in range(40):
        vertices = kinds.make("sand", seed=seed, segments=10).vertices
        axes = np.sqrt(np.linalg.eigvalsh(np.cov(vertices.T)))
        ratios.append((axes[0] / axes[1], axes[1] / axes[2]))
    short, middle = np.mean(ratios, axis=0)
    assert short == pytest.approx(0.77, abs=0.06) and middle == pytest.approx(0.76, abs=0.06)


def test_angularity_and_roundness_do_what_they_say():
    def roughness(**habit):
        vertices = kinds.make("sand", seed=1, segments=24, **habit).vertices
        return np.linalg.norm(vertices, axis=1).std()

    def sharpness(roundness):
        shape = kinds.make("salt", segments=24, roundness=roundness)
        return np.linalg.norm(shape.vertices, axis=1).max()

    assert roughness(angularity=1.0) > roughness(angularity=0.0)
    assert sharpness(0.0) > sharpness(0.5) > sharpness(1.0)


def test_the_operator_adds_a_grain_that_undo_removes(native):
    bpy.context.scene.cursor.location = (1.0, 2.0, 3.0)
    assert bpy.ops.mesograin.add_grain(kind="salt", seed=2, size=0.5) == {"FINISHED"}
    grain = bpy.context.object
    assert grain.location == Vector((1.0, 2.0, 3.0)) and grain.data.uv_layers
    assert grain.data.materials[0].mesograin.model == "auto"
    assert not grain.data.validate()
    (values,) = read_scene().instances
    assert values.mesh.has_uvs
    for kind in kinds.KINDS:
        assert bpy.ops.mesograin.add_grain(kind=kind) == {"FINISHED"}


def test_a_pile_is_instances_that_do_not_overlap(native):
    assert bpy.ops.mesograin.add_pile(kind="bead", count=300, shapes=3, size=0.1, place="HEAP") == {"FINISHED"}
    values = read_scene()
    assert not values.instances and sum(len(heap) for heap in values.heaps) == 300 and len(values.heaps) == 3
    assert not any("no faces" in warning for warning in values.warnings), values.warnings
    places = np.concatenate([heap.placings.matrices() for heap in values.heaps])
    radii = np.linalg.norm(places[:, :3, 0], axis=1)
    middles = places[:, :3, 3]
    apart = np.linalg.norm(middles[:, None] - middles[None], axis=-1) - radii[:, None] - radii[None]
    np.fill_diagonal(apart, 1.0)
    assert apart.min() > -0.02 * 0.1
    assert (apart.min(axis=1) < 0.02 * 0.1).mean() > 0.95, "each rests on another"
    assert (middles[:, 2] - radii).min() > -0.002
    assert 0.08 <= radii.min() < 0.085 and 0.115 < radii.max() <= 0.12
    assert middles[:, 2].max() > 0.35, "it is a heap"


def grains_of(heap):
    """(a tree over the triangles, the vertices) of each grain of a pile, in its own coordinates."""
    heap.data.update()
    grains = []
    shapes = sorted(heap.modifiers[0].node_group.nodes["Collection Info"].inputs["Collection"].default_value.objects,
                    key=lambda shape: shape.name)
    for vertex, turn, size, shape in zip(heap.data.vertices, *(heap.data.attributes[name].data
                                                               for name in ("turn", "size", "shape"))):
        matrix = Matrix.LocRotScale(vertex.co, Euler(turn.vector), Vector((size.value,) * 3))
        data = shapes[shape.value].data
        corners = [matrix @ each.co for each in data.vertices]
        grains.append((BVHTree.FromPolygons(corners, [each.vertices for each in data.polygons]), corners, vertex.co))
    return grains


def is_inside(tree, place):
    """By how often a line meets the surface."""
    direction, met = Vector((0.31, 0.27, 0.91)).normalized(), 0
    while (hit := tree.ray_cast(place, direction)[0]) is not None:
        place, met = hit + 1e-5 * direction, met + 1
    return met % 2 == 1


def deepest_overlaps(grains, size):
    """Of each of some grains, how deep a vertex of it lies in another, in mean radii."""
    depths = []
    for tree, corners, middle in grains[::5]:
        reach = max((corner - middle).length for corner in corners)
        deepest = 0.0
        for other, _, there in grains:
            if other is tree or (there - middle).length > 2.5 * reach:
                continue
            for corner in corners:
                _, _, _, distance = other.find_nearest(corner, 0.5 * size)
                if distance is not None and distance > deepest * size and is_inside(other, corner):
                    deepest = distance / size
        depths.append(deepest)
    return np.array(depths)


@pytest.mark.parametrize("kind", kinds.KINDS)
def test_grains_of_a_pile_lie_beside_each_other_and_above_the_ground(native, kind):
    """By their meshes, as they are drawn."""
    assert bpy.ops.mesograin.add_pile(kind=kind, count=80, size=0.05, seed=1, segments=8) == {"FINISHED"}
    grains = grains_of(bpy.context.object)
    depths = deepest_overlaps(grains, 0.05)
    assert depths.mean() < 0.1 and depths.max() < 0.3
    assert min(corner.z for _, corners, _ in grains for corner in corners) > -0.05 * 0.05


@pytest.mark.parametrize("thick", [False, True])
def test_a_pile_settles_in_a_vessel(native, thick):
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, radius=1.0, depth=1.6, location=(0.0, 0.0, 0.8))
    vessel = bpy.context.object
    lid = next(face for face in vessel.data.polygons if face.normal.z > 0.9)
    edit = bmesh.new()
    edit.from_mesh(vessel.data)
    edit.faces.ensure_lookup_table()
    bmesh.ops.delete(edit, geom=[edit.faces[lid.index]], context="FACES_ONLY")
    edit.to_mesh(vessel.data)
    edit.free()
    if thick:
        modifier = vessel.modifiers.new("Thick", "SOLIDIFY")
        modifier.thickness, modifier.offset = 0.2, 1.0
    assert bpy.ops.mesograin.add_pile(kind="bead", count=250, place="ACTIVE", size=0.1, shapes=1) == {"FINISHED"}
    placed = np.array([vertex.co for vertex in bpy.context.object.data.vertices])
    radii = np.array([each.value for each in bpy.context.object.data.attributes["size"].data])
    assert (np.hypot(placed[:, 0], placed[:, 1]) + radii).max() < 1.005
    assert (placed[:, 2] - radii).min() > -0.005 and placed[:, 2].max() < 1.6


def test_a_pile_lies_inside_a_closed_mesh(native):
    bpy.ops.mesh.primitive_cube_add(size=2.0, location=(3.0, 1.0, 2.0))
    cube = bpy.context.object
    assert bpy.ops.mesograin.add_pile(kind="salt", count=150, place="INSIDE", size=0.1, segments=6) == {"FINISHED"}
    heap = bpy.context.object
    assert len(heap.data.vertices) == 150
    into_cube = cube.matrix_world.inverted() @ heap.matrix_world
    corners = np.array([into_cube @ corner for _, corners, _ in grains_of(heap) for corner in corners])
    assert np.abs(corners).max() < 1.01 and corners[:, 2].mean() < -0.3, "they lie on its floor"


def test_no_more_grains_come_than_fit_inside(native):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8)
    assert bpy.ops.mesograin.add_pile(kind="bead", count=1000, place="INSIDE", size=0.1, shapes=1) == {"FINISHED"}
    heap = bpy.context.object
    placed = np.array([vertex.co for vertex in heap.data.vertices])
    radii = np.array([each.value for each in heap.data.attributes["size"].data])
    assert (np.linalg.norm(placed, axis=1) + radii).max() < 1.005
    # Of the ball's volume, in balls; random ones fill .55 to .64 of what is well within.
    assert 0.35 < (radii ** 3).sum() < 0.64 and len(placed) < 1000
    attributes = {name: len(heap.data.attributes[name].data) for name in ("turn", "size", "shape")}
    assert set(attributes.values()) == {len(placed)}


def test_the_same_seed_is_the_same_pile(native):
    shapes = pile.shapes_of(["salt", "rice"])
    once, other, again = (pile.Settling(shapes, 60, 0.1, seed=seed).result() for seed in (1, 2, 1))
    np.testing.assert_array_equal(once.middles, again.middles)
    np.testing.assert_array_equal(once.angles, again.angles)
    assert not np.allclose(once.middles, other.middles)


def test_a_piles_material_is_that_of_its_grains(native):
    assert bpy.ops.mesograin.add_pile(kind="sand", count=20, segments=4) == {"FINISHED"}
    heap = bpy.context.object
    [material] = heap.data.materials
    assert {shape.active_material for shape in bpy.data.collections["Pile grains"].objects} == {material}
    assert not notes.lacks_grain(heap)
    assert look.hint(material, heap, 1.0) == "", "it is no grain as large as the pile"
    material.mesograin.sigma_s = (3.0, 4.0, 5.0)
    drawn = read_scene().instances
    assert len(drawn) == 20 and {dict(grain.material.values)["sigma_s"] for grain in drawn} == {(3.0, 4.0, 5.0)}


def test_a_pile_fills_a_box_and_lies_on_a_surface(native):
    assert bpy.ops.mesograin.add_pile(count=200, size=0.1, place="BOX", box=1.0, seed=4) == {"FINISHED"}
    assert max(max(abs(vertex.co.x), abs(vertex.co.y)) for vertex in bpy.context.object.data.vertices) < 0.45
    bpy.ops.mesh.primitive_plane_add(size=4.0, location=(7.0, 0.0, 1.0), rotation=(0.0, 0.4, 0.0))
    tilted = bpy.context.object
    assert bpy.ops.mesograin.add_pile(count=100, size=0.1, place="ACTIVE") == {"FINISHED"}
    heap = bpy.context.object
    to_plane = tilted.matrix_world.inverted()
    heights = [(to_plane @ (heap.matrix_world @ vertex.co)).z for vertex in heap.data.vertices]
    assert min(heights) > 0.04 and heap.location.x == pytest.approx(7.0, abs=1e-5)


def test_a_pile_lies_on_a_plane_of_no_height(native):
    bpy.ops.mesh.primitive_plane_add(size=4.0, location=(0.0, 0.0, 1.0))
    bpy.context.object.scale.z = 0.0
    bpy.context.view_layer.update()
    assert bpy.ops.mesograin.add_pile(count=100, size=0.1, place="ACTIVE") == {"FINISHED"}
    heap = bpy.context.object
    heights = [(heap.matrix_world @ vertex.co).z for vertex in heap.data.vertices]
    assert 1.04 < min(heights) < 1.2


def test_mistakes_are_said_in_a_sentence(native):
    with pytest.raises(RuntimeError, match="no active mesh that grains could fall on"):
        bpy.ops.mesograin.add_pile(count=10, place="ACTIVE")
    with pytest.raises(RuntimeError, match="walls leave no room"):
        bpy.ops.mesograin.add_pile(count=10, size=1.0, place="BOX", box=0.5)
    bpy.ops.mesh.primitive_plane_add()
    with pytest.raises(RuntimeError, match="encloses no room: it must be closed"):
        bpy.ops.mesograin.add_pile(count=10, size=0.05, place="INSIDE")
    bpy.ops.mesh.primitive_cube_add()
    with pytest.raises(RuntimeError, match="No grain fits inside"):
        bpy.ops.mesograin.add_pile(count=10, size=2.0, place="INSIDE")
    bpy.ops.object.empty_add()
    bpy.context.object.select_set(True)
    with pytest.raises(RuntimeError, match="no active mesh"):
        bpy.ops.mesograin.add_pile(count=10, place="ACTIVE")


def test_a_pile_settles_beside_blender_and_can_be_ended(native):
    shapes = pile.shapes_of(["sand"])
    work = pile.Settling(shapes, 100, 0.1, seed=7)
    placings = work.result()
    assert work.done and work.share > 0.9
    assert pile.settle(pile.shapes_of(["sand"]), 100, 0.1, seed=7) is placings
    ended = pile.Settling(shapes, 20000, 0.1, seed=8)
    ended.cancel()
    with pytest.raises(native.Error, match="cancelled"):
        ended.result()
