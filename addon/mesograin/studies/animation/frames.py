# Renders frames in a Blender without window: blender -b SCENE.blend --python THIS -- [--frames WHICH] [--part I/N]
"""Tells each step in a line that begins with PREFIX: JSON. A frame's file is there whole or not at all: it is rendered
under another name beside it and renamed. See `main`."""

import json
import os
import socket
import sys
from pathlib import Path

PREFIX = "mesograin-animate: "
OK, FAILED, BAD_SCENE, NO_OUTPUT = 0, 1, 2, 3
MOVIES = ("FFMPEG", "AVI_JPEG", "AVI_RAW")


class SceneError(Exception):
    """One sentence on why the scene has no frames that could be rendered one by one."""


def main(words):
    """Renders what `words` say of the open scene, or of --scene-file; returns an exit code."""
    from . import arguments

    chosen = arguments.build_frames().parse_args(words)
    try:
        return _run(chosen)
    except SceneError as error:
        tell(complaint=str(error), exit=BAD_SCENE)
        return BAD_SCENE
    except OSError as error:
        tell(complaint=f"'{error.filename}' cannot be written: {error.strerror or error}.", exit=NO_OUTPUT)
        return NO_OUTPUT


def tell(**event):
    print(PREFIX + json.dumps(event), flush=True)


def _run(chosen):
    import bpy

    if chosen.scene_file:
        _open(chosen.scene_file)
    scene = bpy.context.scene
    if chosen.out:
        scene.render.filepath = chosen.out
    _require_pictures(scene)
    number, parts = chosen.part
    asked = chosen.frames or list(range(scene.frame_start, scene.frame_end + 1, scene.frame_step))
    files = {frame: file_of(scene, frame) for frame in asked[number::parts]}
    there = {frame for frame, file in files.items() if is_whole(file)}
    if chosen.list:
        for frame, file in files.items():
            tell(frame=frame, file=str(file), there=frame in there)
        return OK
    tell(frames=len(files), there=len(there))
    failed = 0
    for frame, file in files.items():
        if frame not in there and not is_whole(file):  # another machine may have done it meanwhile
            failed += not _render(scene, frame, file)
    return FAILED if failed else OK


def _open(path):
    import bpy

    from ...command_line import process

    try:
        process.open_scene(path)
    except process.CommandError as error:
        raise SceneError(str(error)) from error
    if not bpy.context.scene.render.filepath:
        raise SceneError("The scene has no output path: set one (Output Properties), or say --out.")


def _require_pictures(scene):
    settings = scene.render.image_settings
    if settings.file_format in MOVIES:
        raise SceneError("The scene's output is a movie, which many machines cannot write together: choose a picture's "
                         "format, such as OpenEXR, and make the movie of the frames.")
    if scene.render.use_multiview and settings.views_format == "INDIVIDUAL":
        raise SceneError("The scene's views go to files of their own, which cannot be written at once: choose Stereo "
                         "3D or Multi-View as the format of its views.")
    if scene.camera is None:
        raise SceneError("The scene has no active camera: add one (Add > Camera) and make it active.")


def file_of(scene, frame):
    """The pathlib.Path that Blender gives this frame."""
    return Path(scene.render.frame_path(frame=frame))


def is_whole(file):
    """Whether a frame's file is there to its end: Blender itself, ended amid writing, leaves a part."""
    try:
        if file.suffix == ".exr":
            return _is_whole_exr(file)
        with open(file, "rb") as opened:
            begins = opened.read(8)
            size = opened.seek(0, os.SEEK_END)
            opened.seek(max(size - 8, 0))
            return size > 0 and (begins[1:4] != b"PNG" or opened.read(4) == b"IEND")
    except OSError:
        return False


def _is_whole_exr(file):
    from ... import native_module

    if not file.is_file():
        return False
    try:
        native_module.get().read_exr(str(file))
    except native_module.get().Error:
        return False
    return True


def _render(scene, frame, file):
    """Whether it worked."""
    import bpy

    file.parent.mkdir(parents=True, exist_ok=True)
    # Blender puts digits after a name without #, but for a single picture takes it as it is.
    partial = file.with_name(f".{file.stem}.{socket.gethostname()}-{os.getpid()}{file.suffix}")
    output, extension = scene.render.filepath, scene.render.use_file_extension
    tell(begins=frame, partial=str(partial))
    try:
        scene.frame_set(frame)
        scene.render.filepath, scene.render.use_file_extension = str(partial), False
        bpy.ops.render.render(write_still=True)
        if not is_whole(partial):
            raise RuntimeError("Blender wrote no picture")
        partial.replace(file)
    except RuntimeError as error:
        tell(failed=frame, why=" ".join(str(error).split()).removeprefix("Error: "))
        return False
    finally:
        scene.render.filepath, scene.render.use_file_extension = output, extension
        partial.unlink(missing_ok=True)
    tell(done=frame, file=str(file))
    return True


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[3]))
    from mesograin.studies.animation import frames

    sys.exit(frames.main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []))
