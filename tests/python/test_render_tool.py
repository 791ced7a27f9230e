"""mesograin-render as a shell sees it: the picture, its header, exit codes, and nothing left behind when it fails."""

import json
import os
import pathlib
import pty
import resource
import signal
import subprocess
import tempfile

import mesograin_native as native
import numpy as np
import pytest

from conftest import BUILD, SOURCE

TOOL = BUILD / "native/tool/mesograin-render"
SPHERE = SOURCE / "tests/data/sphere.json"


def run(*arguments, **options):
    return subprocess.run([TOOL, *map(str, arguments)], capture_output=True, text=True, **options)


def test_the_picture_and_its_provenance(tmp_path):
    outcome = run(SPHERE, "--samples", 3, "--seed", 5, "--size", "40x30", "-o", tmp_path / "a.exr")
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout == ""
    assert "40 x 30 pixels, 3 samples by lambert" in outcome.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["a.exr"]

    pixels, channels, attributes = native.read_exr(tmp_path / "a.exr")
    assert channels == ["R", "G", "B", "A"] and pixels.shape == (30, 40, 4)
    assert attributes["mesograin:version"] == native.__version__
    assert attributes["mesograin:model"] == "lambert"
    assert attributes["mesograin:samples"] == "3" and attributes["mesograin:seed"] == "5"
    assert attributes["mesograin:device"] == native.device_info()["renderer"]
    assert json.loads(attributes["mesograin:scene"]) == json.loads(SPHERE.read_text())
    assert json.loads(attributes["mesograin:material"])["reflectance"] == [0.8, 0.6, 0.4]

    scene, camera, size = native.load_scene(attributes["mesograin:scene"], size=(40, 30))
    view = native.View(*size, seed=5)
    view.set_scene(scene)
    view.set_camera(camera)
    view.render(3)
    np.testing.assert_array_equal(view.read(), pixels)


def test_it_renders_until_an_error_or_for_a_time(tmp_path):
    outcome = run(SPHERE, "--error", 1, "--size", "64", "-o", tmp_path / "a.exr")
    assert outcome.returncode == 0 and "8 samples, noise 0." in outcome.stderr, outcome.stderr
    assert native.read_exr(tmp_path / "a.exr")[2]["mesograin:samples"] == "8"
    outcome = run(SPHERE, "--error", 0.05, "--size", "64", "-o", tmp_path / "b.exr")
    assert outcome.returncode == 0 and int(native.read_exr(tmp_path / "b.exr")[2]["mesograin:samples"]) > 8

    outcome = run(SPHERE, "--seconds", 3, "--size", "8", "-o", tmp_path / "c.exr")
    assert outcome.returncode == 0, outcome.stderr
    samples = int(native.read_exr(tmp_path / "c.exr")[2]["mesograin:samples"])
    assert samples >= 1 and f"{samples} samples by lambert" in outcome.stderr


@pytest.mark.parametrize("words", [("--error", 0), ("--seconds", -1), ("--error", 1, "--seconds", 1),
                                   ("--error", 1, "-n", 4)])
def test_budgets_that_do_not_serve(tmp_path, words):
    assert run(SPHERE, *words, "-o", tmp_path / "a.exr").returncode == 2


def test_quiet_says_nothing(tmp_path):
    outcome = run(SPHERE, "-q", "-n", 1, "--size", "8x8", "-o", tmp_path / "a.exr")
    assert (outcome.returncode, outcome.stdout, outcome.stderr) == (0, "", "")


def without(key):
    scene = json.loads(SPHERE.read_text())
    del scene[key]
    return scene


@pytest.mark.parametrize("scene, part", [
    ('{"material": NaN}', "it is not JSON"),
    (json.dumps(without("lights")), "lights is missing; the scene needs it"),
    (json.dumps(without("camera")), "camera is missing; the scene needs it"),
    (json.dumps({**without("geometry"), "geometry": {"shape": "mesh", "file": "empty.obj"}}),
     "geometry.file: Can't read"),
])
def test_scenes_that_do_not_serve(tmp_path, scene, part):
    (tmp_path / "scene.json").write_text(scene)
    (tmp_path / "empty.obj").write_text("")
    outcome = run(tmp_path / "scene.json", "-o", tmp_path / "a.exr")
    assert outcome.returncode == 1
    assert part in outcome.stderr and len(outcome.stderr.splitlines()) == 1
    assert not (tmp_path / "a.exr").exists()


def test_outputs_that_cannot_be_written(tmp_path):
    (tmp_path / "file").write_text("")
    for output, part in [
        (tmp_path / "none/a.exr", "its folder does not exist"),
        (tmp_path / "file/a.exr", "part of its folder is a file"),
        ("/proc/a.exr", "Can't write /proc/a.exr"),
        (tmp_path / "a.png", "must end in .exr"),
    ]:
        outcome = run(SPHERE, "-n", 1, "-o", output)
        assert outcome.returncode == 1
        assert part in outcome.stderr and len(outcome.stderr.splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_read_only_folder(tmp_path):
    tmp_path.chmod(0o500)
    outcome = run(SPHERE, "-n", 1, "-o", tmp_path / "a.exr")
    assert outcome.returncode == 1 and "its folder is read-only" in outcome.stderr


def test_a_full_disk_leaves_the_old_picture(tmp_path):
    (tmp_path / "a.exr").write_text("old")
    with tempfile.NamedTemporaryFile() as errors:
        # The limit must not cut the messages short, so they go to a file that is there already and stays small.
        code = subprocess.call([TOOL, SPHERE, "-q", "-n", "1", "-o", tmp_path / "a.exr"], stderr=errors,
                               preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)),
                               env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"})
        message = pathlib.Path(errors.name).read_text()
    assert code == 1
    assert "the disk is full" in message
    assert [path.name for path in tmp_path.iterdir()] == ["a.exr"]
    assert (tmp_path / "a.exr").read_text() == "old"


def test_no_device_is_one_sentence(tmp_path):
    outcome = run(SPHERE, "-o", tmp_path / "a.exr", env={**os.environ, "MESOGRAIN_GL_DEVICE": "99"})
    assert outcome.returncode == 1
    assert outcome.stderr.startswith("mesograin-render: ") and "99" in outcome.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("arguments", [[], ["--samples", "0"], ["--model", "model_9"], ["--nonsense"]])
def test_a_wrong_command_line(tmp_path, arguments):
    target = ["-o", tmp_path / "a.exr"] if arguments else []
    assert run(SPHERE, *target, *arguments).returncode == 2
    assert not list(tmp_path.iterdir())


def test_help_needs_nothing():
    outcome = run("--help")
    assert outcome.returncode == 0
    assert "Exit codes" in outcome.stdout and "--samples" in outcome.stdout


@pytest.mark.parametrize("interruption", [signal.SIGINT, signal.SIGTERM])
def test_an_interruption_ends_it_and_leaves_nothing(tmp_path, interruption):
    """The terminal shows progress with the time left; Ctrl-C after that finds the render under way."""
    terminal, stderr = pty.openpty()
    process = subprocess.Popen([TOOL, SPHERE, "-n", "1000000", "-o", tmp_path / "a.exr"], stderr=stderr)
    os.close(stderr)
    shown = b""
    while b" left" not in shown:
        shown += os.read(terminal, 1000)
    process.send_signal(interruption)
    assert process.wait(60) == 128 + interruption
    os.close(terminal)
    assert b" of 1000000 samples, " in shown
    assert not list(tmp_path.iterdir())
