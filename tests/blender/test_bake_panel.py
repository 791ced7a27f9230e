# The Bake panel without a window: the button's file, what it says, and that the scene stays as it is.
import json

import bpy
import pytest
from cycles_scenes import make_sphere

from mesograin.bake_panel.session import prepare, session
from mesograin.baking.surface import PROVENANCE

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


@pytest.mark.parametrize("change, sentence", [
    (lambda asked: setattr(asked, "out", "/nowhere/a.exr"), "choose another place"),
    (lambda asked: setattr(asked, "out", asked.out + ".png"), "must end in .exr"),
    (lambda asked: bpy.data.meshes[0].uv_layers.remove(bpy.data.meshes[0].uv_layers[0]), "no UVs to bake at"),
    (lambda asked: setattr(bpy.data.objects["Sphere"], "hide_viewport", True), "there are: none"),
])
def test_what_is_wrong_is_one_sentence(asked, change, sentence):
    change(asked)
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.mesograin.bake()
    assert sentence in session.error and session.task is None


def test_another_file_forgets_the_bake(asked):
    bpy.ops.mesograin.bake()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    assert session.task is None
