# Runs mesograin-referee (docs/referee.md), a program of its own beside the tests, on a scene in a file.
"""See `take`."""

import hashlib
import json
import os
import re
import subprocess
import tempfile
import time
from pathlib import Path

import numpy

from .. import native_module
from . import shot
from .shot import ReferenceError, Shot

PROGRAM = "mesograin-referee"

_ROWS = re.compile(r"(\d+) of (\d+) rows")


def take(write, determined_by, kind, size, samples, seed, cache=None, on_progress=None):
    """One image of one seed of a scene, from the cache or traced into it: a Shot.

    write(path): writes it as JSON (docs/scene-json.md) and what belongs to it beside. determined_by: what can be
    written as JSON and tells its pictures from all others, of the same kind, samples and seed. kind: kinds.Kind.
    Raises ReferenceError without the program, or if that can't trace the scene.
    """
    native = native_module.get()
    tell = on_progress or (lambda fraction: None)
    described = json.dumps({kind.name: 1, "scene": determined_by, "samples": samples, "seed": seed}, sort_keys=True)
    key = hashlib.sha256(described.encode()).hexdigest()
    found = shot.read_cached(native, cache, key, size)
    if found:
        tell(1.0)
        return found
    program = _program()
    started = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="mesograin-") as folder:
        source, picture = Path(folder) / "scene.json", Path(folder) / "photon.exr"
        write(source)
        _run([program, "render", source, "-o", picture, "-n", samples, "--seed", seed], tell)
        pixels, channels, _ = native.read_exr(picture)
    pixels = numpy.ascontiguousarray(pixels[..., [channels.index(name) for name in "RGBA"]])
    provenance = {
        "made_by": f"{PROGRAM} {native.__version__}",
        "reference": kind.name,
        "samples": samples,
        "seed": seed,
        "pixel_filter": "box, one pixel",
        "colour_space": "linear, scene-referred; alpha is premultiplied",
        "seconds": round(time.monotonic() - started, 3),
        "scene": determined_by,
        "key": key,
    }
    return shot.keep(native, cache, key, Shot(pixels, json.loads(json.dumps(provenance)), cached=False))


def _program():
    """The program's path: MESOGRAIN_REFEREE, else in the release build of the checkout that the add-on lies in."""
    chosen = os.environ.get("MESOGRAIN_REFEREE")
    path = Path(chosen or Path(__file__).resolve().parents[3] / "build/release/tests/referee" / PROGRAM)
    if not os.access(path, os.X_OK):
        raise ReferenceError(
            f"The photon reference is rendered by {PROGRAM}, which is not at {path}: run ./mesograin compare in a"
            " checkout, which builds it, or name it in MESOGRAIN_REFEREE."
        )
    return path


def _run(words, tell):
    said = ""
    with subprocess.Popen([str(word) for word in words], stderr=subprocess.PIPE, text=True) as process:
        try:
            for line in process.stderr:
                rows = _ROWS.search(line)
                if rows:
                    tell(int(rows[1]) / int(rows[2]))
                else:
                    said = line.strip() or said
        except BaseException:
            process.kill()
            raise
    if process.returncode != 0:
        raise ReferenceError(f"The photon reference could not be rendered: {said or f'exit code {process.returncode}'}")
