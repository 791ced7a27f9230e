# The Bake panel without a window: the button's file, what it says, and that the scene stays as it is.
import json
import random
import time
import weakref

import bpy
import numpy as np
import pytest
from cycles_scenes import make_sphere

from mesograin.studies.background import job
from mesograin.studies.baking.surface import PROVENANCE
from mesograin.ui.bake_panel.session import prepare, session

SUN = [((0.0, 0.0, 1.0), 3.0)]


@pytest.fixture
def asked(tmp_path):
    make_sphere(SUN, model="lambert")
    settings = bpy.context.scene.mesograin_bake
    settings.width, settings.height, settings.samples = 32, 16, 2
    settings.out = str(tmp_path / "a.exr")
    return settings


def test_the_button_writes_the_texture_and_nothing_else(asked, tmp_path, native):
    asked.view_from, asked.margin, asked.half = "active_camera", 3, True
    before = {name: len(getattr(bpy.data, name)) for name in ("images", "objects", "meshes", "scenes", "materials")}
    assert bpy.ops.mesograin.bake() == {"FINISHED"}
    assert {name: len(getattr(bpy.data, name)) for name in before} == before
    pixels, _, attributes = native.read_exr(tmp_path / "a.exr")
    origin = json.loads(attributes[PROVENANCE])
    assert pixels.shape == (16, 32, 4) and pixels[..., 3].min() == 1.0
    assert (origin["object"], origin["view_from"], origin["margin"], origin["samples"]) == (
        "Sphere", "active_camera", 3, 2)
    assert session.task.finished and session.task.fraction == 1.0 and not session.running
    assert not bpy.ops.mesograin.cancel_bake.poll()


def test_a_cancelled_bake_writes_nothing(asked, tmp_path):
    asked.samples = 1 << 20
    bake = prepare(bpy.context)
    bake.start()
    bake.cancel()
    bake.wait()
    assert not bake.finished and bake.error == "" and not list(tmp_path.iterdir())


@pytest.mark.parametrize("cancelled", [False, True])
def test_a_bake_that_has_ended_holds_no_view(asked, cancelled):
    """Of 4096 x 4096 texels that would be most of a gigabyte, until the next bake."""
    asked.samples = 1 << 20 if cancelled else 2
    bake = prepare(bpy.context)
    views = [weakref.ref(view) for view in bake.surface._views]
    assert views and all(view() is not None for view in views)
    bake.start()
    if cancelled:
        bake.cancel()
    bake.wait()
    assert bake.finished != cancelled and [view() for view in views] == [None] * len(views)
    assert bake.before_first_step == "First sample"
    bake.cancel()


def test_a_bake_that_waits_for_transport_says_so(asked):
    grain = bpy.data.materials[0].mesograin
    grain.model = "transport"
    grain.eta = 1.31 + 1e-4 * random.random()  # of which no run before has left anything in the cache
    bake = prepare(bpy.context)
    assert bake.before_first_step.startswith("Light in grains: ")
    bake.start()
    bake.wait()
    assert bake.finished and bake.before_first_step == "First sample"


@pytest.fixture
def relightable(asked):
    asked.relightable, asked.components, asked.direction_samples = True, 3, 1
    asked.compare = True  # left from another bake; no light of the scene's is there to compare
    asked.width = asked.height = 16
    return asked


def test_a_relightable_bake_writes_all_its_files_and_says_its_error(relightable, tmp_path, native):
    before = {name: len(getattr(bpy.data, name)) for name in ("images", "objects", "node_groups", "materials")}
    assert bpy.ops.mesograin.bake() == {"FINISHED"}
    assert {name: len(getattr(bpy.data, name)) for name in before} == before
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "a.atlas.exr", "a.blend", "a.exr", "a.glsl", "a.json", "a.lobes.exr"]
    _, channels, attributes = native.read_exr(tmp_path / "a.exr")
    told = json.loads(attributes[PROVENANCE])
    assert len(channels) == 9 and (told["samples"], told["components"]) == (1, 3)
    task = session.task
    assert task.finished and task.error == "" and task.fraction == 1.0 and task.results is None
    assert f"relative L1 {told['relative_l1_mean']:.2%} on average over 64 directions" in task.summary
    assert "a.exr and 5 files beside it: Sphere, 3 components of 16 x 16 texels" in task.summary
    with bpy.data.libraries.load(str(tmp_path / "a.blend")) as (there, _):
        assert there.node_groups == ["Relit Sphere"]


def test_a_cancelled_relightable_bake_writes_nothing(relightable, tmp_path):
    relightable.width = relightable.height = 512
    bake = prepare(bpy.context)
    bake.start()
    until = time.monotonic() + 60.0
    while bake.fraction == 0.0:
        assert bake.running and time.monotonic() < until, bake.error
        time.sleep(0.01)
    bake.cancel()
    bake.wait()
    bake.finish()
    assert bake.cancelled and 0.0 < bake.fraction < 1.0 and not list(tmp_path.iterdir())


def test_a_node_group_that_cannot_be_written_is_one_sentence(relightable, tmp_path):
    (tmp_path / "a.blend" / "there").mkdir(parents=True)
    with pytest.raises(RuntimeError, match="a.blend"):
        bpy.ops.mesograin.bake()
    assert not session.task.finished and session.task.error


def test_the_active_object_is_baked(asked, tmp_path, native):
    bpy.ops.mesh.primitive_plane_add()
    assert prepare(bpy.context).surface.name == "Plane"
    bpy.context.view_layer.objects.active = bpy.data.objects["Sphere"]
    assert prepare(bpy.context).surface.name == "Sphere"


def test_a_file_beside_the_blend_file(asked, tmp_path):
    asked.out = "//b.exr"
    with pytest.raises(RuntimeError, match="not saved, so //b.exr has no folder"):
        bpy.ops.mesograin.bake()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "grain.blend"))
    assert bpy.ops.mesograin.bake() == {"FINISHED"}
    assert (tmp_path / "b.exr").is_file()


@pytest.fixture
def compared(asked, tmp_path, monkeypatch):
    monkeypatch.setenv("MESOGRAIN_CACHE", str(tmp_path / "cache"))
    asked.compare, asked.width, asked.height = True, 64, 32
    asked.samples, asked.reference_samples = 16, 4
    asked.out = str(tmp_path / "out" / "a.exr")
    (tmp_path / "out").mkdir()
    yield asked
    session.forget()


def test_cycles_is_baked_beside_it_with_pictures_and_numbers(compared, tmp_path, native):
    compared.margin, compared.half = 3, True  # of the texture that is asked for, not of those that are compared
    objects = len(bpy.data.objects)
    assert bpy.ops.mesograin.bake() == {"FINISHED"}
    names = ["a.cycles.exr", "a.cycles.png", "a.error.exr", "a.error.png", "a.exr", "a.json", "a.mesograin.exr",
             "a.mesograin.png"]
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == names
    texture, _, attributes = native.read_exr(tmp_path / "out" / "a.exr")
    assert json.loads(attributes[PROVENANCE])["margin"] == 3
    np.testing.assert_array_equal(texture, texture.astype(np.float16).astype(np.float32))
    results = json.loads((tmp_path / "out" / "a.json").read_text())
    assert session.results == results and session.task.finished and len(bpy.data.objects) == objects
    assert (results["object"], results["reference"], results["reference_samples"]) == ("Sphere", "diffuse", 4)
    assert results["size"] == [64, 32] and results["samples"] == 16 and results["significance"]["our_seeds"] == 4
    assert results["metrics"]["relative_l1"] < 0.05 and list((tmp_path / "cache").glob("*.exr"))
    shown = {image["mesograin_picture"]: image for image in bpy.data.images if "mesograin_picture" in image}
    assert set(shown) == {f"bake Sphere {picture}" for picture in ("model", "reference", "error", "error colours")}
    for picture, file in (("model", "a.mesograin.exr"), ("reference", "a.cycles.exr"), ("error", "a.error.exr")):
        image = shown[f"bake Sphere {picture}"]
        pixels = np.array(image.pixels[:], np.float32).reshape(32, 64, image.channels)[::-1]
        np.testing.assert_allclose(pixels[..., :3], native.read_exr(tmp_path / "out" / file)[0][..., :3], atol=1e-6)
    # A second one brings the same images up to date.
    compared.width = 32
    assert bpy.ops.mesograin.bake() == {"FINISHED"}
    assert len([image for image in bpy.data.images if "mesograin_picture" in image]) == 4
    assert tuple(shown["bake Sphere model"].size) == (32, 32)


def test_what_the_background_blender_refuses_is_one_sentence(compared, tmp_path):
    compared.reference = "glossy"
    with pytest.raises(RuntimeError, match="The reference glossy does not answer lambert: choose another."):
        bpy.ops.mesograin.bake()
    assert session.task.error.count(".") == 1 and session.results is None and not session.task.cancelled
    compared.reference = "subsurface"
    bpy.data.materials["Sand"].mesograin.model = "model_1"
    bpy.data.materials["Sand"].mesograin.g = -0.5
    with pytest.raises(RuntimeError, match="'Sand'.*allows g between 0"):
        bpy.ops.mesograin.bake()
    assert list((tmp_path / "out").iterdir()) == []


def test_a_cancelled_comparison_ends_at_once_and_writes_nothing(compared, tmp_path):
    bpy.data.materials["Sand"].mesograin.model = "model_1"
    compared.width, compared.height, compared.reference_samples = 256, 256, 4000
    bake = prepare(bpy.context)
    bake.start()
    until = time.monotonic() + 60.0
    while "Cycles bakes Sphere (Volume, index-matched)" not in bake.detail:
        bake.look()
        assert bake.running and time.monotonic() < until, bake.error
        time.sleep(0.02)
    assert bake.seconds_left > 0.0
    started = time.monotonic()
    bake.cancel()
    assert bake.cancelled and not bake.running
    bake.wait()
    assert time.monotonic() - started < job.PATIENCE_SECONDS + 2.0
    bake.finish()
    assert not bake.finished and bake.error == "" and list((tmp_path / "out").iterdir()) == []


def test_only_what_can_be_baked_is_offered(asked):
    offered = [item.identifier for item in type(asked).bl_rna.properties["reference"].enum_items]
    assert offered == ["usual", "diffuse", "glossy", "volume_index_matched", "subsurface", "subsurface_burley",
                       "volume_lambert"]


@pytest.mark.parametrize("change, sentence", [
    (lambda asked: setattr(asked, "out", "/nowhere/a.exr"), "choose another place"),
    (lambda asked: setattr(asked, "out", asked.out + ".png"), "must end in .exr"),
    (lambda asked: bpy.data.meshes[0].uv_layers.remove(bpy.data.meshes[0].uv_layers[0]), "no UVs to bake at"),
    (lambda asked: setattr(bpy.data.objects["Sphere"], "hide_render", True), "there are: none"),
])
def test_what_is_wrong_is_one_sentence(asked, change, sentence):
    change(asked)
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.mesograin.bake()
    assert sentence in session.error and session.task is None


def test_no_other_object_is_baked_than_the_button_names(asked):
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Pile", None))
    bpy.context.view_layer.objects.active = bpy.data.objects["Pile"]
    with pytest.raises(RuntimeError, match="'Pile' has no faces of its own .* there are: 'Sphere'"):
        bpy.ops.mesograin.bake()
    bpy.context.view_layer.objects.active = None
    assert bpy.ops.mesograin.bake() == {"FINISHED"} and session.task.surface.name == "Sphere"


def test_time_left_is_that_of_samples(asked, monkeypatch):
    """What must be known before the first one is not what the others take."""
    bake = prepare(bpy.context)
    now = [bake._started + 100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    assert bake.seconds_left is None
    bake._advance(0.1)
    assert bake.seconds_left is None
    now[0] += 4.0
    bake._advance(0.3)
    assert bake.seconds_left == pytest.approx(14.0)


def test_another_file_forgets_the_bake(asked):
    bpy.ops.mesograin.bake()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    assert session.task is None


def test_a_bake_that_is_refused_before_the_end_of_another_was_told_disturbs_nothing(asked, tmp_path):
    session.start(bpy.context)
    session.task.wait()
    asked.out = str(tmp_path / "nowhere" / "a.exr")
    with pytest.raises(session.refusals()):
        session.start(bpy.context)
    assert session.task is None and session.poll() is None


@pytest.mark.parametrize("fraction, percent", [(0.0026, 0.0), (0.336, 34.0), (1.0, 100.0)])
def test_the_bar_has_no_digits_behind_the_point(monkeypatch, fraction, percent):
    monkeypatch.setattr(type(session), "fraction", fraction)
    assert bpy.context.window_manager.mesograin_bake_progress == percent
