"""Sweeps end to end with a stand-in for Blender that can be told to fail: resuming, failures, merging, scripts."""
import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
COMMAND = ROOT / "addon/mesograin/sweep/command.py"

STAND_IN = """\
#!{python}
import json, os, sys, time
words = sys.argv[sys.argv.index("--") + 1:]
out = words[words.index("--out") + 1]
settings = dict(word.split("=") for at, word in enumerate(words) if words[at - 1] == "--set")
with open({runs!r}, "a") as runs:
    runs.write(settings["scale"] + "\\n")
time.sleep(float(os.environ.get("STAND_IN_SECONDS", "0")))
together = int(os.environ.get("STAND_IN_TOGETHER", "0"))
while len(open({runs!r}).readlines()) < together:
    time.sleep(0.02)
if os.environ.get("STAND_IN_FAILS") == settings["scale"]:
    print("compare: the reference could not be rendered.")
    sys.exit(1)
scale = float(settings["scale"])
result = {{"model": words[words.index("--models") + 1], "reference": "volume_index_matched",
          "metrics": {{"relative_l1": 1 / scale, "rse_mean": 0.1 / scale, "bias": 1.0, "max_error_at": [1, 2, 0]}},
          "noise_floor": {{"relative_l1": 0.01}}, "mask": {{"pixels": 9, "nan": 0, "inf": 0}},
          "frame_ms": time.time(), "reference_seconds": 1.5}}
with open(os.path.join(out, "results.json"), "w") as file:
    json.dump({{"cases": [result]}}, file)
"""

SWEEP = """\
title = "Test"
scenes = ["a.blend"]
models = ["model_1", "model_2"]
[grid]
scale = [1, 2, 4]
"""


@pytest.fixture
def sweep(tmp_path):
    (tmp_path / "a.blend").write_bytes(b"BLENDER")
    (tmp_path / "s.toml").write_text(SWEEP)
    stand_in = tmp_path / "blender"
    stand_in.write_text(STAND_IN.format(python=sys.executable, runs=str(tmp_path / "runs")))
    stand_in.chmod(0o755)
    return tmp_path


def words(folder, *more, out="out"):
    return [
        sys.executable,
        str(COMMAND),
        str(folder / "s.toml"),
        "--out",
        str(folder / out),
        "--blender",
        str(folder / "blender"),
        *more,
    ]


def run(folder, *more, out="out", **environment):
    return subprocess.run(
        words(folder, *more, out=out), capture_output=True, text=True, env={**os.environ, **environment}
    )


def runs(folder):
    path = folder / "runs"
    return len(path.read_text().splitlines()) if path.exists() else 0


def test_every_case_runs_once_and_the_table_holds_them_in_order(sweep):
    done = run(sweep)
    assert done.returncode == 0, done.stderr
    assert runs(sweep) == 6
    assert "[6/6, about 0 s left]" in done.stdout
    with (sweep / "out/results.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [(row["model"], float(row["scale"])) for row in rows] == [
        (model, scale) for model in ("model_1", "model_2") for scale in (1, 2, 4)
    ]
    assert float(rows[2]["relative_l1"]) == 0.25
    assert "frame_ms" not in rows[0]
    assert run(sweep).returncode == 0
    assert runs(sweep) == 6, "a finished sweep runs nothing again"


def test_plots_have_the_data_in_them(sweep):
    run(sweep)
    text = (sweep / "out/relative_l1-over-scale.svg").read_text()
    for word in ("scale (multiplies", "relative L1", "model_1", "model_2", "Test"):
        assert word in text
    assert (sweep / "out/bias-over-scale.png").read_bytes()[:4] == b"\x89PNG"


def test_a_failing_case_is_recorded_and_the_rest_go_on(sweep):
    done = run(sweep, STAND_IN_FAILS="2.0")
    assert done.returncode == 1
    assert "failed: compare: the reference could not be rendered." in done.stdout
    table = json.loads((sweep / "out/results.json").read_text())
    assert len(table["rows"]) == 4
    assert [failure["error"] for failure in table["failures"]] == [
        "compare: the reference could not be rendered."
    ] * 2
    again = run(sweep)
    assert again.returncode == 0
    assert runs(sweep) == 8, "only the failed ones are tried again"
    assert not json.loads((sweep / "out/results.json").read_text())["failures"]


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_a_killed_sweep_goes_on_and_ends_with_the_same_table(sweep, number):
    process = subprocess.Popen(
        words(sweep),
        env={**os.environ, "STAND_IN_SECONDS": "0.4"},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    while runs(sweep) < 3:
        time.sleep(0.02)
    os.killpg(process.pid, number)
    _, complaint = process.communicate(timeout=10)
    if number == signal.SIGINT:
        assert process.returncode == 130
        assert "goes on from there" in complaint
        assert "Traceback" not in complaint
    finished = len(
        [
            path
            for path in (sweep / "out/cases").iterdir()
            if (path / "results.json").exists() and not path.name.endswith(".partial")
        ]
    )
    assert 0 < finished < 6
    before = runs(sweep)
    assert run(sweep).returncode == 0
    assert runs(sweep) - before == 6 - finished, "what was finished is not computed again"
    assert run(sweep, out="unbroken").returncode == 0
    for name in ("results.json", "results.csv", "relative_l1-over-scale.svg"):
        assert (sweep / "out" / name).read_bytes() == (sweep / "unbroken" / name).read_bytes()


def test_jobs_run_side_by_side(sweep):
    # Each stand-in waits until six have begun: fewer at a time would wait for ever.
    done = subprocess.run(words(sweep, "--jobs", "6"), env={**os.environ, "STAND_IN_TOGETHER": "6"}, timeout=120)
    assert done.returncode == 0


@pytest.mark.parametrize("kind", ["slurm", "parallel"])
def test_emitted_scripts_name_every_case(sweep, kind):
    done = run(sweep, "--emit", kind, "--jobs", "2")
    assert done.returncode == 0, done.stderr
    path = Path(done.stdout.strip())
    text = path.read_text()
    assert subprocess.run(["sh", "-n", str(path)]).returncode == 0
    assert ("--array=0-5%2" if kind == "slurm" else "seq 0 5") in text
    assert runs(sweep) == 0


def test_single_cases_merge_to_the_same_table(sweep):
    for index in range(6):
        assert run(sweep, "--case", str(index)).returncode == 0
        if index == 2:
            incomplete = run(sweep, "--merge")
            assert incomplete.returncode == 1
            assert "3 of 6 cases have no result yet" in incomplete.stdout
    assert run(sweep, "--merge").returncode == 0
    assert run(sweep, out="whole").returncode == 0
    assert (sweep / "out/results.csv").read_bytes() == (sweep / "whole/results.csv").read_bytes()


@pytest.mark.parametrize(
    ("more", "part", "code"),
    [
        (["--case", "6"], "--case must lie between 0 and 5; got 6.", 2),
        (["--jobs", "0"], "--jobs must be at least 1", 2),
        (["--blender", "/nowhere/blender"], "there is none at '/nowhere/blender'", 2),
        (["--emit", "pbs"], "invalid choice: 'pbs'", 2),
        (["--out", "/proc/nowhere"], "'/proc/nowhere' cannot be written", 3),
    ],
)
def test_what_is_wrong_is_one_sentence(sweep, more, part, code):
    done = run(sweep, *more)
    assert done.returncode == code
    assert part in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


def test_ready_files_are_all_readable():
    files = sorted((ROOT / "blend_files/sweeps").glob("*.toml"))
    assert files
    for path in files:
        done = subprocess.run(
            [sys.executable, str(COMMAND), str(path), "--out", "unused", "--list"], capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        assert done.stdout.count("\n") >= 2
