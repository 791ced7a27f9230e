# Frames are rendered whole or not at all, once, and by Flamenco's words too; what no machine could share is refused.
import json
import pathlib
import re
import sys

import bpy
import pytest
from mesograin.studies.animation import frames
from test_export import add_camera, add_cube, add_sun


@pytest.fixture
def scene(tmp_path):
    made = bpy.context.scene
    made.render.resolution_x = made.render.resolution_y = 16
    made.mesograin.samples = 1
    made.frame_start, made.frame_end = 1, 4
    made.render.filepath = str(tmp_path / "shots" / "grain_###")
    made.render.image_settings.file_format = "OPEN_EXR"
    cube = add_cube()
    for frame in (1, 4):
        cube.location.x = 0.2 * frame
        cube.keyframe_insert("location", frame=frame)
    add_camera((0.0, 0.0, 8.0))
    add_sun((0.0, 0.0, 1.0), 3.0)
    return made


@pytest.fixture
def run(capfd):
    """(exit code, events) of frames.main."""

    def do(*words):
        capfd.readouterr()
        code = frames.main(list(words))
        lines = capfd.readouterr().out.splitlines()
        return code, [json.loads(line.removeprefix(frames.PREFIX)) for line in lines if line.startswith(frames.PREFIX)]

    return do


def test_frames_that_are_there_whole_are_left_alone(scene, run, native, tmp_path):
    code, events = run()
    assert code == frames.OK and events[0] == {"frames": 4, "there": 0}
    files = sorted((tmp_path / "shots").iterdir())
    assert [file.name for file in files] == [f"grain_00{number}.exr" for number in (1, 2, 3, 4)]
    first, last = (native.read_exr(str(file))[0] for file in (files[0], files[3]))
    assert first[..., 0].max() > 0.1 and abs(first - last).max() > 0.1, "each is of its own frame"
    times = [file.stat().st_mtime_ns for file in files]
    files[1].write_bytes(files[1].read_bytes()[:600])  # as a Blender that was ended leaves it
    files[2].unlink()
    code, events = run()
    assert events[0] == {"frames": 4, "there": 2}
    assert [event["done"] for event in events if "done" in event] == [2, 3]
    assert [file.stat().st_mtime_ns == time for file, time in zip(files, times)] == [True, False, False, True]
    assert len(list((tmp_path / "shots").iterdir())) == 4
    assert scene.render.filepath.endswith("grain_###") and scene.render.use_file_extension


def test_parts_are_every_nth_frame_and_pictures_may_be_png(scene, run, tmp_path):
    scene.render.image_settings.file_format = "PNG"
    assert run("--frames", "1-4", "--part", "1/2")[0] == frames.OK
    assert sorted(file.name for file in (tmp_path / "shots").iterdir()) == ["grain_002.png", "grain_004.png"]
    file = tmp_path / "shots" / "grain_002.png"
    file.write_bytes(file.read_bytes()[:-4])
    _, events = run("--list")
    assert [event["there"] for event in events] == [False, False, False, True]
    _, events = run("--list", "--out", str(tmp_path / "shots" / "grain_"))
    assert [(event["frame"], event["there"]) for event in events] == [(number, False) for number in (1, 2, 3, 4)]
    assert events[0]["file"].endswith("grain_0001.png")


def test_a_frame_that_fails_leaves_nothing_and_the_rest_goes_on(scene, run, tmp_path):
    camera = scene.camera
    camera.scale = (1.0, 1.0, 1.0)
    camera.keyframe_insert("scale", frame=1)
    camera.scale = (0.0, 0.0, 0.0)
    camera.keyframe_insert("scale", frame=2)
    code, events = run("--frames", "1,2")
    assert code == frames.FAILED
    assert [event["failed"] for event in events if "failed" in event] == [2]
    assert "scaled to nothing" in next(event["why"] for event in events if "failed" in event)
    assert [file.name for file in (tmp_path / "shots").iterdir()] == ["grain_001.exr"]


def test_what_cannot_be_shared_is_refused_in_a_sentence(scene, run, tmp_path):
    if hasattr(scene.render.image_settings, "media_type"):  # which is a choice of its own from Blender 5 on
        scene.render.image_settings.media_type = "VIDEO"
    scene.render.image_settings.file_format = "FFMPEG"
    code, [event] = run()
    assert code == frames.BAD_SCENE and "movie" in event["complaint"]
    if hasattr(scene.render.image_settings, "media_type"):
        scene.render.image_settings.media_type = "IMAGE"
    scene.render.image_settings.file_format = "OPEN_EXR"
    (tmp_path / "file").write_text("")
    code, events = run("--out", str(tmp_path / "file" / "grain_"))
    assert code == frames.NO_OUTPUT and "cannot be written" in events[-1]["complaint"]
    scene.camera = None
    code, [event] = run()
    assert code == frames.BAD_SCENE and "no active camera" in event["complaint"]


def test_flamenco_s_words_render(scene, tmp_path, monkeypatch):
    text = pathlib.Path(frames.__file__).with_name("mesograin_animation.js").read_text()
    statement = text[text.index("const RENDER_FRAMES ="):].split(";\n\n")[0]
    code = "".join(json.loads(word) for word in re.findall(r'"[^"]*"', statement))
    monkeypatch.setattr(sys, "argv", ["blender", "-b", "--", "--frames=2-3", "--out", str(tmp_path / "farm_##")])
    with pytest.raises(SystemExit) as ended:
        exec(code, {})
    assert ended.value.code == frames.OK
    assert sorted(file.name for file in tmp_path.glob("farm*")) == ["farm_02.exr", "farm_03.exr"]
