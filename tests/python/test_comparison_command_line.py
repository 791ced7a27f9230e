"""The command line of `compare` and its time left, without Blender."""

import io

import pytest
from addon_rooms import room

arguments = room("studies.comparison.arguments")
definitions = room("studies.comparison.definitions")
progress = room("studies.comparison.progress")


def test_defaults():
    chosen = arguments.parse([])
    assert list(chosen.models) == ["lambert", "conductor", "model_1", "model_2", "model_3"]
    assert (chosen.references, chosen.size, chosen.settings, chosen.out.name) == (None, None, {}, "comparison")


def test_settings():
    chosen = arguments.parse(
        ["--set", "scale=100", "--set", "sigma_s=0.9,0.5,0.1", "--set", "sigma_a=2", "--set", "profile=dipole"]
    )
    assert chosen.settings == {
        "scale": 100.0,
        "sigma_s": (0.9, 0.5, 0.1),
        "sigma_a": (2.0, 2.0, 2.0),
        "profile": "dipole",
    }
    assert (
        arguments.parse(["--size", "64x48", "--cache-limit", "1.5G".replace("1.5", "3")]).cache_limit == 3 * 1024**3
    )


def test_a_sweep_knows_what_a_comparison_knows():
    plan = room("studies.sweep.plan")
    assert (plan.MODELS, plan.REFERENCES) == (arguments.MODELS, arguments.REFERENCES)


def test_masks():
    chosen = arguments.parse(["--mask", "silhouette:4", "crop:0,1,20,30", "mean_deviation", "otsu:3"])
    assert chosen.masks == [("silhouette", (4,)), ("crop", (0, 1, 20, 30)), ("mean_deviation", ()), ("otsu", (3,))]


@pytest.mark.parametrize(
    "words, needed",
    [
        (["--models", "model_9"], "model_9"),
        (["--size", "400"], "WIDTHxHEIGHT"),
        (["--size", "4x4"], "8 to 16384"),
        (["--samples", "0"], "from 1 to"),
        (["--reference-samples", "-3"], "from 1 to"),
        (["--seeds", "0"], "from 1 to"),
        (["--controls", "--seeds", "1"], "--controls needs --seeds 2 or more"),
        (["--part", "diffuse"], "invalid choice: 'diffuse'"),
        (["--references", "subsurface", "--part", "specular"], "those that have it are glossy, volume_dielectric"),
        (["--references", "diffuse", "--part", "subsurface"], "the reference diffuse has no subsurface part"),
        (["--references", "photon_scene", "--part", "subsurface"], "all light between the grains is traced as one"),
        (["--mask", "circle"], "a mask is one of"),
        (["--mask", "crop:1,2,3"], "four whole numbers"),
        (["--mask", "silhouette"], "one number"),
        (["--mask", "otsu:-1"], "not negative"),
        (["--until", "0"], "above 0 and up to 1"),
        (["--until", "little"], "above 0 and up to 1"),
        (["--set", "sigma=1"], "NAME=VALUE"),
        (["--set", "boundary=dielectric"], "the reference chooses it"),
        (["--set", "sigma_s=1,2"], "a number or three of them"),
        (["--set", "g=high"], "a number from -1 to 1"),
        (["--set", "g=nan"], "a number from -1 to 1, 'nan' came"),
        (["--set", "g=1.5"], "a number from -1 to 1"),
        (["--set", "profile=exact"], "one of half_space, better_dipole, dipole, photon_beam"),
        (["--set", "sigma_a=0,inf,1"], "three of them, from 0 to 1e+12, '0,inf,1' came"),
        (["--cache-limit", "much"], "number of bytes"),
        (["missing.blend"], "no scene 'missing.blend'"),
    ],
)
def test_bad_words_get_one_sentence(capsys, words, needed):
    with pytest.raises(SystemExit) as stopped:
        arguments.parse(words)
    said = capsys.readouterr().err
    assert stopped.value.code == 2
    assert needed in said and said.count("\n") == 1


def test_every_metric_has_a_definition():
    for name in ("relative_l1", "relative_l1_blocks_corrected", "rse_mean_corrected", "bias", "ae_p95"):
        assert definitions.definition(name)
    assert "8 x 8" in definitions.definition("rmse_blocks")
    assert definitions.definition("no_such_number") is None


def test_lines_that_are_printed_say_the_share_of_all_that_is_done(monkeypatch):
    now, stream = [0.0], io.StringIO()
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    line = progress.Progress(stream, interval=1e9)
    line.plan([("one", "volume", 10.0), ("two", "volume", 20.0), ("three", "volume", 10.0)])
    for seconds in (10.0, 20.0, 10.0):
        line.begin()
        now[0] += seconds
        line.end()
    assert stream.getvalue().splitlines() == ["[1/3] one, 0% of all, about 40 s left",
                                              "[2/3] two, 25% of all, about 30 s left",
                                              "[3/3] three, 75% of all, about 10 s left"]


def test_a_count_that_is_a_guess_is_told_as_one(monkeypatch):
    now, stream = [0.0], io.StringIO()
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    line = progress.Progress(stream, interval=1e9)
    line.plan([(f"picture {number}", "fine", 1.0) for number in (1, 2)], is_guess=True)
    for number in (1, 2, 3):
        if not line.steps_left:
            line.insert([(f"picture {number}", "fine", 1.0)])
        line.begin()
        now[0] += 1.0
        line.end()
    assert [text.split("]")[0] for text in stream.getvalue().splitlines()] == ["[1 of about 2", "[2", "[3"]


def test_time_left_learns_the_pace(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    line = progress.Progress(io.StringIO(), interval=1e9)
    line.plan([("one", "volume", 10.0), ("two", "volume", 20.0), ("three", "lambert", 5.0)])
    line.begin()
    now[0] = 15.0
    line.update(0.5)
    assert line.seconds_left() == pytest.approx(15.0 + 25.0, rel=0.35)
    now[0] = 30.0
    line.end()
    line.begin()
    assert line.seconds_left() == pytest.approx(3.0 * 20.0 + 3.0 * 5.0)
    line.end(learn=False)
    line.begin()
    assert line.seconds_left() == pytest.approx(15.0)
