# Final renders that end within an error or after so long, and what they choose and say for it.
import time

import bpy
import numpy as np
import pytest
from mesograin.engine import rounds, status
from mesograin.scene import budgets, export, meshes
from mesograin.ui import look


@pytest.fixture(name="scene")
def small_scene(blend_files):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "grain.blend"))
    scene = bpy.context.scene
    scene.render.resolution_percentage = 20
    return scene


def until_error(scene, error):
    scene.mesograin.budget, scene.mesograin.budget_error = budgets.ERROR, error


def exchange(gathered=False, albedo=0.8, **stuff):
    return {"balls": True, "gathered": gathered, "stuff": [{
        "surface": "lambert", "thickness": (0.0, 0.0), "albedo": (albedo, albedo), "g": (0.0, 0.0), "eta": (1.0, 1.0),
        **stuff}]}


def test_samples_end_when_noise_is_small_enough(scene, render):
    until_error(scene, 0.2)
    picture = render()
    fine = status.get(status.RENDER)
    scene.mesograin.budget_error = 5.0
    render()
    coarse = status.get(status.RENDER)
    assert coarse.samples == 8 < fine.samples
    assert f"{fine.samples} samples leave noise of 0.2% a pixel, for an error of 0.2%" in fine.budget
    scene.mesograin.budget, scene.mesograin.samples = budgets.SAMPLES, fine.samples
    np.testing.assert_allclose(picture, render(), rtol=1e-4, atol=1e-5)
    assert status.get(status.RENDER).budget == ""


def test_a_render_takes_the_time_that_it_is_given(scene, render):
    scene.mesograin.budget, scene.mesograin.budget_seconds = budgets.TIME, 0.1
    render()  # programs are compiled
    assert status.get(status.RENDER).samples >= 1
    scene.mesograin.budget_seconds = 3.0
    begun = time.perf_counter()
    assert render().max() > 0.0
    assert time.perf_counter() - begun > 2.0
    latest = status.get(status.RENDER)
    assert latest.samples > 1 and latest.budget == f"{latest.samples} samples in 3 s"


def test_motion_blur_has_whole_exposures_in_each_round(scene, render):
    scene.render.use_motion_blur = True
    thing = next(thing for thing in scene.objects if thing.type == "MESH")
    for frame, place in ((0, -0.5), (2, 0.5)):
        thing.location.x = place
        thing.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    until_error(scene, 8.0)
    blurred = render()
    assert status.get(status.RENDER).samples >= 8
    scene.mesograin.budget, scene.mesograin.samples = budgets.SAMPLES, 64
    truth = render()
    assert np.abs(blurred - truth)[..., :3].sum() < 0.15 * truth[..., :3].sum()


def test_models_of_auto_are_as_near_as_is_asked_for(scene):
    meshes_there = [thing for thing in scene.objects if thing.type == "MESH"]
    material = meshes_there[0].active_material
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=1.0)
    ball = bpy.context.object
    ball.data.materials.append(material)
    for thing in meshes_there:
        bpy.data.objects.remove(thing)
    material.mesograin.model, material.mesograin.scale = "auto", 1.0
    material.mesograin.sigma_s, material.mesograin.sigma_a = (27.0,) * 3, (0.1,) * 3

    def chosen():
        values = export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache())
        models = [dict(drawn.material.values)["model"] for drawn in values.with_models_chosen().instances]
        return models, values.error_of_models()

    loose, error = chosen()
    assert loose == ["model_1"] and 8.0 < error <= 10.0
    until_error(scene, 5.0)
    near, error = chosen()
    assert near == ["model_2"] and error <= 5.0
    advised = look.advise(material, ball, scene.mesograin.millimetres_per_unit, budgets.tolerance(scene.mesograin))
    assert advised.model == "model_2" and advised.error == pytest.approx(error)
    until_error(scene, 1.0)
    nearest, error = chosen()
    assert nearest == ["model_2"] and error <= 5.0, "none is so near; of them it is the nearest"


def test_light_between_grains_is_gathered_where_that_is_near_enough_and_the_other_is_not():
    def better(error, **told):
        until = rounds.UntilError(error, None)
        return until.better_exchange(exchange(**told)), until.sentence(8)

    assert better(0.04)[0] == "gathered"
    assert "gathered, which was measured to be within 3.3% in blocks, and within 4.5% otherwise" in better(0.04)[1]
    assert better(0.05) == (None, "8 samples, for an error of 5%; light between grains was measured to be within 4.5% "
                                  "in blocks")
    assert better(0.01, gathered=True)[0] is None, "it cannot be closer"
    assert better(0.01, albedo=0.1)[0] is None and "was not measured" in better(0.01, albedo=0.1)[1]
    assert rounds.UntilError(0.01, None).better_exchange(None) is None


def test_a_heap_is_drawn_by_what_is_near_enough(render):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.5)
    ball = bpy.context.object
    ball.data.materials.append(bpy.data.materials.new("white"))
    ball.active_material.mesograin.model, ball.active_material.mesograin.reflectance = "lambert", (0.8,) * 3
    collection = bpy.data.collections.new("ball")
    bpy.context.scene.collection.objects.unlink(ball)
    collection.objects.link(ball)
    for number in range(27):
        empty = bpy.data.objects.new("instance", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location = (number % 3, number // 3 % 3, number // 9)
        bpy.context.scene.collection.objects.link(empty)
    bpy.ops.object.light_add(type="SUN", rotation=(0.6, 0.3, 0.0))
    bpy.ops.object.camera_add(location=(1.0, -9.0, 1.0), rotation=(1.5708, 0.0, 0.0))
    scene = bpy.context.scene
    scene.camera = bpy.context.object
    scene.render.resolution_x = scene.render.resolution_y = 64
    until_error(scene, 4.0)
    picture = render()
    assert "is gathered" in status.get(status.RENDER).budget
    scene.mesograin.budget, scene.mesograin.exchange = budgets.SAMPLES, "gathered"
    scene.mesograin.samples = status.get(status.RENDER).samples
    np.testing.assert_allclose(picture, render(), rtol=1e-3, atol=1e-4)
