# What moves within the exposure is blurred as in Cycles: objects, arrays, the camera; what stands still is as ever.
import bpy
import numpy as np
import pytest
from mesograin.engine import motion, passes
from mesograin.scene import export, meshes
from test_depth_of_field import apart, cycles, scene_of_balls
from test_passes import layers  # noqa: F401, a fixture

FRAME = 3


def scene_in_motion(what):
    """Three chalk balls of which something moves; the exposure is half a frame about frame 3."""
    scene, field = scene_of_balls()
    field.use_dof = False
    balls = [thing for thing in scene.objects if thing.type == "MESH"]
    balls[1].scale = (1.0, 0.4, 0.7)
    if what == "array":
        turned = bpy.data.objects.new("Turned", None)
        scene.collection.objects.link(turned)
        for number in range(12):
            copy = balls[0].copy()
            copy.scale, copy.location = (0.4, 0.3, 0.4), (number % 4 - 1.5, number // 4 - 1.0, 0.0)
            copy.parent = turned
            scene.collection.objects.link(copy)
        for ball in balls:
            bpy.data.objects.remove(ball)
        move(turned, "rotation_euler", (0.0, 0.0, 0.0), (0.0, 0.0, 4.0))
    elif what == "camera":
        move(scene.camera, "location", (-3.0, 0.0, 8.0), (3.0, 1.0, 8.0))
    else:
        move(balls[1], "location", (-3.0, -1.0, 0.0), (3.0, 1.0, 0.0))
        move(balls[0], "rotation_euler", (0.0, 0.0, 0.0), (3.0, 0.0, 0.0))
    scene.frame_set(FRAME)
    scene.render.use_motion_blur = True
    return scene


def curves(action):
    """From Blender 5 on they lie in layers."""
    if hasattr(action, "fcurves"):
        return action.fcurves
    return [curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags
            for curve in bag.fcurves]


def move(thing, path, start, end):
    """Evenly from frame 1 to 5."""
    for frame, value in ((1, start), (5, end)):
        setattr(thing, path, value)
        thing.keyframe_insert(path, frame=frame)
    for curve in curves(thing.animation_data.action):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


@pytest.mark.parametrize("what, position, shutter", [("object", "CENTER", 0.8), ("object", "END", 0.5),
                                                     ("array", "START", 0.5), ("camera", "CENTER", 0.6)])
def test_the_blur_is_that_of_cycles(render, what, position, shutter):
    scene = scene_in_motion(what)
    scene.render.motion_blur_shutter = shutter
    scene.mesograin.samples = 128
    owner = scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles
    owner.motion_blur_position = position
    blurred = render()
    assert (scene.frame_current, scene.frame_subframe) == (FRAME, 0.0)
    scene.render.use_motion_blur = False
    sharp = render()
    scene.render.use_motion_blur = True
    cycles(scene)
    for thing in scene.objects:
        thing.cycles.motion_steps = 3
    reference = render()
    assert apart(sharp, reference) > 0.05
    assert apart(blurred, reference) < 0.015


def test_it_is_the_same_every_time_and_passes_are_the_frame_s(layers):  # noqa: F811
    scene = scene_in_motion("object")
    scene.mesograin.samples = 8
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_cryptomatte_object = True
    first, second = layers(), layers()
    for name, pixels in first.items():
        np.testing.assert_array_equal(pixels, second[name], err_msg=name)
    scene.render.use_motion_blur = False
    still = layers()
    np.testing.assert_array_equal(first["Depth"], still["Depth"])
    partly = [((found["CryptoObject00"][..., 1] > 0.0) & (found["CryptoObject00"][..., 1] < 1.0)).mean()
              for found in (first, still)]
    assert partly[0] > 1.3 * partly[1], "a matte is as blurred as its thing"


def test_a_still_scene_is_sharp_and_nothing_is_sent_for_what_moves(native, render):
    scene = scene_in_motion("object")
    scene.mesograin.samples = 4

    def sent():
        before = native.sent()
        render()
        return {name: count - before[name] for name, count in native.sent().items()}

    render()
    moving = sent()
    scene.render.use_motion_blur = False
    assert moving == sent()
    scene.render.use_motion_blur = True
    for thing in scene.objects:
        thing.animation_data_clear()
    moving = render()
    scene.render.use_motion_blur = False
    np.testing.assert_array_equal(moving, render())


def test_times_are_where_the_shutter_is_open():
    scene = bpy.context.scene
    scene.render.motion_blur_shutter = 0.5
    found = motion.moments(scene, 100)
    assert len(found) == motion.MOST_MOMENTS and sum(moment.samples for moment in found) == 100
    times = np.array([moment.time for moment in found])
    weights = np.array([moment.samples for moment in found]) / 100.0
    assert (weights * times).sum() == pytest.approx(0.0, abs=1e-9)
    assert (weights * times**2).sum() == pytest.approx(0.5**2 / 12.0, rel=1e-3)
    assert np.ptp(times[:4]) > 0.25, "the first few are spread"
    curve = scene.render.motion_blur_shutter_curve.curves[0]
    for point in curve.points:
        point.location, point.handle_type = (point.location[0],) * 2, "VECTOR"
    scene.render.motion_blur_shutter_curve.update()
    found = motion.moments(scene, 64)
    # Open in proportion to time: the mean is at two thirds.
    assert np.mean([moment.time for moment in found]) == pytest.approx(0.5 * (2.0 / 3.0 - 0.5), abs=2e-3)


def test_what_comes_or_goes_within_the_exposure_stays():
    scene_in_motion("object")
    values = export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache())
    elsewhere = tuple(value.__class__(**{**value.__dict__, "object_to_world": tuple(range(16))})
                      for value in values.instances)
    fewer = values.__class__(**{**values.__dict__, "instances": elsewhere[:-1]})
    found = motion.moved(values, fewer).instances
    assert [thing.object_to_world == tuple(range(16)) for thing in found] == [True, True, False]
    assert found[-1] == values.instances[-1]


def test_sample_counts_are_all_samples(layers):  # noqa: F811
    scene = scene_in_motion("camera")
    scene.mesograin.samples = 5
    cycles_layer = getattr(bpy.context.view_layer, "cycles", None)
    if cycles_layer is None:
        pytest.skip("Cycles, which keeps the setting, is not there")
    cycles_layer.pass_debug_sample_count = True
    assert set(np.unique(layers()[passes.SAMPLE_COUNT.name])) == {5.0}
