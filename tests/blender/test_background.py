# A comparison beside the open file: in a Blender of its own, on what is in memory, without a trace in this one.
import hashlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import zipfile

import bpy
import numpy as np
import pytest
from cycles_scenes import make_sphere

from mesograin import native_module
from mesograin.studies.background import job
from mesograin.studies.background.launch import launch

ROOT = pathlib.Path(__file__).resolve().parents[2]
SUNS = [((1.0, 1.0, 1.0), 20.0)]
TINY = {"models": ["lambert"], "size": [24, 24], "samples": 2, "reference_samples": 2, "frames": 1, "report": False}


@pytest.fixture
def start(tmp_path):
    jobs = []

    def do(**changes):
        arguments = {**TINY, "cache": str(tmp_path / "cache"), **changes}
        jobs.append(launch("compare", tmp_path / "out", **arguments))
        return jobs[-1]

    yield do
    for started in jobs:
        started.cancel()
        assert started.wait(20) and not started.folder.exists() and not started.staging.exists()


@pytest.fixture
def sphere():
    return make_sphere(SUNS, segments=32, rings=16, roughness=0.4, reflectance=(0.5, 0.5, 0.5))


def done(started):
    assert started.wait(120), "no end"
    return started.state, started.error


def model_picture(folder):
    return native_module.get().read_exr(folder / "out" / "lambert.diffuse" / "model.exr")[0]


def until(condition, timeout=60.0):
    deadline = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def test_an_unsaved_file_is_compared_and_stays_untouched(sphere, start, tmp_path):
    bpy.ops.ed.undo_push(message="sphere")
    bpy.data.objects["Sphere"].location.x = 0.5  # since the last undo step, and never saved
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Smoke", bpy.data.volumes.new("Smoke")))
    shown = bpy.context.scene
    bpy.data.scenes.new("A scene that is not shown")
    before = (bpy.data.filepath, bpy.data.is_dirty, bpy.data.is_saved, shown)
    started = start()
    assert (bpy.data.filepath, bpy.data.is_dirty, bpy.data.is_saved, bpy.context.scene) == before
    assert done(started) == (job.DONE, "")
    results = json.loads((tmp_path / "out" / "results.json").read_text())
    assert results["complete"] and results["scene"] == "unsaved.blend" and results["cases"][0]["status"] == "done"
    assert started.step.number == started.step.count == 2
    assert any("'Smoke'" in sentence for sentence in started.sentences)
    coverage = model_picture(tmp_path)[..., 3]
    middle = (coverage * np.arange(24)).sum() / coverage.sum()
    assert abs(middle - 11.5) > 1.0, f"the sphere is not where it was moved to, but at column {middle:.2f}"


def test_a_saved_file_keeps_its_path_its_bytes_and_its_relative_paths(sphere, start, tmp_path):
    path = tmp_path / "project" / "grain.blend"
    (path.parent / "textures").mkdir(parents=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    image = bpy.data.images.load(str(height_file(path.parent / "textures" / "height.exr", 1.0)))
    image.filepath = "//textures/height.exr"
    add_displacement(image, -0.6)
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    digest = hashlib.sha256(path.read_bytes()).digest()
    assert done(start()) == (job.DONE, "")
    assert bpy.data.filepath == str(path) and image.filepath == "//textures/height.exr"
    assert hashlib.sha256(path.read_bytes()).digest() == digest
    assert json.loads((tmp_path / "out" / "results.json").read_text())["scene"] == "grain.blend"
    assert coverage_radius(tmp_path) == pytest.approx(radius_in_pixels(1.8), abs=0.3)


def test_pictures_that_are_only_in_memory_come_along(sphere, start, tmp_path):
    """The sphere shrinks by what each picture says; a blank one would leave it as it is."""
    painted = bpy.data.images.new("Painted", 8, 8, float_buffer=True)
    packed = bpy.data.images.new("Packed", 8, 8, float_buffer=True)
    over_a_file = bpy.data.images.load(str(height_file(tmp_path / "height.exr", 0.0)))
    bytes_only = bpy.data.images.new("Bytes", 8, 8)
    images = (painted, packed, over_a_file, bytes_only)
    for image in images:
        image.pixels.foreach_set(np.full(8 * 8 * 4, 1.0, np.float32))
        image.update()
        add_displacement(image, -0.15)
    packed.pack()
    dirty = [image.is_dirty for image in images]
    assert done(start()) == (job.DONE, "")
    assert [image.is_dirty for image in images] == dirty and dirty == [True, False, True, True]
    assert all(image.pixels[0] == 1.0 for image in images)
    assert coverage_radius(tmp_path) == pytest.approx(radius_in_pixels(1.8), abs=0.3)


def height_file(path, height):
    native_module.get().write_exr(path, np.full((8, 8, 4), height, np.float32))
    return path


def add_displacement(image, strength):
    """Makes the sphere's radius larger by `strength` where the image is 1."""
    texture = bpy.data.textures.new("Height", "IMAGE")
    texture.image = image
    modifier = bpy.data.objects["Sphere"].modifiers.new("Height", "DISPLACE")
    modifier.texture, modifier.strength, modifier.mid_level = texture, strength, 0.0


def radius_in_pixels(radius):
    """Of a sphere's outline."""
    return 12.0 / np.tan(np.radians(22.5)) * radius / np.sqrt(6.5**2 - radius**2)


def coverage_radius(folder):
    """Of the disc that the sphere covers, in pixels."""
    return np.sqrt(model_picture(folder)[..., 3].sum() / np.pi)


def test_a_failing_case_is_recorded_and_a_failing_job_says_why(sphere, start, tmp_path):
    assert done(start(models=["conductor", "lambert"], settings={"roughness": 0.0})) == (job.DONE, "")
    cases = json.loads((tmp_path / "out" / "results.json").read_text())["cases"]
    assert [case["status"] for case in cases] == ["failed", "done"] and "raise the roughness" in cases[0]["error"]
    bpy.data.objects.remove(bpy.data.objects["Camera"])
    state, error = done(start())
    assert state == job.FAILED and "no active camera" in error and "Traceback" not in error


def test_cancel_ends_cycles_at_once(sphere, start, tmp_path):
    started = start(models=["model_1"], size=[256, 256], reference_samples=4000)
    until(lambda: started.look() or started.step is not None)
    time.sleep(1.0)  # into Cycles' own work
    asked = time.monotonic()
    started.cancel()
    assert started.state == job.CANCELLED and started.wait(10) and time.monotonic() - asked < 4.0
    assert sorted(path.name for path in tmp_path.iterdir()) in ([], ["cache"])
    assert not list(tmp_path.rglob("*.exr")) and not is_running(started._process.pid)


def test_an_add_on_from_the_zip_compares_and_a_blender_that_dies_takes_its_comparison_along(sphere, tmp_path):
    """Unpacked inside other packages, as Blender 4.2 does with an extension; killed, as by a crash, while the
    background Blender renders."""
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "grain.blend"), copy=True)
    subprocess.run([sys.executable, str(ROOT / ".launcher/package.py"), str(ROOT), str(tmp_path / "mesograin.zip")],
                   check=True, capture_output=True)
    repository = tmp_path / "repository" / "user_default"
    zipfile.ZipFile(tmp_path / "mesograin.zip").extractall(repository)
    script = tmp_path / "start.py"
    script.write_text(f"""
import sys, time
sys.path.insert(0, {str(tmp_path)!r})
import bpy, repository.user_default.mesograin as mesograin
mesograin.register()
bpy.ops.wm.open_mainfile(filepath={str(tmp_path / "grain.blend")!r})
from repository.user_default.mesograin.studies.background.launch import launch
started = launch("compare", {str(tmp_path / "out")!r}, models=["model_1"], size=[256, 256], reference_samples=4000,
                 cache={str(tmp_path / "cache")!r})
while started.step is None:
    started.look()
    time.sleep(0.05)
time.sleep(1.0)
print("up", started._process.pid, started.folder, flush=True)
time.sleep(1000)
""")
    parent = subprocess.Popen([bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                               str(script)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    said = []
    try:
        while not said or said[-1] and not said[-1].startswith("up "):
            said.append(parent.stdout.readline())
        assert said[-1], f"Blender ended too early: {said}"
        _, child, folder = said[-1].split()
        command = pathlib.Path(f"/proc/{child}/cmdline").read_bytes().decode()
        assert str(repository / "mesograin" / "studies" / "background" / "child.py") in command
    finally:
        os.kill(parent.pid, signal.SIGKILL)
        parent.stdout.close()
        parent.wait()
    until(lambda: not is_running(int(child)) and not os.path.exists(folder), 20.0)
    until(lambda: not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir()), 20.0)


def is_running(process):
    try:
        return "\nState:\tZ" not in pathlib.Path(f"/proc/{process}/status").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return False


@pytest.mark.skipif(sys.platform != "linux", reason="folders that cannot be written are Linux'")
def test_a_folder_that_cannot_be_written_starts_nothing(sphere, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError):
        launch("compare", tmp_path / "file" / "out", **TINY)
