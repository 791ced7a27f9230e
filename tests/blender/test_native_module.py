# A native module that is missing, foreign or of another version is one sentence, and everything else goes on.
import pathlib
import shutil
import sys

import bpy
import pytest
from mesograin import native_module


@pytest.fixture
def another_folder(monkeypatch, tmp_path, native):
    """The add-on looks for its native module in an empty folder."""
    monkeypatch.setenv("MESOGRAIN_NATIVE_DIR", str(tmp_path))
    monkeypatch.delitem(sys.modules, native_module.NAME)
    return tmp_path


def assert_one_sentence(sentence, *words):
    assert all(word in sentence for word in words), sentence
    assert sentence.endswith(".") and "\n" not in sentence
    assert "mesograin install" in sentence


def test_missing(another_folder):
    assert_one_sentence(native_module.problem(), "none in", str(another_folder))
    with pytest.raises(native_module.Unavailable):
        native_module.get()


def test_built_for_another_python(another_folder):
    foreign = f"{native_module.NAME}.cpython-36m-x86_64-linux-gnu.so"
    (another_folder / foreign).write_bytes(b"")
    assert_one_sentence(native_module.problem(), foreign, f"Python {sys.version_info.major}.{sys.version_info.minor}")


def test_broken(another_folder):
    suffix = native_module.importlib.machinery.EXTENSION_SUFFIXES[0]
    (another_folder / f"{native_module.NAME}{suffix}").write_bytes(b"not a library")
    assert_one_sentence(native_module.problem(), "cannot be loaded")
    assert native_module.NAME not in sys.modules


def test_another_version(monkeypatch, native):
    monkeypatch.setattr(native_module, "__version__", "9.9.9")
    assert_one_sentence(native_module.problem(), "9.9.9", native.__version__)


def test_found_in_the_folder_named(another_folder, monkeypatch, native):
    here = pathlib.Path(native.__file__)
    shutil.copy(here, another_folder)
    spec = native_module.importlib.machinery.PathFinder.find_spec(native_module.NAME, [str(native_module.folder())])
    assert spec.origin == str(another_folder / here.name)


def test_final_render_says_the_sentence_and_blender_lives(another_folder, blend_files):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    with pytest.raises(RuntimeError) as complaint:
        bpy.ops.render.render()
    assert native_module.problem() in str(complaint.value)
    material = bpy.data.materials["Translucent"]
    material.mesograin.g = 0.25
    assert material.mesograin.g == 0.25
