# The Compare panel without a window: what it asks for, where results go, how the cache is chosen and emptied.
import pathlib

import bpy
import numpy as np
import pytest
from cycles_scenes import make_sphere

from mesograin.cycles import reference_cache
from mesograin.cycles.cache import DEFAULT_LIMIT
from mesograin.studies import scripting
from mesograin.ui.compare_panel import properties
from mesograin.ui.compare_panel.session import session
from mesograin.ui.side_task import pictures
from mesograin.ui.side_task.session import Session


@pytest.fixture
def settings():
    return bpy.context.scene.mesograin_compare


@pytest.fixture
def preferences():
    chosen = bpy.context.preferences.addons["mesograin"].preferences
    yield chosen
    chosen.property_unset("cache_folder")
    chosen.property_unset("cache_limit")


def test_settings_become_arguments_in_the_order_of_the_tables(settings):
    settings.models = {"model_2", "lambert"}
    settings.references = {"subsurface", "diffuse"}
    settings.quality, settings.size_percent = "final", 50
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 200, 10
    assert properties.arguments(bpy.context.scene) == {
        "models": ["lambert", "model_2"], "references": ["diffuse", "subsurface"], "size": [100, 8],
        "samples": 256, "reference_samples": 512}
    settings.references = set()
    assert properties.arguments(bpy.context.scene)["references"] is None


def test_results_go_beside_the_file_or_last_as_long_as_blender(settings, tmp_path):
    scene = bpy.context.scene
    assert session.folder(scene) == pathlib.Path(bpy.app.tempdir) / "comparison"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "grain.blend"))
    assert session.folder(scene) == tmp_path / "comparison"
    settings.out = str(tmp_path / "mine")
    assert session.folder(scene) == tmp_path / "mine"


def test_without_a_window_the_button_names_the_function():
    with pytest.raises(RuntimeError, match=r"mesograin\.compare\(\)"):
        bpy.ops.mesograin.compare()


@pytest.mark.parametrize("change, words", [
    (lambda settings: setattr(settings, "models", set()), "No model is chosen"),
    (lambda settings: setattr(settings, "out", "/dev/null/out"), "/dev/null"),
])
def test_what_cannot_start_is_one_sentence(settings, change, words):
    make_sphere([((0.0, 0.0, 1.0), 1.0)], segments=8, rings=4)
    change(settings)
    with pytest.raises(scripting.ComparisonError) as complaint:
        session.start(bpy.context)
    assert words in str(complaint.value) and "\n" not in str(complaint.value) and not session.running


def test_preferences_choose_the_cache(preferences, tmp_path, monkeypatch):
    monkeypatch.setenv("MESOGRAIN_CACHE", str(tmp_path / "environment"))
    chosen = reference_cache.cache()
    assert (chosen.folder, chosen.limit) == (tmp_path / "environment", DEFAULT_LIMIT)
    monkeypatch.setenv("MESOGRAIN_CACHE_LIMIT", "1000")
    assert reference_cache.cache().limit == 1000
    preferences.cache_folder, preferences.cache_limit = str(tmp_path / "mine"), 5
    chosen = reference_cache.cache()
    assert (chosen.folder, chosen.limit) == (tmp_path / "mine", 5 * 1024**2)


def test_the_button_empties_the_cache(preferences, tmp_path):
    preferences.cache_folder = str(tmp_path)
    (tmp_path / "a.exr").write_bytes(b"0" * 1000)
    (tmp_path / "mine.txt").write_text("mine")
    assert bpy.ops.mesograin.clear_references() == {"FINISHED"}
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


@pytest.fixture
def entry():
    return {"name": "lambert.diffuse", "files": {"model": "model.exr"}}


def write(native, folder, value, side):
    picture = np.full((side, side, 4), value, np.float32)
    picture[0, :, 0] = 0.0  # the top row
    native.write_exr(folder / "model.exr", picture)


def test_a_picture_is_brought_up_to_date_and_never_doubled(entry, native, tmp_path):
    write(native, tmp_path, 3.0, 4)
    image = pictures.show(entry, "model", tmp_path)
    assert image.name == "Mesograin lambert.diffuse model" and tuple(image.size) == (4, 4)
    assert image.is_float and image.colorspace_settings.name.startswith("Linear")
    rows = np.array(image.pixels[:]).reshape(4, 4, 4)
    assert (rows[0, :, 0] == 3.0).all() and (rows[3, :, 0] == 0.0).all() and (rows[..., 1] == 3.0).all()
    image.name = "Mine"
    write(native, tmp_path, -2.0, 8)
    assert pictures.show(entry, "model", tmp_path) == image and image.name == "Mine"
    assert tuple(image.size) == (8, 8) and image.pixels[0] == -2.0
    assert len(bpy.data.images) == 1
    bpy.data.images.remove(image)
    assert pictures.show(entry, "model", tmp_path).pixels[0] == -2.0
    (tmp_path / "model.exr").unlink()
    bpy.data.images.remove(bpy.data.images[0])
    with pytest.raises(RuntimeError):
        pictures.show(entry, "model", tmp_path)


def test_a_picture_beside_the_file_moves_with_it(entry, native, tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "grain.blend"))
    (tmp_path / "comparison").mkdir()
    write(native, tmp_path / "comparison", 1.0, 4)
    assert pictures.show(entry, "model", tmp_path / "comparison").filepath == "//comparison/model.exr"


def test_only_pictures_that_a_case_has_are_offered(entry):
    assert pictures.pictures_of(entry) == ["model"]


def test_an_end_that_blender_lets_nobody_write_down_is_told_later():
    class Ended:
        running = False

        def look(self):
            return True

    class Refused(Session):
        tries = 0

        def finish(self):
            self.tries += 1
            if self.tries == 1:
                raise AttributeError("bpy_prop Writing to ID classes in this context is not allowed: model.exr, ...")

    refused = Refused("mesograin_refused", set())
    refused.task = refused._under_way = Ended()
    assert refused.poll() is not None and refused.tries == 1
    assert refused.poll() is None and refused.tries == 2
