"""A sweep's file: what it unfolds to, and one sentence with the line for everything that can be wrong in it."""
from pathlib import Path

import pytest
from addon_rooms import room

plan = room("studies.sweep.plan")

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
        ("a.blend", "a.txt", 2, "'a.txt' is no .blend file"),
        ('"volume_index_matched"', '"glossy"', 4, "no reference answers model_1; those that do are volume_index"),
        ('"model_1", "model_3"', '"model_1", "model_1"', 3, "'model_1' stands twice in models"),
        ("[1, 2.5]", "[1, 2.5, 1.0]", 12, "1 stands twice in scale"),
        ("[material]\neta = 1.3", "[other]\neta = 1.3", 8, "'other' is not known here"),
        ('models = ["model_1", "model_3"]', "models = []", 3, "models must be a list with some of lambert"),
        ('scenes = ["a.blend"]', 'scenes = "a.blend"', 2, "scenes must be a list with one or more .blend files"),
        ("samples = 16", 'samples = 16\npart = "gloss"', 7, "part must be one of specular, subsurface; got 'gloss'"),
        ("samples = 16", 'samples = 16\npart = "specular"', 4, "volume_index_matched has no specular part: all"),
        ("samples = 16", "samples = 16\ncontrols = 1", 7, "controls must be true or false; got 1"),
        ("samples = 16", 'samples = 16\ncontrols = "yes"', 7, "controls must be true or false; got 'yes'"),
        ("samples = 16", "samples = 16\nseeds = 1\ncontrols = true", 8, "controls need 2 or more seeds"),
        ("samples = 16", "samples = 16\nmaterial.g = 2", 7, "g must be a number from -1 to 1; got 2"),
        ("samples = 16", "samples = 16\nmaterial = { g = 2 }", 7, "g must be a number from -1 to 1; got 2"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(write, old, new, line, part):
    assert old in GOOD
    text = GOOD.replace(old, new)
    if "material." in new or "material =" in new:
        text = text.replace("[material]\neta = 1.3\n", "")
    path = write(text)
    with pytest.raises(plan.PlanError) as error:
        plan.read(path)
    sentence = str(error.value)
    assert f"line {line} " in sentence
    assert part in sentence
    assert "\n" not in sentence
    assert sentence.endswith(".")


@pytest.mark.parametrize(
    ("old", "new", "part"),
    [
        ("eta = 1.3", f"eta = [{'1.3, ' * 1000}]", "line 9 .*got \\[1.3, 1.3, .*\\.\\.\\."),
        (
            "[1, 2.5]",
            f"{list(range(1, 1001))}\neta = {[1 + at / 100 for at in range(99)]}",
            "line 11 .*there are 396000 cases; at most 100000 are allowed",
        ),
        (GOOD, "a = " + "[" * 5000, "too deep"),
        (GOOD, "samples = " + "9" * 5000, "no TOML"),
    ],
    ids=["a long list", "a large grid", "deep lists", "a long number"],
)
def test_what_is_too_much_is_a_short_sentence(write, old, new, part):
    with pytest.raises(plan.PlanError, match=part) as error:
        plan.read(write(GOOD.replace(old, new)))
    assert len(str(error.value)) < 400


def test_cases_that_share_a_reference_are_a_group(write):
    found = plan.read(write(GOOD))
    assert found.groups == ((0, 4), (1, 5), (2, 6), (3, 7)), "the two models of each material and scale"
    for group in found.groups:
        assert len({repr(found.cases[index].parameters) for index in group}) == 1
    own = plan.read(write(GOOD.replace('references = ["volume_index_matched"]\n', "").replace("model_3", "lambert")))
    assert [case.reference for case in own.cases[::4]] == ["volume_index_matched", "diffuse"]
    assert len(own.groups) == 8


def test_models_meet_the_references_that_answer_them(write):
    text = GOOD.replace('["model_1", "model_3"]', '["lambert", "model_1"]')
    text = text.replace('"volume_index_matched"', '"diffuse", "subsurface", "volume_index_matched"')
    cases = plan.read(write(text)).cases
    pairs = list(dict.fromkeys((case.model, case.reference) for case in cases))
    assert pairs == [("lambert", "diffuse"), ("model_1", "subsurface"), ("model_1", "volume_index_matched")]
    assert len({case.label for case in cases}) == len(cases)


def test_a_part_is_compared_with_the_references_that_have_it(write):
    text = GOOD.replace('references = ["volume_index_matched"]\n', 'part = "specular"\n')
    found = plan.read(write(text.replace('"model_1", "model_3"', '"conductor", "model_3"')))
    assert [case.reference for case in found.cases[::4]] == ["glossy", "volume_dielectric"]
    assert all(("part", "specular") in case.settings for case in found.cases)
    with pytest.raises(plan.PlanError, match="line 3 .*no reference has a specular part of lambert"):
        plan.read(write(text.replace('"model_1"', '"lambert"')))


def test_controls_are_asked_for_or_not(write):
    run = room("studies.sweep.run")
    plain, asked, declined = (
        plan.read(write(GOOD.replace("samples = 16", f"samples = 16\n{line}"))).cases
        for line in ("", "controls = true", "controls = false")
    )
    assert all("--controls" in run.arguments(case, "out") for case in asked)
    assert not any("--controls" in run.arguments(case, "out") for case in (*plain, *declined))
    assert [case.key for case in declined] == [case.key for case in plain]
    assert not {case.key for case in asked} & {case.key for case in plain}, "they hold more"


def test_broken_toml_names_the_line(write):
    with pytest.raises(plan.PlanError, match="is no TOML: .*line 4"):
        plan.read(write(GOOD.replace('["model_1", "model_3"]', '["model_1"')))


def test_a_mark_at_the_beginning_is_no_error(write):
    assert plan.read(write("\ufeff" + GOOD)).title == "Optical scale"


def test_a_missing_file_is_one_sentence(tmp_path):
    with pytest.raises(plan.PlanError, match="cannot be read"):
        plan.read(tmp_path / "none.toml")
