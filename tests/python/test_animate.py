"""Frames on one machine or many: what is said of them, what scripts do, what Flamenco is handed, without a Blender."""
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ANIMATION = ROOT / "addon/mesograin/studies/animation"

# Renders the frames that it is told, of six, into files of one letter; slowly or badly if the environment says so.
STAND_IN = """\
#!{python}
import json, os, pathlib, sys, time
words = sys.argv[sys.argv.index("--") + 1:]
number, parts = (map(int, words[words.index("--part") + 1].split("/"))) if "--part" in words else (0, 1)
tell = lambda **event: print("mesograin-animate: " + json.dumps(event), flush=True)
print("Blender 3.4.1")
if os.environ.get("STAND_IN_COMPLAINS"):
    tell(complaint="No camera.", exit=2)
    sys.exit(2)
if os.environ.get("STAND_IN_CRASHES"):
    print("Segmentation fault", flush=True)
    os.kill(os.getpid(), 11)
files = {{frame: pathlib.Path({folder!r}, f"{{frame}}.png") for frame in list(range(1, 7))[number::parts]}}
if "--list" in words:
    for frame, file in files.items():
        tell(frame=frame, file=str(file), there=file.exists())
    sys.exit(0)
tell(frames=len(files), there=sum(file.exists() for file in files.values()))
failed = False
for frame, file in files.items():
    if file.exists():
        continue
    partial = file.with_name(f".{{frame}}.partial")
    tell(begins=frame, partial=str(partial))
    partial.write_text("h")
    time.sleep(float(os.environ.get("STAND_IN_SECONDS", "0")))
    if os.environ.get("STAND_IN_FAILS") == str(frame):
        partial.unlink()
        failed = True
        tell(failed=frame, why="It was too dark.")
        continue
    partial.rename(file)
    tell(done=frame, file=str(file))
sys.exit(1 if failed else 0)
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "shots").mkdir()
    (tmp_path / "a scene.blend").write_text("")
    blender = tmp_path / "blender"
    blender.write_text(STAND_IN.format(python=sys.executable, folder=str(tmp_path / "shots")))
    blender.chmod(0o755)
    return tmp_path


def words(folder, *more):
    return [sys.executable, str(ANIMATION / "command.py"), str(folder / "a scene.blend"), "--blender",
            str(folder / "blender"), *more]


def run(folder, *more, **environment):
    return subprocess.run(words(folder, *more), env={**os.environ, **environment}, capture_output=True, text=True,
                          timeout=60)


def there(folder):
    return sorted(file.name for file in (folder / "shots").iterdir())


@pytest.mark.parametrize("jobs", [1, 3])
def test_what_is_missing_is_rendered_and_told(folder, jobs):
    (folder / "shots" / "3.png").write_text("here")
    done = run(folder, "--jobs", str(jobs))
    assert done.returncode == 0, done.stderr
    assert there(folder) == [f"{number}.png" for number in range(1, 7)]
    assert "frames are there already" in done.stdout
    assert "[5/5, about 0 s left] frame" in done.stdout
    assert (folder / "shots" / "3.png").read_text() == "here"
    again = run(folder)
    assert again.returncode == 0 and "6 of 6 frames are there already" in again.stdout


def test_failures_are_told_and_tried_again(folder):
    done = run(folder, STAND_IN_FAILS="2")
    assert done.returncode == 1 and "frame 2 failed: It was too dark." in done.stdout
    assert len(there(folder)) == 5
    assert run(folder).returncode == 0 and len(there(folder)) == 6


def test_what_went_wrong_is_one_sentence(folder):
    for environment, code, sentence in (({"STAND_IN_COMPLAINS": "1"}, 2, "animate: No camera."),
                                        ({"STAND_IN_CRASHES": "1"}, 1, "it last said: Segmentation fault")):
        done = run(folder, **environment)
        assert done.returncode == code and sentence in done.stderr and "Traceback" not in done.stderr
    assert "there is none at 'nowhere'" in run(folder, "--blender", "nowhere").stderr
    assert "frames such as" in run(folder, "--frames", "five").stderr
    assert "I/N with I from 0" in run(folder, "--part", "3/3").stderr


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM])
def test_an_end_leaves_whole_frames_only(folder, ending):
    process = subprocess.Popen(words(folder), env={**os.environ, "STAND_IN_SECONDS": "0.5"}, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    deadline = time.monotonic() + 30.0
    while not (folder / "shots" / ".2.partial").exists():
        assert time.monotonic() < deadline
        time.sleep(0.01)
    process.send_signal(ending)
    _, said = process.communicate(timeout=30)
    assert process.returncode == 130 and "Interrupted" in said and "Traceback" not in said
    assert there(folder) == ["1.png"]


def test_a_slurm_script_renders_its_part(folder):
    emitted = run(folder, "--emit", "slurm", "--tasks", "3", "--jobs", "2")
    assert emitted.returncode == 0 and "#SBATCH --array=0-2%2" in emitted.stdout
    script = folder / "frames.slurm"
    script.write_text(emitted.stdout)
    subprocess.run(["sh", script], env={**os.environ, "SLURM_ARRAY_TASK_ID": "1"}, check=True, timeout=60)
    assert there(folder) == ["2.png", "5.png"]


def test_gnu_parallel_renders_all(folder):
    emitted = run(folder, "--emit", "parallel", "--tasks", "2", "--jobs", "2")
    if not shutil.which("parallel"):
        pytest.skip("GNU parallel is not installed; the Debian package is parallel")
    script = folder / "frames.sh"
    script.write_text(emitted.stdout)
    subprocess.run(["sh", script], check=True, timeout=60, capture_output=True)
    assert len(there(folder)) == 6


FARM = """
const tasks = [];
globalThis.frameChunker = (frames, size) => {
    if (frames != "1-25" || size != 10) throw frames;
    return ["1-10", "11-20", "21-25"];
};
globalThis.author = {
    Task: (name, type) => ({ name, type, commands: [], addCommand(one) { this.commands.push(one); } }),
    Command: (name, parameters) => ({ name, parameters }),
};
require("vm").runInThisContext(require("fs").readFileSync(process.argv[2], "utf8") + `
;globalThis.jobType = JOB_TYPE; globalThis.compile = compileJob;`);
const settings = { frames: "1-25", chunk_size: 10, blendfile: "/shared/a.blend", render_output_path: "/shared/f_####" };
compile({ settings, addTask: task => tasks.push(task) });
console.log(JSON.stringify({ keys: jobType.settings.map(one => one.key), tasks }));
"""


def test_flamenco_gets_a_task_for_each_chunk(tmp_path):
    if not shutil.which("node"):
        pytest.skip("node is not installed; the Debian package is nodejs")
    (tmp_path / "farm.js").write_text(FARM)
    done = subprocess.run(["node", tmp_path / "farm.js", ANIMATION / "mesograin_animation.js"], capture_output=True,
                          text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    made = json.loads(done.stdout)
    assert {"frames", "chunk_size", "render_output_path", "blendfile"} == set(made["keys"])
    assert [task["name"] for task in made["tasks"]] == ["render-1-10", "render-11-20", "render-21-25"]
    for task in made["tasks"]:
        [command] = task["commands"]
        assert command["name"] == "blender-render" and command["parameters"]["blendfile"] == "/shared/a.blend"
    asked = made["tasks"][1]["commands"][0]["parameters"]["args"]
    assert asked[asked.index("--") + 1:] == ["--frames=11-20", "--out", "/shared/f_####"]
