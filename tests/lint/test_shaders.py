"""Every program that the renderer puts together is valid GLSL for a compiler that is not this machine's driver."""
import os
import pathlib
import shutil
import subprocess

import pytest

from sources import SOURCE

BUILD = pathlib.Path(os.environ.get("MESOGRAIN_BUILD", SOURCE / "build/release"))
FOLDER = BUILD / "shaders"


def assemble():
    """Runs the assembler into an empty folder; returns what came of it."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    tool = BUILD / "tests/lint/mesograin-assemble-shaders"
    return subprocess.run([str(tool), str(FOLDER)], capture_output=True, text=True)


ASSEMBLED = assemble()


def test_every_shader_file_is_assembled():
    assert ASSEMBLED.returncode == 0, ASSEMBLED.stderr


@pytest.mark.parametrize("name", sorted(path.stem for kind in ("*.vert", "*.comp") for path in FOLDER.glob(kind)))
def test_glslang(name):
    candidates = [FOLDER / (name + suffix) for suffix in (".vert", ".tesc", ".tese", ".frag", ".comp")]
    stages = [str(stage) for stage in candidates if stage.exists()]
    outcome = subprocess.run(["glslangValidator", "-l", *stages], capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stdout
