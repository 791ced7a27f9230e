# Objects of many grains: an array, a joined pile. Each grain is drawn as if it were an object of its own.
import math

import bpy
import numpy as np
import pytest
from cycles_scenes import depsgraph, make_sphere
from mathutils import Euler, Matrix, Vector
from test_export import add_object

from mesograin import compat
from mesograin.engine import material_preview, own_grain
from mesograin.scene import automatic, export, heaps, meshes
from mesograin.studies.baking import surface
from mesograin.ui import look


def read(**choices):
    return export.read_scene(depsgraph(), meshes.MeshCache(), **choices)


def places(values):
    """Where all that is drawn stands, row by row, in order, seen from the first."""
    found = np.concatenate([np.array(each.object_to_world).reshape(1, 4, 4) for each in values.instances]
                           + [heap.placings.matrices() for heap in values.heaps])[:, :3, 3]
    found = found[np.lexsort(np.round(found, 3).T)]
    return found - found[0]


@pytest.fixture
def grain():
    """A ball of a translucent material at the origin, radius .3, under a sun, amid nothing."""
    material = make_sphere([((1.0, 0.4, 1.0), 4.0)], segments=24, rings=12, model="model_2", sigma_s=(6.0, 5.0, 4.0),
                           sigma_a=(0.05, 0.1, 0.4))
    thing = bpy.data.objects["Sphere"]
    thing.data.transform(Matrix.Diagonal((0.125,) * 3 + (1.0,)))
    thing.data.update()
    bpy.context.view_layer.update()
    assert thing.data.materials[0] == material
    return thing


def repeat(thing, count, offset):
    array = thing.modifiers.new("Array", "ARRAY")
    array.count, array.use_relative_offset, array.use_constant_offset = count, False, True
    array.constant_offset_displace = offset


def scatter(thing, count=9):
    """Copies of an object, each turned and of another size, that share its mesh."""
    random = np.random.default_rng(4)
    copies = [thing]
    for number in range(1, count):
        copy = add_object(f"Copy {number}", thing.data)
        copy.location = 0.8 * Vector((number % 3 - 1, number // 3 - 1, 0.3 * random.random()))
        copy.rotation_euler = Euler(random.uniform(0.0, 6.0, 3))
        copy.scale = (random.uniform(0.7, 1.2),) * 3
        copies.append(copy)
    thing.location = (-0.8, -0.8, 0.0)
    return copies


def join(copies):
    for copy in copies:
        copy.data = copy.data.copy()
    with bpy.context.temp_override(active_object=copies[0], object=copies[0], selected_editable_objects=copies,
                                   selected_objects=copies):
        bpy.ops.object.join()


def factors_of(values):
    """By what sigma_a of each grain is multiplied, in the order in which they are read."""
    own = np.array((0.05, 0.1, 0.4))
    single = [np.array(dict(each.material.values)["sigma_a"]) / own for each in values.instances]
    many = [np.frombuffer(dict(heap.factors)["sigma_a"], dtype=np.float32).reshape(-1, 3) for heap in values.heaps]
    return np.vstack([*single, *many])


@pytest.mark.parametrize("count", (5, 100))
def test_grains_of_one_object_vary_in_colour_each_by_itself(grain, count):
    settings = grain.data.materials[0].mesograin_colours
    settings.vary, settings.colour_from, settings.colour_to = True, (0.5, 1.0, 1.0), (1.5, 1.0, 1.0)
    repeat(grain, count, (0.7, 0.0, 0.0))
    found = factors_of(read())
    assert len(found) == count and len(np.unique(found[:, 0])) == count
    assert 0.5 <= found[:, 0].min() < 0.9 and 1.1 < found[:, 0].max() <= 1.5
    np.testing.assert_allclose(found[:, 1:], 1.0, rtol=1e-5)
    grain.modifiers["Array"].count = count + 1
    np.testing.assert_allclose(factors_of(read())[:count], found, rtol=1e-5)
    assert not read(varied=False).heaps or not read(varied=False).heaps[0].factors


def test_bodies_of_instances_vary_and_other_objects_differ(grain):
    settings = grain.data.materials[0].mesograin_colours
    settings.vary = True
    repeat(grain, 30, (0.7, 0.0, 0.0))
    other = add_object("Other", grain.data)
    other.location = (0.0, 5.0, 0.0)
    repeat(other, 30, (0.7, 0.0, 0.0))
    found = factors_of(read())
    assert len(found) == 60 and len(np.unique(np.round(found[:, 0], 5))) > 55
    instancer = add_object("Instancer", bpy.data.meshes.new("points"))
    instancer.data.from_pydata([(0.0, 0.0, 0.0), (0.0, 9.0, 0.0), (0.0, 0.0, 9.0)], [], [])
    instancer.instance_type = "VERTS"
    other.parent = instancer
    bpy.context.view_layer.update()
    found = factors_of(read())
    assert len(found) == 2 * 30 + 3 * 30 and len(np.unique(np.round(found[:, 0], 5))) > 135


def test_an_array_is_its_grains(grain):
    repeat(grain, 5, (0.7, 0.0, 0.0))
    grain.location = (1.0, 2.0, 3.0)
    values = read()
    np.testing.assert_allclose(values.instances[0].object_to_world[3:12:4], (1.0, 2.0, 3.0), atol=0.02)
    assert len(values.instances) == 5 and len({each.mesh for each in values.instances}) == 1
    np.testing.assert_allclose(places(values), [(0.7 * number, 0.0, 0.0) for number in range(5)], atol=1e-5)
    assert {each.object for each in values.instances} == {None}
    repeat(grain, 20, (0.0, 0.7, 0.0))
    values = read()
    assert not values.instances and [len(heap) for heap in values.heaps] == [100]


def test_joined_grains_look_as_they_did_apart(grain, render):
    scene = bpy.context.scene
    scene.camera.data.angle = math.radians(30.0)
    scene.render.resolution_x = scene.render.resolution_y = 48
    scene.render.film_transparent = True
    scene.mesograin.samples = 16
    copies = scatter(grain)
    apart = render()
    join(copies)
    assert len(grain.data.polygons) == 9 * 24 * 12
    together = render()
    assert len({each.mesh for each in read().instances}) == 1
    assert apart[..., 3].mean() > 0.1
    np.testing.assert_allclose(together[..., 3], apart[..., 3], atol=0.02)
    assert np.abs(together - apart)[..., :3].sum() < 0.01 * apart[..., :3].sum()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(meshes.MeshPart, "bodies", lambda *_, **__: ())
        as_one = render()
    assert np.abs(as_one - apart)[..., :3].sum() > 0.03 * apart[..., :3].sum(), "which this test would not tell apart"


@pytest.mark.parametrize("model", ["model_2", "transport"])
def test_a_grain_that_is_inside_out_is_drawn_as_if_it_were_not(grain, render, model):
    scene = bpy.context.scene
    scene.camera.data.angle = math.radians(20.0)
    scene.render.resolution_x = scene.render.resolution_y = 32
    scene.mesograin.samples = 4
    grain.data.materials[0].mesograin.model = model
    bpy.ops.mesh.primitive_plane_add(size=8.0, location=(0.0, 0.0, -0.35))
    right = render()
    grain.data.flip_normals()
    grain.data.update()
    assert np.abs(render() - right)[..., :3].sum() < 5e-3 * right[..., :3].sum()


def test_what_is_no_grain_stays_whole(grain):
    repeat(grain, 5, (0.7, 0.0, 0.0))
    grain.data.materials[0] = bpy.data.materials.new("Plain")
    assert len(read().instances) == 1


def test_what_becomes_a_grain_is_read_again(grain):
    repeat(grain, 5, (0.7, 0.0, 0.0))
    material = grain.data.materials[0] = bpy.data.materials.new("Plain")
    before = read()

    class Updates:
        scene, view_layer, mode = bpy.context.scene, bpy.context.view_layer, "VIEWPORT"
        updates = [type("Update", (), {"id": material})]

    material.mesograin.model = "model_2"
    assert export.with_new_materials(before, Updates) is None
    grains = read()
    material.mesograin.sigma_s = (3.0, 3.0, 3.0)
    assert export.with_new_materials(grains, Updates) is not None


def test_instances_of_an_object_of_many(grain):
    repeat(grain, 3, (0.7, 0.0, 0.0))
    collection = bpy.data.collections.new("Row")
    bpy.context.scene.collection.objects.unlink(grain)
    collection.objects.link(grain)
    for number in range(4):
        row = add_object("Row", None, Matrix.Translation((0.0, float(number), 0.0)))
        row.instance_type, row.instance_collection = "COLLECTION", collection
    values = read()
    np.testing.assert_allclose(places(values), sorted(
        [(0.7 * x, float(y), 0.0) for x in range(3) for y in range(4)], key=lambda place: place[::-1]), atol=1e-5)
    for number in range(30):
        row = add_object("Row", None, Matrix.Translation((0.0, 0.0, 1.0 + number)))
        row.instance_type, row.instance_collection = "COLLECTION", collection
    values = read()
    assert not values.instances and [len(heap) for heap in values.heaps] == [34 * 3]


@pytest.mark.parametrize("source", ("RANGE", "NODES"))
def test_nodes_tell_the_colour_of_an_instance_and_a_range_that_of_its_grains(grain, source):
    material = grain.data.materials[0]
    material.mesograin_colours.vary, material.mesograin_colours.source = True, source
    compat.use_nodes(material)
    tree = material.node_tree
    tree.nodes.clear()
    diffuse, info, end = map(tree.nodes.new,
                             ("ShaderNodeBsdfDiffuse", "ShaderNodeObjectInfo", "ShaderNodeOutputMaterial"))
    tree.links.new(diffuse.outputs[0], end.inputs["Surface"])
    tree.links.new(info.outputs["Random"], diffuse.inputs["Color"])
    repeat(grain, 3, (0.7, 0.0, 0.0))
    collection = bpy.data.collections.new("Row")
    bpy.context.scene.collection.objects.unlink(grain)
    collection.objects.link(grain)
    for number in range(heaps.MANY):
        row = add_object("Row", None, Matrix.Translation((0.0, float(number), 0.0)))
        row.instance_type, row.instance_collection = "COLLECTION", collection
    [heap] = read().heaps
    factors = {name: np.frombuffer(numbers, dtype=np.float32).reshape(-1, 3) for name, numbers in heap.factors}
    rows = heap.placings.matrices()[:, 1, 3].round().astype(int)
    assert factors and all(len(numbers) == 3 * heaps.MANY for numbers in factors.values())
    for numbers in factors.values():
        of_rows = [numbers[rows == row] for row in range(heaps.MANY)]
        shared = source == "NODES"
        assert all((each == each[0]).all() == (shared or (numbers == 1.0).all()) for each in of_rows)
        assert len({each[0].tobytes() for each in of_rows}) > heaps.MANY // 2 or (numbers == 1.0).all()


def test_a_bake_is_of_all_grains_at_their_own_uvs(grain):
    copies = scatter(grain, 4)
    for number, copy in enumerate(copies):
        copy.data = copy.data.copy()
        uvs = np.empty(2 * len(copy.data.loops), dtype=np.float32)
        layer = copy.data.uv_layers[0].data
        layer.foreach_get("uv", uvs)
        layer.foreach_set("uv", 0.5 * uvs + np.tile((0.5 * (number % 2), 0.5 * (number // 2)),
                                                    len(copy.data.loops)).astype(np.float32))
    join(copies)
    evaluated = depsgraph()
    baked = surface.Surface(evaluated, surface.choose(evaluated, None), (32, 32))
    assert baked.render(4)
    texture = baked.texture(0)
    quarters = [texture[row:row + 16, column:column + 16] for row in (0, 16) for column in (0, 16)]
    assert all((quarter[..., 3] > 0.0).mean() > 0.8 for quarter in quarters)
    # Each was turned another way.
    means = [quarter[..., 1].mean(axis=1) for quarter in quarters]
    assert all(np.abs(one - other).max() > 0.01 for index, one in enumerate(means) for other in means[:index])


def test_what_is_said_is_of_one_grain(grain):
    material = grain.data.materials[0]
    bpy.context.scene.mesograin.millimetres_per_unit = 1.0
    alone = look.hint(material, grain, 1.0), look.grain_size(material, grain, 1.0), look.advise(material, grain, 1.0)
    repeat(grain, 5, (0.7, 0.0, 0.0))
    bpy.context.view_layer.update()
    assert grain.dimensions.x > 3.0
    assert (look.hint(material, grain, 1.0), look.advise(material, grain, 1.0)) == (alone[0], alone[2])
    assert look.grain_size(material, grain, 1.0) == pytest.approx(alone[1], rel=1e-5)
    with bpy.context.temp_override(object=grain, active_object=grain):
        bpy.ops.object.modifier_apply(modifier="Array")
    assert look.hint(material, grain, 1.0) == alone[0]
    assert look.advise(material, grain, 1.0).sentence == alone[2].sentence
    material_preview.note_object(material, grain, depsgraph())
    [shown] = own_grain.of(material.name).meshes
    assert shown.triangle_count == 2 * 24 * 11


def test_auto_does_not_walk_in_hundreds_of_shapes(grain, monkeypatch):
    material = grain.data.materials[0]
    material.mesograin.model, material.mesograin.sigma_s = "auto", (20.0, 20.0, 20.0)
    material.mesograin.boundary = "index_matched"
    random = np.random.default_rng(3)
    copies = [add_object(f"Rock {number}", grain.data.copy(), Matrix.Translation((2.0 * number, 0.0, 0.0)))
              for number in range(40)]
    for copy in copies:
        for vertex in copy.data.vertices:
            vertex.co *= random.uniform(0.9, 1.1)
    few = [copies[number].data for number in range(5)]
    values = read()
    assert {dict(each.material.values)["model"] for each in values.with_models_chosen().instances[1:]} == {"model_3"}
    [sentence] = [each for each in values.warnings if "different shape" in each]
    assert "40 grains" in sentence or "41 grains" in sentence
    assert values.error_of_models() == pytest.approx(13.3)
    for number, copy in enumerate(copies):
        copy.data = few[number % 5]
    values = read()
    assert {dict(each.material.values)["model"] for each in values.with_models_chosen().instances[1:]} == {"transport"}
    assert not [each for each in values.warnings if "different shape" in each]


def test_the_shape_of_a_turned_copy_is_known(native):
    random = np.random.default_rng(6)
    mesh = heaps.sphere()
    asked = []
    with pytest.MonkeyPatch.context() as patch:
        told = native.shape_of
        patch.setattr(native, "shape_of", lambda *arguments: asked.append(arguments) or told(*arguments))
        stretched = Matrix.Diagonal((1.0, 2.0, 0.5, 1.0))
        for number in range(12):
            placing = (Matrix.Translation(random.uniform(-5.0, 5.0, 3)) @ Euler(random.uniform(0.0, 6.0, 3)).to_matrix()
                       .to_4x4() @ Matrix.Diagonal((*(random.uniform(0.1, 9.0),) * 3, 1.0))
                       @ (stretched if number % 2 else Matrix()))
            to_world = tuple(each for row in placing for each in row)
            volume, area, closed = automatic.shape(mesh, to_world)
            expected = told(mesh, np.array(to_world).reshape(4, 4))
            assert (volume, area) == pytest.approx(expected[:2], rel=1e-4) and closed == expected[2]
    assert len(asked) <= 2
