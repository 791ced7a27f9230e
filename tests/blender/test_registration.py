# The add-on comes and goes without a trace, and names one version everywhere.
import pathlib
import re
import subprocess
import sys

import bpy
import mesograin
import pytest
from mesograin import compat
from mesograin.engine import engine

PACKAGE = pathlib.Path(mesograin.__file__).parent


def registered():
    handlers = {name for event in ("undo_post", "redo_post", "load_pre", "save_pre")
                for name in (handler.__name__ for handler in getattr(bpy.app.handlers, event))}
    return {
        "classes": {name for name in dir(bpy.types) if "mesograin" in name.lower()},
        "properties": {(kind, name) for kind in ("Material", "Scene", "WindowManager")
                       for name in dir(getattr(bpy.types, kind)) if name.startswith("mesograin")},
        "engines": {panel.__name__ for panel in compat.borrowed_panels()
                    if engine.MesograinRenderEngine.bl_idname in panel.COMPAT_ENGINES},
        "handlers": {name for name in handlers
                     if name in ("_forget_meshes", "_stop_sessions", "_forget", "read_before_saving")},
    }


def test_unregister_undoes_register_and_both_can_be_repeated():
    before = registered()
    assert all(before.values())
    for _ in range(2):
        mesograin.unregister()
        assert not any(registered().values())
        mesograin.register()
        assert registered() == before


def test_reload_scripts_keeps_everything_working(render, blend_files):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    bpy.context.scene.mesograin.samples = 2
    before = render()
    bpy.ops.script.reload()
    from mesograin.scene import node_colours

    assert {"TEX_NOISE", "TEX_SKY"} <= set(node_colours.NODES), "nodes that rooms of their own follow"
    # Blender computes normals in threads, whose last digit may tip a sample at an edge.
    assert (abs(render() - before) > 1e-4).mean() < 1e-4


WITHOUT_NUMPY = """
import importlib.abc, sys

class Missing(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] == "numpy":
            raise ModuleNotFoundError("No module named 'numpy'", name="numpy")

for name in [name for name in sys.modules if name.partition(".")[0] == "numpy"]:
    del sys.modules[name]
sys.meta_path.insert(0, Missing())
sys.path.insert(0, sys.argv[-1])
import addon_utils, bpy, mesograin
mesograin.register()
print("preferences:", bpy.types.AddonPreferences.bl_rna_get_subclass_py("MesograinPreferencesWithoutNumpy"))
mesograin.unregister()
"""


def test_without_numpy_a_sentence_says_so(tmp_path):
    script = tmp_path / "without_numpy.py"
    script.write_text(WITHOUT_NUMPY)
    done = subprocess.run([bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1",
                           "--python", str(script), "--", str(PACKAGE.parent)],
                          capture_output=True, text=True, timeout=120)
    output = done.stdout + done.stderr
    assert done.returncode == 0, output
    assert "Mesograin needs NumPy" in output and "python3-numpy" in output
    assert "Traceback" not in output
    assert re.search("preferences: <class .*WithoutNumpy", output)


def test_one_version_everywhere(native):
    manifest = (PACKAGE / "blender_manifest.toml").read_text()
    assert re.search(r'^version = "(.*)"', manifest, re.M).group(1) == mesograin.__version__
    assert native.__version__ == mesograin.__version__
    project = (PACKAGE.parents[1] / "CMakeLists.txt").read_text()
    assert re.search(r"project\(mesograin VERSION ([\d.]+)", project).group(1) == mesograin.__version__


def test_properties_are_the_schema_s():
    from mesograin.scene import properties
    from mesograin.schema.parameters import PARAMETERS

    declared = bpy.types.Material.bl_rna.properties["mesograin"].fixed_type.properties
    for name, parameter in PARAMETERS.items():
        assert declared[name].name == parameter.label and declared[name].description == parameter.describe("mm")
        if parameter.kind in ("number", "rgb"):
            limits = declared[name].hard_min, declared[name].hard_max
            assert limits == pytest.approx((parameter.least, parameter.most))
        if parameter.kind == "choice":
            items = [(item.identifier, item.value) for item in declared[name].enum_items]
            numbers = [properties.AUTO_NUMBER if (name, choice.name) == ("model", "auto") else number
                       for number, choice in enumerate(parameter.choices)]
            assert items == list(zip([choice.name for choice in parameter.choices], numbers))


def test_whatever_an_artist_sets_has_a_tooltip_and_can_be_animated():
    groups = [(owner, name) for owner in (bpy.data.materials.new("Grain"), bpy.context.scene, bpy.context.view_layer)
              for name in dir(owner) if name.startswith("mesograin")]
    assert len(groups) > 6
    for owner, name in groups:
        one = owner.bl_rna.properties[name]
        for each in one.fixed_type.properties if one.type == "POINTER" else [one]:
            if each.identifier in ("rna_type", "name") or each.is_hidden:
                continue
            assert each.description, f"{name}.{each.identifier}"
            words = each.type in ("STRING", "POINTER") or (each.type == "ENUM" and each.is_enum_flag)
            assert words or each.is_animatable, f"{name}.{each.identifier}"
    operators = [getattr(bpy.ops.mesograin, name).get_rna_type() for name in dir(bpy.ops.mesograin)]
    assert [each.identifier for each in operators if not each.description] == []


def test_defaults_are_the_native_module_s(native):
    standard, grain = native.Material(), bpy.data.materials.new("Grain").mesograin
    for parameter in ("model", "g", "eta", "roughness", "scale", "specular", "boundary", "masking", "profile"):
        assert getattr(grain, parameter) == pytest.approx(getattr(standard, parameter))
    for parameter in ("reflectance", "sigma_a", "sigma_s", "reflectance_to_others"):
        assert tuple(getattr(grain, parameter)) == pytest.approx(getattr(standard, parameter))


def test_package_imports_outside_blender():
    run = subprocess.run([sys.executable, "-c", "import mesograin; print(mesograin.__version__)"],
                         cwd=PACKAGE.parent, capture_output=True, text=True)
    assert run.stdout.strip() == mesograin.__version__, run.stderr


def test_self_test_passes():
    assert bpy.ops.mesograin.self_test() == {"FINISHED"}
