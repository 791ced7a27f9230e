# The Compare panel without a window: what it asks for, where results go, how the cache is chosen and emptied.
import pathlib

import bpy
import pytest
from cycles_scenes import make_sphere

from mesograin import reference_cache, scripting
from mesograin.compare_panel import properties, session
from mesograin.cycles.cache import DEFAULT_LIMIT


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
    assert words in str(complaint.value) and "\n" not in str(complaint.value) and not session.running()


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
