"""Sweeps end to end with a stand-in for Blender that can be told to fail: resuming, failures, merging, scripts."""
import csv
import html
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from sweep_stand_in import COMMAND, ROOT, fill, run, runs, words


@pytest.fixture
def sweep(tmp_path):
    fill(tmp_path)
    return tmp_path


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
    run(sweep, "--report")
    run(sweep, "--report", out="again")
    plot = "plots/relative_l1-over-scale.svg"
    assert (sweep / "out" / plot).read_bytes() == (sweep / "again" / plot).read_bytes()
    text = (sweep / "out" / plot).read_text()
    for word in ("scale (multiplies", "relative L1", "Model 1", "Model 2", "Test", "%"):
        assert word in text
    marks = re.findall(r">([\d.]+)</text>", text)
    assert marks == ["1", "2", "4"], "the axis is marked where the sweep has values"
    assert (sweep / "out/plots/bias-over-scale.png").read_bytes()[:4] == b"\x89PNG"


def test_the_page_holds_every_case_definition_and_link(sweep):
    done = run(sweep, "--report", STAND_IN_FAILS="2.0")
    assert f"The page: {sweep}/out/report.html" in done.stdout and done.stderr == ""
    page = (sweep / "out/report.html").read_text()
    text = " ".join(html.unescape(re.sub(r"<[^>]*>", " ", page)).split())
    assert "Relative L1 from 25.0 % (a Model 1 scale=4) to 100 % (a Model 1 scale=1)." in text
    assert "a Model 2 scale=2 failed: compare: the reference could not be rendered." in text
    assert f"./mesograin sweep {sweep}/s.toml --out {sweep}/out" in text and "llvmpipe" in text
    assert "This was not finished" in text and "4 of 6 cases" in text
    body = page[page.index("<tbody>"):page.index("</tbody>")]
    assert body.count("<tr>") == 4 and body.count("data:image/png;base64,") == 8
    assert page.count("<svg") == 3, "a plot of each metric, in the page"
    for name in re.findall(r'popovertarget="([^"]+)"', page):
        assert f'popover id="{name}"' in page
    for target in re.findall(r'(?:src|href)="([^"#][^"]*)"', page):
        inside = target.startswith("data:image/png;base64,") or target.endswith(".exr")
        assert inside or (sweep / "out" / target).exists()


def test_controls_are_in_the_tables_and_on_the_page(sweep):
    (sweep / "s.toml").write_text("controls = true\n" + (sweep / "s.toml").read_text())
    assert run(sweep, "--report").returncode == 0
    rows = json.loads((sweep / "out/results.json").read_text())["rows"]
    assert [row["controls"]["wrong"]["change"]["scale"] for row in rows] == [2, 4, 8, 2, 4, 8]
    with (sweep / "out/results.csv").open() as file:
        verdicts = [(row["controls.identical"], row["controls.wrong"]) for row in csv.DictReader(file)]
    same, differs = "no significant difference", "differs"
    assert verdicts[:3] == [(differs, differs), (same, differs), (same, same)]
    page = (sweep / "out/report.html").read_text()
    text = " ".join(html.unescape(re.sub(r"<[^>]*>", " ", page)).split())
    assert "of 6 identical materials 2 are called different, of 6 wrong ones 4." in text
    assert "a Model 1 scale=1 : The same material with other seeds is called different in 10.0 % of the pixels" in text
    assert "a Model 1 scale=4 : A wrong one, scale 8, is not called different." in text
    assert page.count("✓ identical") == 4 and page.count("✗ wrong") == 2
    assert 'popover id="define-controls"' in page and "where the truth is known" in text


def test_controls_that_were_not_asked_for_take_no_room(sweep):
    run(sweep, "--report")
    header = (sweep / "out/results.csv").read_text().splitlines()[0]
    assert "controls" not in header and "controls" not in (sweep / "out/report.html").read_text().split("<style>")[0]
    assert "define-controls" not in (sweep / "out/report.html").read_text()


def test_without_a_report_the_tables_are_written_alone(sweep):
    assert run(sweep).returncode == 0
    assert not (sweep / "out/report.html").exists() and not (sweep / "out/plots").exists()


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
        env={**os.environ, "STAND_IN_SECONDS": "0.6"},
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
    time.sleep(0.7)
    assert not list((sweep / "out/cases").glob("*.partial/results.json")), "a killed sweep leaves no Blender behind"
    assert run(sweep).returncode == 0
    assert runs(sweep) - before == 6 - finished, "what was finished is not computed again"
    assert run(sweep, out="unbroken").returncode == 0
    for name in ("results.json", "results.csv"):
        assert (sweep / "out" / name).read_bytes() == (sweep / "unbroken" / name).read_bytes()


def test_two_sweeps_into_one_folder_share_the_work(sweep):
    environment = {**os.environ, "STAND_IN_SECONDS": "0.3"}
    both = [subprocess.Popen(words(sweep), env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            for _ in range(2)]
    for process in both:
        _, complaint = process.communicate(timeout=60)
        assert (process.returncode, complaint) == (0, "")
    assert runs(sweep) == 6, "no case runs twice"
    assert run(sweep, out="unbroken").returncode == 0
    assert (sweep / "out/results.csv").read_bytes() == (sweep / "unbroken/results.csv").read_bytes()


def test_a_sweep_that_waits_for_another_can_be_ended(sweep):
    first = subprocess.Popen(words(sweep), env={**os.environ, "STAND_IN_SECONDS": "20"}, start_new_session=True)
    while not runs(sweep):
        time.sleep(0.02)
    second = subprocess.Popen(words(sweep), stderr=subprocess.PIPE, text=True)
    time.sleep(1.0)
    second.send_signal(signal.SIGINT)
    _, complaint = second.communicate(timeout=10)
    os.killpg(first.pid, signal.SIGKILL)
    first.wait()
    assert second.returncode == 130 and runs(sweep) == 1 and "Traceback" not in complaint


def test_results_that_cannot_be_read_are_made_again(sweep):
    assert run(sweep).returncode == 0
    table = (sweep / "out/results.csv").read_bytes()
    damaged = sorted(path for path in (sweep / "out/cases").glob("*/results.json"))[:3]
    for path, text in zip(damaged, ("", "[]", '{"cases": [')):
        path.write_text(text)
    done = run(sweep)
    assert (done.returncode, done.stderr, runs(sweep)) == (0, "", 9)
    assert (sweep / "out/results.csv").read_bytes() == table


def test_a_blender_that_is_killed_is_told(sweep):
    (sweep / "blender").write_text("#!/bin/sh\necho Sample 3/64\nkill -9 $$\n")
    done = run(sweep)
    assert done.returncode == 1
    assert "failed: Blender was ended by signal 9, as the system does when memory runs out; it last said" in done.stdout


def test_a_scene_that_changes_under_way_is_told_and_its_case_run_again(sweep):
    script = (sweep / "blender").read_text()
    (sweep / "blender").write_text(script + f"open({str(sweep / 'a.blend')!r}, 'a').write('x')\n")
    done = run(sweep, "--case", "0")
    assert (done.returncode, done.stderr) == (1, "")
    assert "a.blend was saved or moved meanwhile: run the sweep again" in done.stdout
    (sweep / "blender").write_text(script)
    assert run(sweep).returncode == 0 and runs(sweep) == 7


def test_a_full_disk_is_told_and_costs_no_finished_case(sweep):
    import resource

    assert run(sweep, "--case", "0").returncode == 0
    done = subprocess.run(words(sweep), capture_output=True, text=True,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64)))
    assert done.returncode == 3 and "cannot be written" in done.stderr, done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not list((sweep / "out").rglob(".*.json.*")), "no half file stays"
    assert run(sweep).returncode == 0
    assert runs(sweep) == 6


def test_jobs_run_side_by_side(sweep):
    # Each stand-in waits until three have begun: fewer at a time would wait for ever.
    done = subprocess.run(words(sweep, "--jobs", "3"), env={**os.environ, "STAND_IN_TOGETHER": "3"}, timeout=60)
    assert done.returncode == 0


@pytest.mark.parametrize("kind", ["slurm", "parallel"])
def test_emitted_scripts_name_every_case(sweep, kind):
    done = run(sweep, "--emit", kind, "--jobs", "2")
    assert done.returncode == 0, done.stderr
    path = Path(done.stdout.strip())
    text = path.read_text()
    assert subprocess.run(["sh", "-n", str(path)]).returncode == 0
    assert ("--array=0-2%2" if kind == "slurm" else "seq 0 2") in text
    assert f"--blender {sweep / 'blender'}" in text
    assert runs(sweep) == 0


@pytest.mark.parametrize("kind", ["slurm", "parallel"])
def test_a_script_needs_a_blender_too(sweep, kind):
    done = run(sweep, "--emit", kind, "--blender", "/nowhere/blender")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1) and "there is none at '/nowhere/blender'" in done.stderr


def test_cases_that_share_a_reference_run_one_after_the_other(sweep):
    run(sweep, "--jobs", "3", STAND_IN_SECONDS="0.2")
    order = (sweep / "runs").read_text().split()
    assert sorted(order[:3]) == ["1.0", "2.0", "4.0"], "no two of a group at once"


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
        (["--group", "3"], "--group must lie between 0 and 2; got 3.", 2),
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
