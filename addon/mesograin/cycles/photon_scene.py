# The reference that Cycles has for no heap of refracting grains under a small sun: the whole scene, by photons.
"""See `take`."""

import dataclasses
import hashlib
import tempfile
from pathlib import Path

from .. import native_module
from ..scene import export, meshes
from . import referee

_TRACED_AS = "model_2"
"""Any model of a medium: the program traces what all of them stand for."""


def take(depsgraph, kind, size, samples, seed, cache=None, overrides=None, on_progress=None, staying=frozenset()):
    """One image of one seed, as `shot.take`. Raises ReferenceError without the program, or if that can't trace it."""
    scene = _scene(depsgraph, overrides or {}, staying)
    camera = export.camera_from_scene(depsgraph, *size, sharp=True)
    native = native_module.get()

    def write(path):
        native.write_scene(str(path), scene, camera, size)

    return referee.take(write, _digest(write), kind, size, samples, seed, cache, on_progress)


def _scene(depsgraph, overrides, staying):
    """native.Scene, as our side has it (docs/comparing.md)."""
    values = export.read_scene(depsgraph, meshes.MeshCache(), varied=False)

    def change(material):
        if material.name in staying:
            return material
        values = {**dict(material.values), **overrides, "model": _TRACED_AS}
        return export.MaterialValues(material.name, tuple(values.items()))

    return dataclasses.replace(values, world=values.world.before_film()).with_materials(change).to_native()


def _digest(write):
    """{file: SHA-256} of all that is written."""
    with tempfile.TemporaryDirectory(prefix="mesograin-") as folder:
        write(Path(folder) / "scene.json")
        return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(Path(folder).iterdir())}
