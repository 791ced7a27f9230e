# F12 shows what the native module renders, pixel for pixel.
import gc
import random

import addon_utils
import bpy
import numpy as np
import pytest
from mesograin.engine import engine, rounds, status
from mesograin.engine.pace import Pace
from mesograin.engine.waiting import Waiting
from mesograin.scene import export, meshes


def render_directly(native, width, height):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    scene, warnings = export.scene_from_depsgraph(depsgraph)
    view = native.View(width, height)
    view.set_scene(scene)
    view.set_camera(export.camera_from_scene(depsgraph, width, height))
    view.render(bpy.context.scene.mesograin.samples)
    return view.read()


def compositor_tree(scene):
    """The scene's empty compositing graph, in use."""
    if hasattr(scene, "compositing_node_group"):  # from 5.0 a node group of its own
        scene.compositing_node_group = bpy.data.node_groups.new("Compositing", "CompositorNodeTree")
        return scene.compositing_node_group
    scene.use_nodes = True
    scene.node_tree.nodes.clear()
    return scene.node_tree


def compositor_output(tree):
    """The socket for the graph's picture."""
    if hasattr(bpy.types, "CompositorNodeComposite"):
        return tree.nodes.new("CompositorNodeComposite").inputs["Image"]
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    return tree.nodes.new("NodeGroupOutput").inputs["Image"]


@pytest.mark.parametrize("name", ["sphere", "grain"])
@pytest.mark.parametrize("model", ["lambert", "conductor"])
def test_blend_files_render_as_the_native_module_does(native, render, blend_files, name, model):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / f"{name}.blend"))
    scene = bpy.context.scene
    assert scene.render.engine == "MESOGRAIN"
    scene.mesograin.samples = 4
    for material in bpy.data.materials:
        material.mesograin.model = model
        material.mesograin.roughness = 0.4
    picture = render()
    # Blender's threads sum vertex normals in any order, so two evaluations differ in their last digits.
    np.testing.assert_allclose(picture, render_directly(native, 400, 400), rtol=1e-4, atol=1e-5)
    assert picture[..., 3].mean() > 0.2 and picture[..., :3].max() > 1.0
    latest = status.get(status.RENDER)
    assert (latest.samples, latest.width, latest.height, latest.warnings) == (4, 400, 400, ())
    assert latest.passes


def test_an_engine_ends_with_its_render(render, blend_files):
    """Not when Python next looks for cycles: a closed viewport would draw on until then."""
    def engines():
        return [found for found in gc.get_objects() if type(found) is engine.MesograinRenderEngine]

    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    scene = bpy.context.scene
    scene.mesograin.samples, scene.render.resolution_percentage = 1, 4
    gc.collect()
    before = engines()  # of which the class's own definition is one
    gc.disable()
    try:
        render()
        assert len(engines()) == len(before)
    finally:
        gc.enable()


def test_transport_is_drawn(native, render, blend_files):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "grain.blend"))
    scene = bpy.context.scene
    scene.mesograin.samples, scene.render.resolution_percentage = 4, 16
    for material in bpy.data.materials:
        material.mesograin.model = "transport"
        material.mesograin.scale *= 0.25  # a thin grain's is solved sooner
    picture = render()
    np.testing.assert_allclose(picture, render_directly(native, 64, 64), rtol=1e-2, atol=1e-3)
    assert picture[..., 3].mean() > 0.2 and picture[..., :3].max() > 0.05


def test_a_compositing_graph_gets_the_picture(render, blend_files):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    scene = bpy.context.scene
    scene.mesograin.samples, scene.render.resolution_percentage = 2, 25
    plain = render()
    tree = compositor_tree(scene)
    layers, half = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeExposure")
    half.inputs["Exposure"].default_value = -1.0
    tree.links.new(layers.outputs["Image"], half.inputs["Image"])
    tree.links.new(half.outputs["Image"], compositor_output(tree))
    composed = render()
    assert plain[..., 3].max() == 1.0
    np.testing.assert_allclose(composed[..., :3], 0.5 * plain[..., :3], rtol=1e-3, atol=1e-5)
    np.testing.assert_allclose(composed[..., 3], plain[..., 3], atol=1e-5)


def test_opaque_film_is_the_picture_over_black(native, render, blend_files):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    scene = bpy.context.scene
    scene.mesograin.samples = 2
    scene.render.film_transparent = False
    picture = render()
    assert (picture[..., 3] == 1.0).all()
    np.testing.assert_allclose(picture[..., :3], render_directly(native, 400, 400)[..., :3], atol=1e-4)


def test_resolution_percentage(render, blend_files):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    scene = bpy.context.scene
    scene.mesograin.samples = 1
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 300, 200, 25
    assert render().shape == (50, 75, 4)


def test_time_left_is_said_as_panels_say_it_and_goes_by_samples_alone():
    pace = Pace(64)
    pace.note(1, 50.0)  # s, in which programs were compiled
    assert pace.line() == "Sample 1/64"
    pace.note(2, 53.0)
    assert pace.line() == "Sample 2/64, about 3 min 06 s left"


def test_the_first_sample_tells_no_time_left(render, blend_files, monkeypatch):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    bpy.context.scene.mesograin.samples, bpy.context.scene.render.resolution_percentage = 8, 10
    said = []

    class Told(Pace):
        def line(self):
            said.append(super().line())
            return said[-1]

    monkeypatch.setattr(engine, "SHOW_SECONDS", 0.0)
    monkeypatch.setattr(rounds, "Pace", Told)
    render()
    assert said[0] == "Sample 1/8" and len(said) > 1
    assert all(line.endswith(" left") for line in said[1:]), said


def test_who_waits_is_told_for_what_and_how_long():
    transport, begun = Waiting(), "Computing how light goes in grains, once for each shape and medium"
    assert transport.sentence(["transport"], 0.04, 50.0) == f"{begun}: 4%"
    assert transport.sentence(["transport"], 0.05, 51.5) == f"{begun}: 5%", "too little is done to tell"
    assert transport.sentence(["transport"], 0.28, 56.0) == f"{begun}: 28%, about 18 s left"
    assert Waiting().sentence(["exchange"], 0.5, 0.0) == (
        "Computing how light goes between grains, once for these grains and lights: 50%")
    assert Waiting().sentence(["transport", "exchange"], 0.0, 0.0) == (
        "Computing how light goes in and between grains: 0%")


def test_a_render_that_waits_for_transport_says_so_and_how_far_it_is(render, blend_files, monkeypatch):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    settings = bpy.context.scene.mesograin
    settings.samples, settings.exchange, bpy.context.scene.render.resolution_percentage = 1, "off", 10
    sphere = next(each for each in bpy.data.objects if each.type == "MESH")
    # One alone may be known before anybody asks for it; each is in a medium of which no run before left anything.
    for _ in range(16):
        grain = sphere.copy()
        grain.data = sphere.data.copy()
        grain.data.materials[0] = sphere.data.materials[0].copy()
        grain.data.materials[0].mesograin.model = "transport"
        grain.data.materials[0].mesograin.eta = 1.31 + 1e-4 * random.random()
        bpy.context.collection.objects.link(grain)
    said = []

    class Told(Waiting):
        def sentence(self, awaited, share, now):
            said.append((tuple(awaited), share))
            return super().sentence(awaited, share, now)

    monkeypatch.setattr(engine.grace, "POLL_SECONDS", 0.005)
    monkeypatch.setattr(engine.waiting, "Waiting", Told)
    render()
    shares = [share for _, share in said]
    assert said[0][0] == ("transport",) and len(set(shares)) > 3
    assert shares == sorted(shares), "what is done is not undone"


@pytest.mark.parametrize("crop", [False, True], ids=["in_place", "cropped"])
def test_render_border_is_that_part_of_the_picture(render, blend_files, crop):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    settings = bpy.context.scene.render
    settings.resolution_percentage, bpy.context.scene.mesograin.samples = 25, 2
    whole = render()
    settings.use_border, settings.use_crop_to_border = True, crop
    settings.border_min_x, settings.border_max_x = 0.5, 0.9
    settings.border_min_y, settings.border_max_y = 0.2, 0.7
    part = render()
    rows, columns = slice(30, 80), slice(50, 90)  # row 0 is the top
    expected = whole[rows, columns] if crop else np.zeros_like(whole)
    if not crop:
        expected[rows, columns] = whole[rows, columns]
    assert part.shape == expected.shape
    difference = abs(part - expected)
    # Where a sample falls right on the sphere's edge, rounding decides.
    assert difference.mean() < 1e-4 and (difference.max(axis=-1) > 1e-3).sum() < 10


@pytest.mark.parametrize("pivot", ["LEFT", "CENTER"])
@pytest.mark.parametrize("fit", ["HORIZONTAL", "VERTICAL", "AUTO"])
@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
def test_stereo_shows_each_eye_what_cycles_shows_it(native, blend_files, tmp_path, kind, fit, pivot):
    addon_utils.enable("cycles")
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    scene, sphere, camera = bpy.context.scene, bpy.data.objects["Sphere"], bpy.context.scene.camera
    render, settings = scene.render, scene.render.image_settings
    render.resolution_x, render.resolution_y = 60, 90
    scene.mesograin.samples = scene.cycles.samples = 16
    camera.data.type, camera.data.sensor_fit, camera.data.ortho_scale = kind, fit, 7.0
    sphere.scale, sphere.location.z = (0.3, 0.3, 0.3), 2.0
    render.use_multiview, render.views_format = True, "STEREO_3D"
    stereo = camera.data.stereo
    stereo.convergence_mode, stereo.pivot = "OFFAXIS", pivot
    stereo.convergence_distance, stereo.interocular_distance = 6.5, 0.6
    settings.file_format, settings.views_format, settings.color_mode = "OPEN_EXR", "INDIVIDUAL", "RGBA"
    render.filepath = str(tmp_path / "eye.exr")

    def columns():
        bpy.ops.render.render(write_still=True)
        covered = [native.read_exr(tmp_path / f"eye_{eye}.exr")[0][..., 3] for eye in "LR"]
        assert all(image.shape == (90, 60) and image.max() == 1.0 for image in covered)
        return [np.average(np.arange(60) + 0.5, weights=image.sum(axis=0)) for image in covered]

    ours = columns()
    render.engine = "CYCLES"
    assert ours == pytest.approx(columns(), abs=0.1)
    assert ours[0] - ours[1] > 1.0 or kind == "ORTHO"


def test_stereo_renders_only_the_views_in_use(native, blend_files, tmp_path):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    scene = bpy.context.scene
    scene.mesograin.samples, scene.render.resolution_percentage = 1, 10
    scene.render.use_multiview, scene.render.views_format = True, "MULTIVIEW"
    scene.render.views["left"].use = False
    settings = scene.render.image_settings
    settings.file_format, settings.views_format = "OPEN_EXR", "INDIVIDUAL"
    scene.render.filepath = str(tmp_path / "eye.exr")
    bpy.ops.render.render(write_still=True)
    [path] = tmp_path.glob("*.exr")
    assert native.read_exr(path)[0][..., :3].max() > 0.1


def test_animation_follows_material_and_light(native, blend_files, tmp_path):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    scene = bpy.context.scene
    grain, sun = bpy.data.materials["Translucent"].mesograin, bpy.data.lights["Front"]
    scene.mesograin.samples, scene.render.resolution_percentage = 1, 10
    scene.frame_start, scene.frame_end = 1, 3
    grain.model = "lambert"
    bpy.data.objects.remove(bpy.data.objects["Back"])
    for frame, reflectance, energy in ((1, 0.2, 2.0), (2, 0.4, 2.0), (3, 0.4, 6.0)):
        grain.reflectance, sun.energy = (reflectance,) * 3, energy
        grain.keyframe_insert("reflectance", frame=frame)
        sun.keyframe_insert("energy", frame=frame)
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = str(tmp_path / "frame_")
    bpy.ops.render.render(animation=True)
    totals = [native.read_exr(path)[0][..., 0].sum() for path in sorted(tmp_path.glob("frame_*.exr"))]
    assert totals[1] / totals[0] == pytest.approx(2.0, rel=1e-3)
    assert totals[2] / totals[1] == pytest.approx(3.0, rel=1e-3)


def test_animation_follows_the_frame(render, blend_files):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    scene, sphere = bpy.context.scene, bpy.data.objects["Sphere"]
    scene.mesograin.samples, scene.render.resolution_percentage = 1, 25
    for frame, x in ((1, -1.0), (2, 1.0)):
        sphere.location.x = x
        sphere.keyframe_insert("location", frame=frame)
    centres = []
    for frame in (1, 2):
        scene.frame_set(frame)
        centres.append(np.nonzero(render()[..., 3])[1].mean())
    assert centres[1] - centres[0] > 20


def test_every_view_layer_is_rendered(native, render, blend_files):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    scene = bpy.context.scene
    scene.mesograin.samples, scene.render.resolution_percentage = 1, 25
    collection = bpy.data.collections.new("Hidden")
    scene.collection.children.link(collection)
    sphere = bpy.data.objects["Sphere"]
    scene.collection.objects.unlink(sphere)
    collection.objects.link(sphere)
    other = scene.view_layers.new("Empty")
    other.layer_collection.children["Hidden"].exclude = True
    assert render(layer=scene.view_layers[0].name)[..., 3].max() == 1.0
    assert render(layer="Empty")[..., 3].max() == 0.0


def test_blend_files_are_the_scenes_they_claim_to_be(blend_files, native):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    scene = bpy.context.scene
    depsgraph = bpy.context.evaluated_depsgraph_get()
    values = export.read_scene(depsgraph, meshes.MeshCache())
    assert values.warnings == ()
    radii = [vertex.co.length for vertex in bpy.data.objects["Sphere"].data.vertices]
    assert radii == pytest.approx([2.4] * len(radii))
    lights = sorted(values.lights, key=lambda light: -light.irradiance[0])
    for light, towards, irradiance in zip(lights, ((1.0, 1.0, 1.0), (-1.0, -1.0, -1.6)), (20.0, 10.0)):
        assert light.direction_to_light == pytest.approx(towards / np.linalg.norm(towards), abs=1e-6)
        assert light.irradiance == pytest.approx((irradiance,) * 3)
        assert light.angle == 0.0
    expected = native.Camera.look_at((0.0, 0.0, 6.5), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0)
    camera = export.camera_from_scene(depsgraph, 400, 400)
    np.testing.assert_allclose(camera.world_to_camera, expected.world_to_camera, atol=1e-6)
    np.testing.assert_allclose(np.diag(camera.camera_to_clip)[:2], np.diag(expected.camera_to_clip)[:2], rtol=1e-5)
    assert (scene.render.resolution_x, scene.render.resolution_y) == (400, 400)

    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "grain.blend"))
    [grain] = [thing for thing in bpy.data.objects if thing.type == "MESH"]
    assert 2000 <= len(grain.data.polygons) <= 10000 and grain.data.uv_layers
    assert export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache()).warnings == ()
