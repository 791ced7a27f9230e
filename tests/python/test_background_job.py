"""A job's process is watched and cancelled, and its files appear whole or not at all, whatever the process does."""

import os
import sys
import threading
import time

import pytest
from addon_rooms import room

job = room("studies.background.job")
protocol = room("studies.background.protocol")

PRELUDE = f"""
import os, signal, subprocess, sys, time
from pathlib import Path
sys.path.insert(0, {str(room("studies.background.job").__file__).rsplit("/mesograin/", 1)[0]!r})
from mesograin.studies.background.protocol import encode
def send(event, **values): os.write(1, encode(event, **values))
staging = Path(sys.argv[1])
"""
WRITES = """
(staging / "case").mkdir()
(staging / "case" / "model.exr").write_text("new")
(staging / "results.json").write_text("new")
"""


@pytest.fixture
def start(tmp_path):
    jobs = []

    def do(script, out=tmp_path / "out"):
        folder = tmp_path / "temporary"
        folder.mkdir()
        started = job.Job(folder, out)
        jobs.append(started)
        started.start([sys.executable, "-c", PRELUDE + script, str(started.staging)])
        return started

    yield do
    for started in jobs:
        started.cancel()
        assert started.wait(10)


def until(condition, timeout=20.0):
    deadline = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def files(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def test_events_are_told_from_other_text():
    assert protocol.decode(protocol.encode("step", what="ours").splitlines()[1]) == {"event": "step", "what": "ours"}
    for line in (b"", b"Fra:1 Mem:8.90M", b"mesograin-event {", b"\xff"):
        assert protocol.decode(line) is None


def test_a_job_that_is_done_publishes_its_files_and_leaves_nothing_else(start, tmp_path):
    (tmp_path / "out" / "case").mkdir(parents=True)
    (tmp_path / "out" / "case" / "model.exr").write_text("old")
    (tmp_path / "out" / "mine.txt").write_text("mine")
    started = start(WRITES + """
print("no line break", end="", flush=True)
send("step", number=1, count=2, what="reference", fraction=0.5, seconds_left=3.0)
send("sentence", text="A lamp is left out.")
send("done")
""")
    assert started.wait(20) and (started.state, started.error) == (job.DONE, "")
    assert (started.step.what, started.step.fraction) == ("reference", 0.5)
    assert started.sentences == ["A lamp is left out."]
    assert files(tmp_path) == ["out/case/model.exr", "out/mine.txt", "out/results.json"]
    assert (tmp_path / "out" / "case" / "model.exr").read_text() == "new"
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_what_is_left_passes_and_is_not_told_for_ever(start, monkeypatch):
    monkeypatch.setattr(job, "OVERDUE_SECONDS", 0.5)
    started = start("""
send("step", number=1, count=1, what="ours", fraction=0.0, seconds_left=1.0)
sys.stdin.read()
""")
    assert started.seconds_left is None and started.unknown == "Blender is starting"
    until(lambda: started.look() or started.step)
    first = started.seconds_left
    assert 0.0 < first <= 1.0
    until(lambda: started.seconds_left < first - 0.2)
    until(lambda: started.seconds_left == 0.0)
    until(lambda: started.seconds_left is None)
    assert started.unknown == "Longer than guessed"
    started.cancel()
    assert started.wait(job.PATIENCE_SECONDS + 5.0)


@pytest.mark.parametrize("script, words", [
    ("send('failed', text='There is no camera.'); sys.exit(1)", "There is no camera."),
    ("print('out of memory', flush=True); os.kill(os.getpid(), signal.SIGSEGV)", "signal 11; it last said: out of mem"),
    ("sys.exit(3)", "exit code 3"),
    ("pass", "exit code 0"),
    ("send('done'); sys.exit(1)", "exit code 1"),
])
def test_a_job_that_fails_says_why_and_leaves_no_file(start, tmp_path, script, words):
    started = start(WRITES + script)
    assert started.wait(20) and started.state == job.FAILED
    assert words in started.error and "\n" not in started.error
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("stubborn", [False, True])
def test_cancel_is_at_once_and_takes_the_whole_group_along(start, tmp_path, stubborn):
    started = start(WRITES + ("signal.signal(signal.SIGTERM, signal.SIG_IGN)\n" if stubborn else "") + """
child = subprocess.Popen(["sleep", "1000"])
send("sentence", text=str(child.pid))
time.sleep(1000)
""")
    until(lambda: started.look() or started.sentences)
    asked = time.monotonic()
    started.cancel()
    assert started.state == job.CANCELLED and time.monotonic() - asked < 0.1
    assert started.wait(job.PATIENCE_SECONDS + 5.0)
    assert list(tmp_path.iterdir()) == [] and started.state == job.CANCELLED
    until(lambda: not is_running(int(started.sentences[0])))


def test_no_thread_of_python_watches(start):
    # One beside an operator that looks something up in an overridden context crashes Blender before Python 3.12.
    before = set(threading.enumerate())
    started = start("send('sentence', text='up'); time.sleep(1000)")
    until(lambda: started.look() or started.sentences)
    assert set(threading.enumerate()) == before
    started.cancel()
    assert set(threading.enumerate()) == before


def is_running(process):
    try:
        return "\nState:\tZ" not in open(f"/proc/{process}/status").read()
    except FileNotFoundError:
        return False


def test_standard_input_lasts_as_long_as_the_parent(start):
    started = start("send('sentence', text='up'); sys.stdin.read(); send('done')")
    until(lambda: started.look() or started.sentences)
    time.sleep(0.2)
    assert started.state == job.RUNNING


def test_a_job_leaves_the_cores_to_blender_first(start):
    started = start("time.sleep(0.5); send('sentence', text=str(os.nice(0))); send('failed', text='')")
    until(lambda: started.look() or started.sentences or not started.running)
    assert int(started.sentences[0]) == min(os.nice(0) + job.NICENESS, 19)


def test_a_program_that_is_not_there_is_one_sentence(tmp_path):
    (tmp_path / "temporary").mkdir()
    started = job.Job(tmp_path / "temporary", tmp_path / "out")
    started.start([str(tmp_path / "blender")])
    assert started.wait() and started.state == job.FAILED
    assert "cannot be run (No such file or directory)" in started.error and list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_written_is_said_before_anything_starts(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError):
        job.Job(tmp_path, tmp_path / "file" / "out")
