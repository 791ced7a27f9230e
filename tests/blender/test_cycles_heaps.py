# Heaps on the Cycles side: many grains are instances of one object, which Cycles shows as it shows as many objects.
import sys

import bpy
import numpy as np
import pytest
from cycles_scenes import depsgraph, make_sphere
from mathutils import Euler, Matrix, Vector

from mesograin import native_module
from mesograin.cycles import instancing, kinds, nodes, recipes, reference, settings, shot
from mesograin.cycles.cache import Cache
from mesograin.cycles.stage import Stage
from mesograin.scene import export

SUN = [((1.0, 1.0, 2.0), 3.0)]
SIZE = (32, 32)


def placings(count):
    """Matrices of a heap without order: turned, stretched, every other one mirrored."""
    random = np.random.default_rng(7)
    for number in range(count):
        place = Matrix.Translation(random.uniform(-2.0, 2.0, 3))
        turn = Euler(random.uniform(-np.pi, np.pi, 3)).to_matrix().to_4x4()
        scale = random.uniform(0.03, 0.09, 3) * (-1.0 if number % 2 else 1.0, 1.0, 1.0)
        yield place @ turn @ Matrix.Diagonal((*scale, 1.0))


def make_heap(count, segments=8):
    """A heap of `count` grains, objects of one mesh; the first has the material 'Sand'."""
    make_sphere(SUN, segments=segments, rings=segments // 2, model="lambert", reflectance=(0.8, 0.5, 0.2))
    grain = bpy.context.object
    matrices = list(placings(count))
    grain.matrix_world = matrices[0]
    for matrix in matrices[1:]:
        other = bpy.data.objects.new("Grain", grain.data)
        other.matrix_world = matrix
        bpy.context.scene.collection.objects.link(other)
    return matrices


def stage(evaluated, **more):
    recipe = recipes.recipe("diffuse", shot.grain_values(evaluated, {}, None), nodes.features())
    description = settings.settings(kinds.KINDS["diffuse"], 1, 0, SIZE)
    return Stage(evaluated, description, lambda _: nodes.build("Mesograin test", recipe), **more)


def grains_of(scene):
    """The matrices of all meshes that a scene shows, in an order that tells nothing of how they came to be."""
    scene.view_layers[0].update()
    evaluated = scene.view_layers[0].depsgraph
    rows = [np.array(instance.matrix_world).ravel() for instance in evaluated.object_instances
            if instance.object.type == "MESH" and instance.object.data.polygons and instance.show_self]
    rows = np.array(rows)
    return rows[np.lexsort(np.round(rows, 4).T)].reshape(-1, 4, 4)


@pytest.mark.parametrize("count", [instancing.FROM - 1, instancing.FROM + 44])
def test_every_grain_is_where_it_was(count):
    make_heap(count)
    with stage(depsgraph()) as staged:
        assert len(staged.heaps) == (count >= instancing.FROM)
        found = grains_of(staged.scene)
    np.testing.assert_allclose(found, grains_of(bpy.context.scene), atol=1e-5)


def test_a_picture_of_a_heap_is_that_of_its_objects(monkeypatch):
    make_heap(300)
    heap = reference.render(depsgraph(), "diffuse", SIZE, samples=8, seeds=(1,)).mean
    monkeypatch.setattr(instancing, "FROM", 1 << 30)
    objects = reference.render(depsgraph(), "diffuse", SIZE, samples=8, seeds=(1,)).mean
    assert objects[..., 3].mean() > 0.2 and objects[..., 0].max() > 0.2 > objects[..., 2].min()
    assert np.abs(heap - objects).sum() < 2e-3 * objects.sum()


def test_what_is_sheared_stays_an_object():
    make_heap(instancing.FROM + 10)
    stretched = bpy.data.objects.new("Stretched", None)
    stretched.scale = (1.0, 1.0, 3.0)
    bpy.context.scene.collection.objects.link(stretched)
    bpy.data.objects["Grain"].parent = stretched
    evaluated = depsgraph()
    assert not instancing.expressible([bpy.data.objects["Grain"].matrix_world]).all()
    with stage(evaluated) as staged:
        [heap] = staged.heaps
        assert len(heap.matrices) == instancing.FROM + 9
        found = grains_of(staged.scene)
    np.testing.assert_allclose(found, grains_of(bpy.context.scene), atol=1e-5)


def test_what_is_baked_stays_an_object_of_its_own():
    make_heap(instancing.FROM + 10)
    with stage(depsgraph(), apart="Grain.005") as staged:
        placed = staged.placed["Grain.005"]
        expected = bpy.data.objects["Grain.005"].matrix_world
        np.testing.assert_allclose(np.array(placed.matrix_world), np.array(expected), atol=1e-6)
        assert len(staged.heaps[0].matrices) == instancing.FROM + 9


def make_irregular(count):
    """`count` bumpy grains, resting in each other's light on a ground; the sun is low."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    make_sphere([((1.0, 0.4, 0.9), 3.0)], camera=(0.0, 0.0, 9.0), segments=32, model="lambert",
                reflectance=(0.8, 0.5, 0.2))
    grain = next(placed for placed in bpy.data.objects if placed.type == "MESH")
    for vertex in grain.data.vertices:
        x, y, z = vertex.co.normalized()
        vertex.co *= 1.0 + 0.15 * np.sin(4.0 * x + 1.0) * np.cos(5.0 * y - 3.0 * z)
    random = np.random.default_rng(11)
    for number in range(count):
        turn = Euler(random.uniform(-np.pi, np.pi, 3)).to_matrix().to_4x4()
        where = Vector((*random.uniform(-2.6, 2.6, 2), random.uniform(0.1, 0.9)))
        placed = grain if number == 0 else bpy.data.objects.new("Grain", grain.data)
        placed.matrix_world = Matrix.Translation(where) @ turn @ Matrix.Scale(random.uniform(0.06, 0.12), 4)
        if number:
            bpy.context.scene.collection.objects.link(placed)
    bpy.ops.mesh.primitive_plane_add(size=12.0)
    bpy.context.object.data.materials.append(grain.data.materials[0])


@pytest.mark.parametrize("by", ["cast", "drawn"])
def test_grains_shade_each_other_and_the_ground_as_in_cycles(by):
    size, block = 64, 4
    make_irregular(300)
    bpy.context.scene.mesograin.exchange = "off"  # the reference has no bounces
    evaluated = depsgraph()
    expected = reference.render(evaluated, "diffuse", (size, size), samples=128, seeds=(1,)).mean
    view = native_module.get().View(size, size)
    view.set_visibility(by)
    view.set_scene(export.scene_from_depsgraph(evaluated)[0])
    view.set_camera(export.camera_from_scene(evaluated, size, size))
    view.render(64)
    ours, theirs = (picture[..., :3].reshape(size // block, block, size // block, block, 3).mean(axis=(1, 3))
                    for picture in (view.read(), expected))
    assert abs(ours.sum() / theirs.sum() - 1.0) < 0.005
    assert np.abs(ours - theirs).sum() < 0.015 * theirs.sum()


def test_a_moved_grain_is_another_reference(tmp_path):
    make_heap(instancing.FROM)
    cache = Cache(tmp_path)
    assert not reference.render(depsgraph(), "diffuse", SIZE, samples=1, seeds=(1,), cache=cache).cached
    assert reference.render(depsgraph(), "diffuse", SIZE, samples=1, seeds=(1,), cache=cache).cached
    bpy.data.objects["Grain.007"].location.x += 0.01
    assert not reference.render(depsgraph(), "diffuse", SIZE, samples=1, seeds=(1,), cache=cache).cached


def test_the_work_and_the_datablocks_of_a_heap_do_not_grow_with_its_square():
    calls, datablocks, left = [], [], []
    for count in (1000, 2000):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        make_heap(count)
        evaluated = depsgraph()
        before = everything()
        number = 0

        def count_call(frame, event, argument):
            nonlocal number
            number += event in ("call", "c_call")

        sys.setprofile(count_call)
        try:
            with stage(evaluated) as staged:
                sys.setprofile(None)
                datablocks.append(everything() - before)
                assert len(staged.heaps[0].matrices) == count
                sys.setprofile(count_call)
        finally:
            sys.setprofile(None)
        calls.append(number)
        left.append(everything() - before)
    assert calls[1] < 2.1 * calls[0], calls
    assert datablocks[0] == datablocks[1] < 20 and left == [0, 0], (datablocks, left)


def everything():
    """How many datablocks there are."""
    return sum(len(getattr(bpy.data, name)) for name in
               ("scenes", "worlds", "objects", "meshes", "materials", "lights", "cameras", "node_groups"))


def test_rotations_and_scales_are_those_of_the_matrix():
    turned = [Euler((0.3, np.pi / 2, 0.8)), Euler((1.0, -np.pi / 2, -2.0)), Euler((0.0, 0.0, np.pi))]
    matrices = [np.array(euler.to_matrix().to_4x4() @ Matrix.Diagonal((-2.0, 3.0, 0.5, 1.0))) for euler in turned]
    matrices += [np.array(matrix) for matrix in placings(50)]
    assert instancing.expressible(matrices).all()
    for rotation, scale, matrix in zip(*instancing.decompose(matrices), matrices):
        made = Euler(Vector(rotation)).to_matrix() @ Matrix.Diagonal(Vector(scale))
        np.testing.assert_allclose(np.array(made), matrix[:3, :3], atol=3e-6)
    flat = np.diag((1.0, 1.0, 0.0, 1.0))
    assert not instancing.expressible([flat, np.array(Matrix.Shear("XY", 4, (0.1, 0.0)))]).any()
