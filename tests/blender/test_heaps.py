# Instances by the hundreds: read as arrays, drawn where they are, left out where they cannot be.
import math

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix
from test_export import add_camera, add_cube, add_mesh_object, add_object, add_sun, read_scene

import mesograin
from mesograin import compat
from mesograin.engine import status
from mesograin.grains import objects, pile
from mesograin.scene import export, heaps, meshes, scattered
from mesograin.studies.comparison.ours import Ours

SIDE = 12


def scatter(places, **settings):
    """A cube of half width 0.1 on each vertex of a mesh."""
    points = add_mesh_object("Points", places, [])
    grain = add_cube("Grain", matrix=Matrix.Scale(0.1, 4))
    grain.parent, points.instance_type = points, "VERTS"
    for name, value in settings.items():
        setattr(points, name, value)
    return points, grain


def grid():
    return [(x - 0.5 * (SIDE - 1), y - 0.5 * (SIDE - 1), 0.0) for x in range(SIDE) for y in range(SIDE)]


def placings(heap):
    return heap.placings.matrices()


@pytest.mark.parametrize("begins_with", ["the instancer", "another object"])
def test_many_are_one_array_where_blender_has_them(begins_with):
    if begins_with == "another object":
        add_sun((0.0, 0.0, 1.0), math.pi)
    scatter(grid())
    values = read_scene()
    [heap] = values.heaps
    assert len(heap) == SIDE * SIDE and heap.name == "Grain"
    depsgraph = bpy.context.evaluated_depsgraph_get()
    theirs = np.array([each.matrix_world.copy() for each in depsgraph.object_instances if each.is_instance])
    np.testing.assert_array_equal(placings(heap), theirs.astype(np.float32))
    assert read_scene() == values, "what did not change is equal"


def test_few_stay_instances():
    scatter(grid()[:heaps.MANY - 1])
    values = read_scene()
    assert values.heaps == () and sum(each.name == "Grain" for each in values.instances) >= heaps.MANY - 1


def test_those_that_cannot_be_drawn_are_counted():
    points, _ = scatter(grid())
    points.scale.z = 0.0
    values = read_scene()
    assert values.heaps == ()
    assert any(f"{SIDE * SIDE} instances of 'Grain'" in sentence for sentence in values.warnings)


def test_what_is_asked_of_an_instanced_object_in_vain_is_said():
    _, grain = scatter(grid())
    add_sun((0.0, 0.0, 1.0), math.pi)
    assert not any("'Grain'" in sentence for sentence in read_scene().warnings)
    grain.is_holdout = True
    [sentence] = [sentence for sentence in read_scene().warnings if "Object 'Grain'" in sentence]
    assert "a holdout" in sentence


def test_materials_are_those_of_the_slots():
    _, grain = scatter(grid())
    red = bpy.data.materials.new("Red")
    red.mesograin.reflectance = (0.9, 0.1, 0.1)
    grain.data.materials.append(red)
    [heap] = read_scene().heaps
    assert heap.material.name == "Red" and dict(heap.material.values)["reflectance"] == pytest.approx((0.9, 0.1, 0.1))


def test_a_heap_is_seen(render):
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 4 * SIDE
    scene.render.film_transparent = True
    scene.mesograin.samples = 64
    add_sun((0.0, 0.0, 1.0), math.pi)
    add_camera((0.0, 0.0, 20.0), type="ORTHO", ortho_scale=SIDE)
    scatter(grid())
    covered = render()[..., 3].reshape(SIDE, 4, SIDE, 4).mean(axis=(1, 3))
    np.testing.assert_allclose(covered, 0.04, atol=0.005)


def test_grains_light_each_other_unless_the_scene_says_no(render):
    scene = bpy.context.scene
    assert scene.mesograin.exchange == "heaps", "of a new scene"
    scene.render.resolution_x = scene.render.resolution_y = 32
    scene.render.film_transparent = True
    scene.mesograin.samples = 8
    add_sun((0.0, 0.6, 0.8), math.pi)
    add_camera((0.0, 0.0, 20.0), type="ORTHO", ortho_scale=0.25 * SIDE)
    scatter([(0.25 * x, 0.25 * y, z) for x, y, z in grid()])
    together = render()
    exchange = status.get(status.RENDER).exchange
    assert (exchange.grains, exchange.kinds, exchange.final) == (SIDE ** 2, 1, True)
    scene.mesograin.exchange = "off"
    alone = render()
    assert status.get(status.RENDER).exchange is None
    assert np.isfinite(together).all()
    assert together[..., :3].sum() > 1.02 * alone[..., :3].sum()


def test_a_comparison_with_direct_light_alone_has_no_other(render):
    add_sun((0.0, 0.6, 0.8), math.pi)
    add_camera((0.0, 0.0, 20.0), type="ORTHO", ortho_scale=0.25 * SIDE)
    scatter([(0.25 * x, 0.25 * y, z) for x, y, z in grid()])
    depsgraph = bpy.context.evaluated_depsgraph_get()
    ours = Ours(depsgraph, (32, 32), {}, parts=1)
    for direct in (False, True):
        ours.begin({"model": "lambert"}, direct=direct)
        ours.refine(1)
        assert (ours.exchanged is None) == direct
    ours.begin({"model": "model_2"})
    ours.refine(1)
    assert ours.exchanged["grains"] >= SIDE ** 2 and "nine in ten" in ours.exchanged["stated_error"]
    without = Ours(depsgraph, (32, 32), {}, parts=1, exchange="off")
    without.begin({"model": "model_2"})
    without.refine(1)
    assert without.exchanged is None


def makes_point_clouds():
    return "POINTCLOUD" in bpy.ops.object.convert.get_rna_type().properties["target"].enum_items


@pytest.mark.skipif(not makes_point_clouds(), reason="this Blender makes no point clouds by script")
def test_points_are_spheres_of_their_radius():
    mesh = add_mesh_object("Points", [(1.0, 2.0, 3.0), (-1.0, 0.0, 0.0)], [])
    bpy.context.view_layer.objects.active = mesh
    mesh.select_set(True)
    bpy.ops.object.convert(target="POINTCLOUD")
    cloud = bpy.context.object
    for point, radius in zip(cloud.data.points, (0.5, 2.0)):
        point.radius = radius
    cloud.data.update_tag()
    cloud.matrix_world = Matrix.Translation((10.0, 0.0, 0.0))
    values = read_scene()
    found = sorted(tuple(np.reshape(each.object_to_world, (4, 4))[:3, 3]) + (each.object_to_world[0],)
                   for each in values.instances)
    assert found == [pytest.approx((9.0, 0.0, 0.0, 2.0)), pytest.approx((11.0, 2.0, 3.0, 0.5))]


def test_the_sphere_of_a_point_is_a_sphere():
    assert heaps.sphere().triangle_count == 2 * 48 * 23


def test_grains_shade_each_other_and_the_ground_as_in_cycles(tmp_path):
    """Direct light alone, in blocks of 8 x 8 pixels."""
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 96
    scene.render.resolution_percentage = 100
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    grain = bpy.context.object
    grain.data.polygons.foreach_set("use_smooth", [True] * len(grain.data.polygons))
    ground = add_mesh_object("Ground", [(-30, -30, 0), (30, -30, 0), (30, 30, 0), (-30, 30, 0)], [(0, 1, 2, 3)])
    for each, reflectance in ((grain, (0.8, 0.6, 0.4)), (ground, (0.5, 0.5, 0.5))):
        material = bpy.data.materials.new(each.name)
        material.mesograin.model, material.mesograin.reflectance = "lambert", reflectance
        each.data.materials.append(material)
    places = [(2.05 * x + layer % 2 - 8.0, 2.05 * y + layer % 2 - 8.0, 1.0 + 1.45 * layer)
              for layer in range(2) for x in range(8) for y in range(8)]
    points = add_mesh_object("Points", places, [])
    grain.parent, points.instance_type = points, "VERTS"
    add_sun((-0.5, -0.6, 0.7), 3.0, angle=0.02)
    camera = bpy.data.cameras.new("Camera")
    scene.camera = add_object("Camera", camera, Matrix.LocRotScale((0.0, -30.0, 24.0), Euler((0.9, 0.0, 0.0)), None))
    [case] = mesograin.compare(models=["lambert"], out=tmp_path / "out", samples=64, reference_samples=64,
                               cache=tmp_path / "cache", report=False).cases
    metrics = case.entry["metrics"]
    assert metrics["relative_l1_blocks_corrected"] < 0.015
    assert metrics["bias"] == pytest.approx(1.0, abs=0.005)


def test_grains_vary_in_colour_as_cycles_random_says(native):
    _, grain = scatter(grid())
    material = bpy.data.materials.new("Sand")
    material.mesograin.model = "lambert"
    material.mesograin.reflectance = (0.5, 0.5, 0.5)
    grain.data.materials.append(material)
    assert read_scene().heaps[0].factors == ()
    material.mesograin_colours.vary = True
    material.mesograin_colours.colour_from, material.mesograin_colours.colour_to = (0.5, 1.0, 1.0), (1.5, 1.0, 1.0)
    [heap] = read_scene().heaps
    [(name, numbers)] = heap.factors
    assert name == "reflectance"
    rows = np.frombuffer(numbers, dtype=np.float32).reshape(-1, 3)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    randoms = np.array([each.random_id & 0xFFFFFFFF for each in depsgraph.object_instances if each.is_instance])
    randoms = randoms / 0xFFFFFFFF
    np.testing.assert_allclose(rows, np.stack((0.5 + randoms, *np.ones((2, len(randoms)))), axis=-1), atol=1e-5)
    assert 0.25 < rows[:, 0].std() < 0.33, "spread evenly"

    material.mesograin.model = "model_2"
    material.mesograin_colours.scattering_to = 2.0
    assert [name for name, _ in read_scene().heaps[0].factors] == ["sigma_a", "sigma_s"]
    values = export.read_scene(depsgraph, meshes.MeshCache(), varied=False)
    assert values.heaps[0].factors == () and any("vary in colour" in sentence for sentence in values.warnings)


def test_few_grains_vary_as_well():
    _, grain = scatter(grid()[:20])
    material = bpy.data.materials.new("Sand")
    material.mesograin.model = "lambert"
    material.mesograin_colours.vary = True
    grain.data.materials.append(material)
    reds = {dict(each.material.values)["reflectance"][0] for each in read_scene().instances if each.name == "Grain"}
    assert len(reds) >= 20


class Updates(list):
    """What export.with_new_materials takes of a dependency graph."""

    mode = "VIEWPORT"

    @property
    def updates(self):
        return self

    @property
    def scene(self):
        return bpy.context.scene

    @property
    def view_layer(self):
        return bpy.context.view_layer


class Update:
    is_updated_geometry = is_updated_transform = True

    def __init__(self, thing):
        self.id = thing


def test_a_slider_reads_no_placing_and_sends_no_mesh(native):
    _, grain = scatter(grid())
    add_camera((0.0, 0.0, 20.0))
    add_sun((0.0, 0.0, 1.0), 1.0)
    material = bpy.data.materials.new("Sand")
    material.mesograin.model = "lambert"
    grain.data.materials.append(material)
    before = read_scene()
    view = native.View(32, 32)
    view.set_scene(before.to_native())
    view.render(1)
    material.mesograin.reflectance = (0.1, 0.2, 0.3)
    after = export.with_new_materials(before, Updates([Update(material), Update(bpy.context.scene)]))
    assert after == read_scene() != before
    assert after.heaps[0].placings is before.heaps[0].placings, "not even copied"
    sent = native.sent()
    view.set_scene(after.to_native())
    view.render(1)
    assert native.sent()["meshes"] == sent["meshes"] and native.sent()["materials"] == sent["materials"] + 1


def test_what_blender_tags_for_a_slider_is_no_more_than_a_slider():
    """From Blender 5 on also what wears the material, and the nodes that each has."""
    _, grain = scatter(grid())
    materials = [bpy.data.materials.new(name) for name in ("Sand", "Other")]
    for each in materials:
        compat.use_nodes(each)
        each.mesograin.model = "lambert"
    grain.data.materials.append(materials[0])
    before, told = read_scene(), []

    def look(_, depsgraph):
        told.append(export.with_new_materials(before, depsgraph))

    def after(change):
        told.clear()
        change()
        bpy.context.view_layer.update()
        return told

    bpy.app.handlers.depsgraph_update_post.append(look)
    try:
        [slid] = after(lambda: setattr(materials[0].mesograin, "reflectance", (0.1, 0.2, 0.3)))
        assert slid == read_scene() != before
        assert after(lambda: grain.data.materials.__setitem__(0, materials[1]))[-1] is None
        assert after(lambda: setattr(grain.data.vertices[0].co, "x", 3.0) or grain.data.update())[-1] is None
        assert after(lambda: setattr(grain.parent, "location", (1.0, 0.0, 0.0)))[-1] is None
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(look)


def test_whatever_may_be_more_than_a_slider_is_read_anew():
    _, grain = scatter(grid())
    material, plain = bpy.data.materials.new("Sand"), bpy.data.materials.new("Plain")
    material.mesograin.model = "lambert"
    grain.data.materials.append(material)
    before = read_scene()
    for changed in ([], [grain], [material, grain], [bpy.context.scene], [plain]):
        assert export.with_new_materials(before, Updates(map(Update, changed))) is None
    both = Updates([Update(material), Update(bpy.context.scene)])
    bpy.context.scene.mesograin.millimetres_per_unit = 2.0
    assert export.with_new_materials(before, both) is None
    bpy.context.scene.mesograin.millimetres_per_unit = 1.0
    assert export.with_new_materials(before, both) is not None
    bpy.context.scene.world = bpy.data.worlds.new("Bright")
    bpy.context.scene.world.color = (1.0, 0.5, 0.2)
    assert export.with_new_materials(before, both) is None
    material.mesograin_colours.vary = True
    assert export.with_new_materials(before, Updates([Update(material)])) is None
    varied = read_scene()
    material.mesograin_colours.vary = False
    assert export.with_new_materials(varied, Updates([Update(material)])) is None


def pile_of_two_shapes(count):
    """The object of a pile that is turned and moved, before anything else in the scene."""
    random = np.random.default_rng(3)
    placed = pile.Placings(random.uniform(-2.0, 2.0, (count, 3)), random.uniform(0.1, 0.3, count),
                           random.uniform(0.0, 6.0, (count, 3)), random.integers(2, size=count), 0.0)
    made = objects.add_pile(placed, [objects.add_grain("sand", segments=4, seed=seed) for seed in range(2)])
    made.location, made.rotation_euler = (1.0, 2.0, 3.0), (0.3, 0.2, 0.1)
    bpy.context.scene.collection.objects.link(made)
    return made


def test_what_geometry_nodes_scatter_is_where_blender_puts_it():
    pile_of_two_shapes(300)
    add_cube("Beside")
    values = read_scene()
    theirs = {}
    for each in bpy.context.evaluated_depsgraph_get().object_instances:
        if each.is_instance:
            theirs.setdefault(each.object.name, []).append(np.array(each.matrix_world.copy(), dtype=np.float32))
    assert [heap.name for heap in values.heaps] == list(theirs) and len(theirs) == 2
    for heap in values.heaps:
        np.testing.assert_allclose(placings(heap), np.array(theirs[heap.name]), rtol=0.0, atol=1e-6)
        assert heap.material.name == ("Sand" if heap.name == "Sand" else heap.name)
    assert [each.name for each in values.instances] == ["Beside"]


def test_geometry_nodes_are_asked_at_once_where_this_blender_tells_all():
    depsgraph = bpy.context.evaluated_depsgraph_get
    made = pile_of_two_shapes(300)
    tells = hasattr(bpy.types.Object, "evaluated_geometry")
    assert (scattered.read(depsgraph()) is not None) == tells
    # Scattered again, by an instancer of another kind: then each is looked at.
    points = add_mesh_object("Points", grid(), [])
    bpy.context.view_layer.update()
    made.parent, points.instance_type = points, "VERTS"
    assert scattered.read(depsgraph()) is None
    count = sum(each.is_instance and each.object.name.startswith("Sand") for each in depsgraph().object_instances)
    assert sum(len(heap) for heap in read_scene().heaps) == count >= 300


def test_grains_that_vary_have_the_numbers_that_blender_gives_them():
    pile_of_two_shapes(300)
    for material in bpy.data.materials:
        material.mesograin_colours.vary = True
    assert all(heap.factors for heap in read_scene().heaps)


def test_an_instancer_is_shown_beside_what_it_scatters_as_blender_shows_it():
    tree = pile_of_two_shapes(300).modifiers[0].node_group
    join, begin, end = tree.nodes.new("GeometryNodeJoinGeometry"), tree.nodes["Group Input"], tree.nodes["Group Output"]
    scattered_there = end.inputs[0].links[0].from_socket
    for socket in (begin.outputs[0], scattered_there):
        tree.links.new(socket, join.inputs[0])
    tree.links.new(join.outputs[0], end.inputs[0])
    ground = add_cube("Ground")
    ground.data.attributes.new("size", "FLOAT", "POINT").data.foreach_set("value", [0.1] * 8)
    ground.modifiers.new("Grains", "NODES").node_group = tree

    def seen():
        bpy.context.view_layer.update()
        values = read_scene()
        return sorted({each.name for each in values.instances}), sum(len(heap) for heap in values.heaps)

    assert seen() == (["Ground"], 308)
    ground.show_instancer_for_viewport = False
    assert seen() == ([], 308)
    ground.hide_viewport = True
    assert seen() == ([], 300)
