# What leaves Blender: geometry, slots, instances, suns and cameras, each held against Blender's own account of it.
import math

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Euler, Matrix, Vector
from mesograin import compat
from mesograin.scene import export, meshes, smooth_normals


def add_object(name, data, matrix=Matrix()):
    new = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(new)
    new.matrix_world = matrix
    return new


def add_mesh_object(name, vertices, faces, smooth=False, **kwargs):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(faces))
    return add_object(name, mesh, **kwargs)


CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
CUBE_FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def add_cube(name="Cube", **kwargs):
    return add_mesh_object(name, CUBE, CUBE_FACES, **kwargs)


def add_sun(towards, irradiance, colour=(1.0, 1.0, 1.0), angle=0.0):
    light = bpy.data.lights.new("Sun", "SUN")
    light.energy, light.color, light.angle = irradiance, colour, angle
    return add_object("Sun", light, Vector(towards).to_track_quat("Z", "Y").to_matrix().to_4x4())


def add_camera(position, **settings):
    camera = bpy.data.cameras.new("Camera")
    for name, value in settings.items():
        setattr(camera, name, value)
    bpy.context.scene.camera = add_object("Camera", camera, Matrix.Translation(position))
    return bpy.context.scene.camera


def read_scene():
    return export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache())


@pytest.fixture
def made(monkeypatch, native):
    """Every mesh that is made from now on, as (positions, normals, triangles, uvs)."""
    arrays = []

    class Recorder:
        def __init__(self, *arguments):
            arrays.append(arguments)

        def bodies(self, *_):
            return ()

    class Recording:
        Mesh, Error, Transforms = Recorder, native.Error, native.Transforms

    monkeypatch.setattr(meshes.native_module, "get", lambda: Recording)
    return arrays


def triangle_normals(positions, triangles):
    corners = positions[triangles]
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return crosses / np.linalg.norm(crosses, axis=1, keepdims=True)


def test_flat_faces_keep_their_normals(made):
    add_cube()
    read_scene()
    [(positions, normals, triangles, _)] = made
    assert triangles.shape == (12, 3) and positions.shape == (24, 3)
    flat = np.repeat(triangle_normals(positions, triangles)[:, None], 3, axis=1)
    np.testing.assert_allclose(normals[triangles], flat, atol=1e-6)
    # Counter-clockwise seen from outside.
    assert (np.einsum("ij,ij->i", triangle_normals(positions, triangles), positions[triangles].mean(axis=1)) > 0).all()


def test_smooth_faces_share_normals(made):
    add_cube(smooth=True)
    read_scene()
    [(positions, normals, _, _)] = made
    np.testing.assert_allclose(normals, positions / math.sqrt(3.0), atol=1e-4)


def test_smooth_normals_are_the_same_every_time():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=128, ring_count=64)
    ball = bpy.context.object
    ball.data.polygons.foreach_set("use_smooth", [True] * len(ball.data.polygons))
    ball.modifiers.new("Squeezed", "SIMPLE_DEFORM").angle = 0.3
    blenders, ours = set(), set()
    for _ in range(6):
        ball.update_tag(refresh={"DATA"})
        mesh = ball.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
        compat.calculate_corners(mesh)
        normals = compat.corner_normals(mesh)
        settled = smooth_normals.settle(mesh, normals)
        np.testing.assert_allclose(settled, normals, atol=1e-4)
        assert (settled != normals).any()
        blenders.add(normals.tobytes())
        ours.add(settled.tobytes())
    assert len(ours) == 1, f"Blender itself gave {len(blenders)} versions"


def test_faces_that_fold_back_on_each_other_have_normals():
    mesh = bpy.data.meshes.new("Folded")
    mesh.from_pydata([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)], [], [(0, 1, 2), (2, 1, 0)])
    mesh.polygons.foreach_set("use_smooth", [True] * 2)
    compat.calculate_corners(mesh)
    settled = smooth_normals.settle(mesh, compat.corner_normals(mesh))
    np.testing.assert_allclose(np.linalg.norm(settled, axis=1), 1.0, atol=1e-4)


def test_smooth_and_flat_faces_of_one_mesh(made):
    cube = add_cube(smooth=True)
    cube.data.polygons[0].use_smooth = False
    read_scene()
    [(positions, normals, triangles, _)] = made
    flat = np.abs(normals).max(axis=1) > 0.99
    assert flat.sum() == 4
    np.testing.assert_allclose(normals[flat], [[-1.0, 0.0, 0.0]] * 4, atol=1e-6)
    # Beside the flat face Blender 3 averages with it and Blender 4 does not; opposite, all are smooth and shared.
    opposite = positions[:, 0] > 0.0
    assert opposite.sum() == 4
    np.testing.assert_allclose(normals[opposite], positions[opposite] / math.sqrt(3.0), atol=1e-3)


def test_custom_normals_arrive(made):
    cube = add_cube(smooth=True)
    if hasattr(cube.data, "use_auto_smooth"):
        cube.data.use_auto_smooth = True
    cube.data.normals_split_custom_set([(0.0, 0.0, 1.0)] * 24)
    read_scene()
    [(_, normals, triangles, _)] = made
    np.testing.assert_allclose(normals[triangles], [[[0.0, 0.0, 1.0]] * 3] * 12, atol=1e-3)


def test_equal_corners_are_one_vertex_and_seams_are_kept(made):
    cube = add_cube(smooth=True)
    uv = cube.data.uv_layers.new().data
    for corner in uv:
        corner.uv = (0.5, 0.5)
    for corner in cube.data.polygons[5].loop_indices:
        uv[corner].uv = (0.25, 0.75)
    read_scene()
    [(positions, normals, triangles, uvs)] = made
    assert len(positions) == len(normals) == len(uvs) == 8 + 4, "the seam's four vertices are there twice"
    corners = sorted(map(tuple, np.hstack((positions, uvs))[triangles].reshape(-1, 5).tolist()))
    loops = [cube.data.loops[loop] for triangle in cube.data.loop_triangles for loop in triangle.loops]
    assert corners == sorted((*cube.data.vertices[loop.vertex_index].co, *uv[loop.index].uv) for loop in loops)


def test_modifiers_are_applied(made):
    add_cube().modifiers.new("Subdivision", "SUBSURF").levels = 2
    read_scene()
    [(_, _, triangles, _)] = made
    assert len(triangles) == 2 * 6 * 16


def test_uvs_come_from_the_layer_that_renders(made):
    cube = add_cube()
    for name, value in (("First", 0.25), ("Second", 0.75)):
        layer = cube.data.uv_layers.new(name=name)
        layer.data.foreach_set("uv", [value] * 48)
    cube.data.uv_layers["Second"].active_render = True
    read_scene()
    [(_, _, _, uvs)] = made
    np.testing.assert_array_equal(uvs, np.full((24, 2), 0.75, dtype=np.float32))


def test_slots_split_a_mesh(made):
    cube = add_cube()
    for name in ("Red", "Green", "Unused"):
        cube.data.materials.append(bpy.data.materials.new(name))
    for polygon in cube.data.polygons:
        polygon.material_index = polygon.index % 2
    values = read_scene()
    assert [instance.material.name for instance in values.instances] == ["Red", "Green"]
    assert [len(triangles) for _, _, triangles, _ in made] == [6, 6]
    assert [len(positions) for positions, _, _, _ in made] == [12, 12]
    for positions, normals, triangles, _ in made:
        assert triangles.max() == len(positions) - 1
        flat = np.repeat(triangle_normals(positions, triangles)[:, None], 3, axis=1)
        np.testing.assert_allclose(normals[triangles], flat, atol=1e-6)


def test_slots_are_parts_of_one_object_and_other_objects_are_not():
    cube = add_cube()
    for name in ("Red", "Green"):
        cube.data.materials.append(bpy.data.materials.new(name))
    cube.data.polygons.foreach_set("material_index", [0, 0, 0, 1, 1, 1])
    add_object("Second", cube.data.copy(), Matrix())
    instancer = add_object("Instancer", None, Matrix())
    collection = bpy.data.collections.new("Instanced")
    collection.objects.link(bpy.data.objects.new("Third", cube.data))
    instancer.instance_type, instancer.instance_collection = "COLLECTION", collection
    add_object("Plain", bpy.data.meshes.new_from_object(add_cube()), Matrix())
    numbers = [instance.object for instance in read_scene().instances]
    parts = [numbers.index(number) for number in numbers if number is not None]
    assert len(parts) == 6 and len(set(parts)) == 3
    assert all(parts.count(first) == 2 for first in parts)


def test_an_instancer_without_faces_shows_its_instances_and_is_no_mistake():
    cube = add_cube()
    points = bpy.data.meshes.new("Points")
    points.from_pydata([(0.0, 0.0, float(z)) for z in range(3)], [], [])
    instancer = add_object("Points", points, Matrix())
    instancer.instance_type, cube.parent = "VERTS", instancer
    values = read_scene()
    assert {instance.object_to_world[11] for instance in values.instances} == {0.0, 1.0, 2.0}
    assert not any("no faces" in sentence for sentence in values.warnings)


def test_a_slot_that_is_gone_is_the_last_one(made):
    cube = add_cube()
    cube.data.materials.append(bpy.data.materials.new("Only"))
    cube.data.polygons.foreach_set("material_index", [5] * 6)
    [instance] = read_scene().instances
    assert instance.material.name == "Only"


def test_slots_that_are_gone_do_not_split_a_mesh(made):
    cube = add_cube()
    cube.data.materials.append(bpy.data.materials.new("Only"))
    cube.data.polygons.foreach_set("material_index", [0, 1, 2, 3, 4, 5])
    cube.data.update()
    assert [instance.material.name for instance in read_scene().instances] == ["Only"]
    assert [len(triangles) for _, _, triangles, _ in made] == [12]
    cube.data.materials.clear()
    assert len(read_scene().instances) == 1


def test_slots_of_one_material_are_one_part(made):
    cube = add_cube()
    red, green = (bpy.data.materials.new(name) for name in ("Red", "Green"))
    for material in (red, green, red, None, None):
        cube.data.materials.append(material)
    cube.data.polygons.foreach_set("material_index", [0, 1, 2, 3, 4, 2])
    cube.data.update()
    values = read_scene()
    assert [instance.material.name for instance in values.instances] == ["Red", "Green", "(none)"]
    assert [len(triangles) for _, _, triangles, _ in made] == [6, 2, 4]


def test_a_cache_knows_slots_that_come_and_go(made):
    cube = add_cube()
    red, green = (bpy.data.materials.new(name) for name in ("Red", "Green"))
    cube.data.polygons.foreach_set("material_index", [0, 0, 0, 1, 1, 1])
    cache = meshes.MeshCache()

    def worn():
        values = export.read_scene(bpy.context.evaluated_depsgraph_get(), cache)
        return [instance.material.name for instance in values.instances]

    cube.data.materials.append(red)
    assert worn() == ["Red"]
    cube.data.materials.append(green)
    assert worn() == ["Red", "Green"]
    cube.material_slots[1].link = "OBJECT"
    cube.material_slots[1].material = red
    assert worn() == ["Red"]
    cube.material_slots[1].link = "DATA"
    assert worn() == ["Red", "Green"]
    bpy.context.view_layer.material_override = green
    assert worn() == ["Green"]
    assert len(made) == 3


def test_two_grains_on_one_body_are_said_and_two_bodies_are_not():
    cube = add_cube()
    for name in ("Red", "Green"):
        cube.data.materials.append(bpy.data.materials.new(name))
        bpy.data.materials[name].mesograin.model = "model_2"
    cube.data.polygons.foreach_set("material_index", [0, 0, 0, 1, 1, 1])
    cube.data.update()
    [sentence] = [each for each in read_scene().warnings if "several materials" in each]
    assert cube.name in sentence
    cube.data = bpy.data.meshes.new("Two")
    cube.data.from_pydata([*CUBE, *((x + 5.0, y, z) for x, y, z in CUBE)], [],
                          [*CUBE_FACES, *(tuple(8 + each for each in face) for face in CUBE_FACES)])
    for name in ("Red", "Green"):
        cube.data.materials.append(bpy.data.materials[name])
    cube.data.polygons.foreach_set("material_index", [0] * 6 + [1] * 6)
    cube.data.update()
    values = read_scene()
    assert len(values.instances) == 2
    assert not [each for each in values.warnings if "several materials" in each]


def test_materials_linked_to_the_object_win(made):
    cube = add_cube()
    cube.data.materials.append(bpy.data.materials.new("OfMesh"))
    cube.material_slots[0].link = "OBJECT"
    cube.material_slots[0].material = bpy.data.materials.new("OfObject")
    [instance] = read_scene().instances
    assert instance.material.name == "OfObject"


def test_object_without_material_is_the_default_grain(native):
    add_cube()
    [instance] = read_scene().instances
    made = instance.material.to_native(native)
    assert made.model == native.Material().model and made.eta == pytest.approx(native.Material().eta)


def test_linked_meshes_are_read_once(made):
    first = add_cube()
    add_object("Second", first.data, Matrix.Translation((5.0, 0.0, 0.0)))
    values = read_scene()
    assert len(made) == 1 and len(values.instances) == 2
    assert values.instances[0].mesh is values.instances[1].mesh
    offsets = {instance.object_to_world[3:12:4] for instance in values.instances}
    assert offsets == {(0.0, 0.0, 0.0), (5.0, 0.0, 0.0)}


def test_collection_instances(made):
    collection = bpy.data.collections.new("Grains")
    mesh = bpy.data.meshes.new("Grain")
    mesh.from_pydata(CUBE, [], CUBE_FACES)
    collection.objects.link(bpy.data.objects.new("Grain", mesh))
    for offset in (3.0, 6.0):
        empty = add_object("Instancer", None, Matrix.Translation((offset, 0.0, 0.0)))
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
    values = read_scene()
    assert len(made) == 1
    offsets = sorted(instance.object_to_world[3] for instance in values.instances)
    assert offsets == [3.0, 6.0]


def test_geometry_nodes_instances(made):
    grain = add_cube("Grain")
    grain.hide_render = grain.hide_viewport = True
    points = add_mesh_object("Points", [(0, 0, 0), (4, 0, 0), (0, 4, 0)], [(0, 1, 2)])
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    if hasattr(tree, "interface"):
        for direction in ("INPUT", "OUTPUT"):
            tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    nodes, links = tree.nodes, tree.links
    start, end = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    instance, info = nodes.new("GeometryNodeInstanceOnPoints"), nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = grain
    info.inputs["As Instance"].default_value = True
    links.new(start.outputs[0], instance.inputs["Points"])
    links.new(info.outputs["Geometry"], instance.inputs["Instance"])
    links.new(instance.outputs[0], end.inputs[0])
    points.modifiers.new("Scatter", "NODES").node_group = tree
    values = read_scene()
    assert len(made) == 1
    offsets = {instance.object_to_world[3:12:4] for instance in values.instances}
    assert offsets == {(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0)}


def test_hidden_objects_stay_out(made):
    add_cube().hide_viewport = True
    assert read_scene().instances == ()


def test_curves_and_text_are_drawn(made):
    curve = bpy.data.curves.new("Ring", "CURVE")
    curve.dimensions, curve.bevel_depth = "3D", 0.1
    spline = curve.splines.new("POLY")
    spline.points.add(2)
    spline.points.foreach_set("co", [0, 0, 0, 1, 1, 0, 0, 1, 1, 1, 0, 1])
    add_object("Ring", curve)
    text = bpy.data.curves.new("Text", "FONT")
    text.body = "o"
    add_object("Text", text)
    values = read_scene()
    assert {instance.name for instance in values.instances} == {"Ring", "Text"}
    assert len(made) == 2


def test_a_cache_reads_nothing_twice_until_told(made):
    add_cube()
    cache = meshes.MeshCache()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    first = export.read_scene(depsgraph, cache)
    again = export.read_scene(depsgraph, cache)
    assert again == first
    cache.forget()
    # Read anew, but what is equal stays one mesh.
    assert export.read_scene(depsgraph, cache) == first
    assert len(made) == 1


def test_sun_is_irradiance_towards_the_light():
    add_sun((1.0, 2.0, 3.0), 5.0, colour=(1.0, 0.5, 0.25), angle=math.radians(2.0))
    [light] = read_scene().lights
    # A plane that faces its middle receives (1 + cos(angle / 2)) / 2 of that; of Cycles' even suns, the strength.
    whole = 2.0 / (1.0 + math.cos(math.radians(1.0))) if compat.has_even_lights() else 1.0
    assert light.irradiance == pytest.approx((5.0 * whole, 2.5 * whole, 1.25 * whole))
    assert light.direction_to_light == pytest.approx(Vector((1.0, 2.0, 3.0)).normalized(), abs=1e-6)
    assert light.angle == pytest.approx(math.radians(2.0))


def test_sun_direction_ignores_scale():
    sun = add_sun((0.0, 0.0, 1.0), 1.0)
    sun.matrix_world = Euler((0.4, -0.3, 0.2)).to_matrix().to_4x4() @ Matrix.Diagonal((2.0, 3.0, 0.1, 1.0))
    [light] = read_scene().lights
    assert light.direction_to_light == pytest.approx(Euler((0.4, -0.3, 0.2)).to_matrix().col[2], abs=1e-5)


CAMERAS = {
    "perspective": {},
    "long": {"lens": 85.0},
    "orthographic": {"type": "ORTHO", "ortho_scale": 5.0},
    "shifted": {"shift_x": 0.2, "shift_y": -0.15},
    "orthographic_shifted": {"type": "ORTHO", "ortho_scale": 6.0, "shift_x": -0.1, "shift_y": 0.3},
    "vertical_fit": {"sensor_fit": "VERTICAL", "sensor_height": 30.0},
    "horizontal_fit": {"sensor_fit": "HORIZONTAL", "sensor_width": 50.0},
}


@pytest.mark.parametrize("settings", CAMERAS.values(), ids=CAMERAS)
@pytest.mark.parametrize("size", [(64, 64), (96, 48), (40, 90)], ids=lambda size: f"{size[0]}x{size[1]}")
@pytest.mark.parametrize("aspect", [(1.0, 1.0), (2.0, 1.0)], ids=["square", "anamorphic"])
def test_camera_projects_as_blender_does(native, settings, size, aspect):
    scene = bpy.context.scene
    camera = add_camera((1.0, -6.0, 2.0), **settings)
    camera.rotation_euler = (1.3, 0.1, 0.2)
    camera.scale = (2.0, 2.0, 2.0)  # must not matter
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = aspect
    bpy.context.view_layer.update()
    made = export.camera_from_scene(bpy.context.evaluated_depsgraph_get(), *size)
    to_clip = np.asarray(made.camera_to_clip) @ np.asarray(made.world_to_camera)
    camera.scale = (1.0, 1.0, 1.0)  # Blender's helper is exact only without scale
    bpy.context.view_layer.update()
    for point in ((0.0, 0.0, 0.0), (1.0, 1.0, 1.5), (-1.5, 2.0, -0.5), (0.3, -1.0, 2.5)):
        clip = to_clip @ np.array((*point, 1.0))
        x, y, depth = world_to_camera_view(scene, camera, Vector(point))
        assert depth > 0.0
        assert (clip[:2] / clip[3] + 1.0) / 2.0 == pytest.approx((x, y), abs=2e-5)


@pytest.mark.parametrize("settings", CAMERAS.values(), ids=CAMERAS)
def test_a_small_cube_lands_on_the_pixel_that_blender_names(render, settings):
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 60, 40
    scene.render.film_transparent = True
    scene.mesograin.samples = 1
    camera = add_camera((0.0, 0.0, 8.0), **settings)
    place = Vector((0.8, 0.4, 0.0))
    add_cube(matrix=Matrix.Translation(place) @ Matrix.Scale(0.12, 4))
    add_sun((0.0, 0.0, 1.0), 3.0)
    picture = render()
    rows, columns = np.nonzero(picture[..., 3])
    x, y, _ = world_to_camera_view(scene, camera, place)
    assert columns.mean() + 0.5 == pytest.approx(60 * x, abs=1.0)
    assert rows.mean() + 0.5 == pytest.approx(40 * (1.0 - y), abs=1.0)
