# Every test starts from an empty file with the add-on enabled, and must leave the device without an OpenGL error.
import pathlib
import sys

import bpy
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "addon"))


def pytest_sessionstart(session):
    import addon_utils

    if addon_utils.enable("mesograin", default_set=True) is None:
        pytest.exit("the add-on cannot be enabled", returncode=1)


@pytest.fixture(autouse=True)
def empty_file():
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.context.scene.render.engine = "MESOGRAIN"


@pytest.fixture(autouse=True)
def no_gl_errors(native):
    native.take_gl_errors()
    yield
    assert native.take_gl_errors() == []


@pytest.fixture(scope="session")
def native():
    from mesograin import native_module

    return native_module.get()


@pytest.fixture
def blend_files():
    return ROOT / "blend_files"


@pytest.fixture
def render(native, tmp_path):
    """Renders the current scene with F12 and reads the picture back, (h, w, 4) float32 with row 0 at the top."""

    def do(layer=""):
        scene = bpy.context.scene
        settings = scene.render.image_settings
        settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"
        scene.render.filepath = str(tmp_path / "picture.exr")
        bpy.ops.render.render(write_still=True, layer=layer)
        return native.read_exr(str(tmp_path / "picture.exr"))[0]

    return do
