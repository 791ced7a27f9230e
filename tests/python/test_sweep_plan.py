"""A sweep's file: what it unfolds to, and one sentence with the line for everything that can be wrong in it."""
import importlib.util
import sys
from pathlib import Path

import pytest

PLAN = Path(__file__).parents[2] / "addon/mesograin/sweep/plan.py"
spec = importlib.util.spec_from_file_location("mesograin_sweep_plan", PLAN)
plan = importlib.util.module_from_spec(spec)
sys.modules[spec.name] = plan
spec.loader.exec_module(plan)

GOOD = """\
title = "Optical scale"
scenes = ["a.blend"]
models = ["model_1", "model_3"]
references = ["volume_index_matched"]
size = [64, 48]
samples = 16

[material]
eta = 1.3

[grid]
scale = [1, 2.5]

[[list]]
sigma_s = 0.9
sigma_a = [0.1, 0.2, 0.3]

[[list]]
sigma_s = 0.1
"""


@pytest.fixture
def write(tmp_path):
    (tmp_path / "a.blend").write_bytes(b"BLENDER")

    def write_file(text):
        path = tmp_path / "sweep.toml"
        path.write_text(text)
        return path

    return write_file


def test_grid_and_list_unfold_to_every_combination(write):
    result = plan.read(write(GOOD))
    assert result.title == "Optical scale"
    assert result.axes == ("scale", "sigma_s", "sigma_a")
    assert len(result.cases) == 2 * 2 * 2
    first = result.cases[0].as_json()
    assert first["model"] == "model_1"
    assert first["parameters"] == {"eta": 1.3, "scale": 1.0, "sigma_a": [0.1, 0.2, 0.3], "sigma_s": [0.9, 0.9, 0.9]}
    assert first["settings"] == {"samples": 16, "size": [64, 48]}
    assert first["label"] == "a model_1 scale=1 sigma_s=0.9 sigma_a=0.1/0.2/0.3"
    assert Path(first["scene"]).is_absolute()


def test_keys_tell_cases_apart_and_follow_the_scenes_content(write, tmp_path):
    path = write(GOOD)
    keys = [case.key for case in plan.read(path).cases]
    assert len(set(keys)) == len(keys)
    assert keys == [case.key for case in plan.read(path).cases]
    (tmp_path / "a.blend").write_bytes(b"BLENDER, changed")
    assert not set(keys) & {case.key for case in plan.read(path).cases}


@pytest.mark.parametrize(
    ("old", "new", "line", "part"),
    [
        ('"model_1", ', '"model_9", ', 3, "allowed are lambert, conductor, model_1, model_2, model_3"),
        ("volume_index_matched", "eevee", 4, "allowed are diffuse, glossy, volume_index_matched, subsurface"),
        ("a.blend", "b.blend", 2, "there is no scene 'b.blend'"),
        ("samples = 16", "samples = 0", 6, "a whole number from 1 to"),
        ("samples = 16", "sampels = 16", 6, "'sampels' is not known here"),
        ("[64, 48]", "[64, 4]", 5, "from 8 to 16384; got 4"),
        ("eta = 1.3", "eta = 5", 9, "eta must be a number from 0.5 to 4; got 5"),
        ("eta = 1.3", "ior = 1.3", 9, "'ior' is not a material's parameter; allowed are reflectance, sigma_a"),
        ("[1, 2.5]", "3", 12, "scale must be a list"),
        ("[1, 2.5]", "[1, nan]", 12, "got nan"),
        ("sigma_s = 0.1", "sigma_s = -0.1", 19, "got -0.1"),
        ("sigma_s = 0.1", "sigma_s = [1, 2]", 19, "three of them"),
        ("eta = 1.3", "eta = true", 9, "got True"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(write, old, new, line, part):
    assert old in GOOD
    path = write(GOOD.replace(old, new))
    with pytest.raises(plan.PlanError) as error:
        plan.read(path)
    sentence = str(error.value)
    assert f"line {line} " in sentence
    assert part in sentence
    assert "\n" not in sentence
    assert sentence.endswith(".")


def test_broken_toml_names_the_line(write):
    with pytest.raises(plan.PlanError, match="is no TOML: .*line 4"):
        plan.read(write(GOOD.replace('["model_1", "model_3"]', '["model_1"')))


def test_a_missing_file_is_one_sentence(tmp_path):
    with pytest.raises(plan.PlanError, match="cannot be read"):
        plan.read(tmp_path / "none.toml")
