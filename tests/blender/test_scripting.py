# mesograin.compare as a script meets it: pictures and numbers, one sentence for what is wrong, the scene untouched.
import os
import pathlib
import re
import subprocess

import bpy
import mesograin
import numpy as np
import pytest
from cycles_scenes import make_sphere

SUNS = [((1.0, 1.0, 1.0), 20.0)]
PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "scripting.md"
TINY = {"size": (24, 16), "samples": 2, "reference_samples": 2, "frames": 1}


@pytest.fixture
def sphere():
    return make_sphere(SUNS, segments=32, rings=16, roughness=0.4)


@pytest.fixture
def compare(tmp_path):
    def do(**changes):
        return mesograin.compare(**{**TINY, "models": ("lambert",), "out": tmp_path / "out", "report": False,
                                    "cache": tmp_path / "cache", **changes})

    return do


def test_it_returns_pictures_and_numbers(sphere, compare, tmp_path):
    steps = []
    found = compare(models=("lambert", "conductor"), on_progress=steps.append)
    assert [case.name for case in found.cases] == ["lambert.diffuse", "conductor.glossy"] and not found.failed
    for case in found.cases:
        model, reference, error = (case.image(picture) for picture in ("model", "reference", "error"))
        assert model.shape == reference.shape == (16, 24, 4) and model.dtype == np.float32
        np.testing.assert_allclose(error, model[..., :3] - reference[..., :3], atol=1e-5)
        assert 0.0 <= case.relative_l1 < 0.5 and case.noise_floor >= 0.0 and case.frame_ms > 0.0
        assert case.reference_seconds > 0.0 and re.search(r"% off|no significant difference", case.verdict)
    assert found.folder == tmp_path / "out" and (found.folder / "results.json").is_file() and found.report is None
    assert steps[-1].number == steps[-1].count == 4 and "Conductor" in steps[-1].what
    assert found.results["command"].startswith("mesograin.compare(models=('lambert', 'conductor')")


def test_a_failing_case_has_its_sentence_and_no_pictures(sphere, compare):
    found = compare(models=("conductor", "lambert"), settings={"roughness": 0.0})
    [failed] = found.failed
    assert failed.name == "conductor.glossy" and "raise the roughness" in failed.error and failed.verdict == "failed"
    assert failed.relative_l1 is None and found.warnings == () and found.cases[1].image("model").any()
    with pytest.raises(mesograin.ComparisonError, match="raise the roughness"):
        failed.image("model")


def test_a_material_that_is_no_number_is_named(sphere, compare):
    sphere.mesograin.roughness = float("nan")
    [case] = compare(models="conductor", references="glossy").cases
    assert "roughness" in case.error and "nan" in case.error
    assert case.entry["material"][sphere.name]["roughness"] is None


def test_a_fraction_that_cannot_be_reached_ends_at_the_most_seeds(sphere, compare):
    [case] = compare(until=1e-300, most_seeds=3).cases
    assert case.error == "" and case.entry["reference_seeds"] == [1, 2, 3] and not case.entry["until"]["reached"]


def test_the_scene_stays_as_it_is(sphere, compare):
    def kept():
        names = ("scenes", "objects", "meshes", "materials", "worlds", "images")
        return {name: [block.name for block in getattr(bpy.data, name)
                       if getattr(block, "type", "") != "RENDER_RESULT"] for name in names}

    before = kept()
    compare(settings={"reflectance": 0.25})
    assert kept() == before
    assert tuple(sphere.mesograin.reflectance) == pytest.approx((0.5,) * 3)


def test_warnings_are_returned(sphere, compare):
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Smoke", bpy.data.volumes.new("Smoke")))
    assert any("'Smoke'" in sentence for sentence in compare().warnings)


@pytest.mark.parametrize("changes, words", [
    ({"models": ("model_9",)}, ("lambert", "'model_9' came")),
    ({"models": ()}, ("models", "none")),
    ({"references": "mirror"}, ("diffuse", "'mirror' came")),
    ({"references": ("glossy",)}, ("None of the references glossy answers lambert",)),
    ({"size": 64}, ("(width, height)", "64 came")),
    ({"size": (4, 4)}, ("8 to 16384",)),
    ({"samples": 0}, ("samples", "0 came")),
    ({"reference_samples": 2.5}, ("reference_samples", "2.5 came")),
    ({"until": 2.0}, ("until", "2.0 came")),
    ({"seeds": 0}, ("seeds", "0 came")),
    ({"masks": ("circle",)}, ("silhouette", "'circle' came")),
    ({"part": "gloss"}, ("part takes specular or subsurface", "'gloss' came")),
    ({"part": "specular"}, ("No reference has a specular part of lambert",)),
    ({"part": "subsurface", "references": ("diffuse",)}, ("diffuse has no subsurface part",)),
    ({"settings": {"boundary": "dielectric"}}, ("sigma_a", "'boundary' came")),
    ({"settings": {"sigma_s": (1.0, 2.0)}}, ("a number or three of them",)),
    ({"settings": {"g": "much"}}, ("g takes a number from -1 to 1", "'much' came")),
    ({"settings": {"g": float("nan")}}, ("g takes a number from -1 to 1", "nan came")),
    ({"out": "//comparison"}, ("not saved",)),
    ({"out": "/dev/null/out"}, ("cannot be written",)),
])
def test_what_is_wrong_is_said_in_one_sentence(sphere, compare, changes, words):
    with pytest.raises(mesograin.ComparisonError) as complaint:
        compare(**changes)
    assert all(word in str(complaint.value) for word in words), complaint.value
    assert "\n" not in str(complaint.value)


def test_a_scene_without_camera_is_one_sentence(sphere, compare):
    bpy.data.objects.remove(bpy.data.objects["Camera"])
    with pytest.raises(mesograin.ComparisonError, match="no active camera"):
        compare()


def test_the_example_of_the_documentation_runs(sphere, tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "grain.blend"), copy=True)
    example = re.search(r"```python\n# compare_grain\.py\n(.*?)```", PAGE.read_text(), re.DOTALL).group(1)
    # As it stands there but for its quality.
    script = re.sub(r"samples=\d+", "samples=2", re.sub(r"size=\(.*?\)", "size=(16, 16)", example))
    assert script.count("samples=2") == 2 and "size=(16, 16)" in script
    (tmp_path / "compare_grain.py").write_text(script)
    addons = tmp_path / "scripts" / "addons"
    addons.mkdir(parents=True)
    (addons / "mesograin").symlink_to(pathlib.Path(mesograin.__file__).parent)
    environment = {"BLENDER_USER_SCRIPTS": str(addons.parent), "MESOGRAIN_CACHE": str(tmp_path / "cache")}
    done = subprocess.run([bpy.app.binary_path, "-b", "--factory-startup", "--addons", "cycles,mesograin",
                           str(tmp_path / "grain.blend"), "--python-exit-code", "1",
                           "--python", str(tmp_path / "compare_grain.py")],
                          capture_output=True, text=True, env={**os.environ, **environment})
    assert done.returncode == 0, done.stdout + done.stderr
    assert "model_1.volume_index_matched" in done.stdout and (tmp_path / "comparison" / "report.html").is_file()
