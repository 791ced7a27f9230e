# The reference that no path tracer can make: a sphere with a smooth interface under a sun without extent, by photons.
"""See `take`. The renderer is mesograin-referee (docs/referee.md), a program of its own beside the tests."""

import hashlib
import json
import math
import os
import re
import subprocess
import tempfile
import time
from pathlib import Path

import numpy

from .. import native_module
from ..scene import export, lights, meshes
from . import shot
from .shot import ReferenceError, Shot

PROGRAM = "mesograin-referee"
ROUNDNESS = 1e-3
"""How far vertices may lie off the sphere, as a part of its radius."""

_ROWS = re.compile(r"(\d+) of (\d+) rows")


def take(depsgraph, kind, size, samples, seed, cache=None, overrides=None, on_progress=None):
    """One image of one seed, as `shot.take`. Raises ReferenceError without a sphere or without the program."""
    native = native_module.get()
    tell = on_progress or (lambda fraction: None)
    scene = _scene(depsgraph, size, overrides or {})
    described = json.dumps({"photon": 1, "scene": scene, "samples": samples, "seed": seed}, sort_keys=True)
    key = hashlib.sha256(described.encode()).hexdigest()
    found = shot.read_cached(native, cache, key, size)
    if found:
        tell(1.0)
        return found
    program = _program()
    started = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="mesograin-") as folder:
        source, picture = Path(folder) / "scene.json", Path(folder) / "photon.exr"
        source.write_text(json.dumps(scene), encoding="utf-8")
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
        "scene": scene,
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


def _scene(depsgraph, size, overrides):
    """The scene as mesograin-referee reads it (docs/scene-json.md). Raises ReferenceError if it is not that simple."""
    values = export.read_scene(depsgraph, meshes.MeshCache(), varied=False)
    values.to_native()  # says which light or material has values that cannot be
    centre, radius = _sphere(depsgraph)
    others = [light.name for light in values.lights if not isinstance(light, lights.SunValues)]
    if others or values.world.shines:
        what = f"'{others[0]}' is none" if others else "the world shines"
        raise ReferenceError(f"The photon reference knows suns under a black world, and {what}: remove it, or choose "
                             "another reference.")
    if not values.lights:
        raise ReferenceError("The scene has no visible sun light: add one.")
    parameters = {**dict(values.materials[0].values), **overrides}
    if len(values.materials) > 1:
        raise ReferenceError("The photon reference traces one sphere of one material; the scene's has several.")
    return {
        "geometry": {"shape": "sphere", "centre": centre, "radius": radius},
        "camera": _camera(depsgraph, size),
        "resolution": list(size),
        "lights": [
            {
                "type": "distant",
                "direction_to_light": list(light.direction_to_light),
                "irradiance_linear_rgb": list(light.irradiance),
                "angle": light.angle,
            }
            for light in values.lights
        ],
        "material": {
            "kind": "medium",
            **{name: list(parameters[name]) for name in ("sigma_s", "sigma_a")},
            **{name: parameters[name] for name in ("g", "eta", "scale")},
            "roughness": 0.0,
            "boundary": "dielectric",
        },
    }


def _sphere(depsgraph):
    """(centre, radius) of the one mesh that is seen, if its vertices lie on a sphere."""
    shapes = [
        (each.object, each.matrix_world.copy())
        for each in depsgraph.object_instances
        if each.show_self and meshes.is_drawn(each.object, each.matrix_world)
    ]
    shapes = [(shape, matrix) for shape, matrix in shapes if shape.type != "MESH" or shape.data.polygons]
    if len(shapes) == 1 and shapes[0][0].type == "MESH":
        mesh, matrix = shapes[0][0].data, numpy.array(shapes[0][1])
        points = numpy.empty((len(mesh.vertices), 3), numpy.float32)
        mesh.vertices.foreach_get("co", points.ravel())
        points = points @ matrix[:3, :3].T + matrix[:3, 3]
        centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
        distances = numpy.linalg.norm(points - centre, axis=1)
        radius = float(distances.mean())
        if len(points) >= 100 and abs(distances - radius).max() <= ROUNDNESS * radius:
            return [float(value) for value in centre], radius
    raise ReferenceError(
        "The photon reference needs a single sphere (vertices within 0.1 % of one), not instanced; the scene has"
        " something else: choose the reference volume_dielectric."
    )


def _camera(depsgraph, size):
    camera = depsgraph.scene_eval.camera
    lens = camera.data if camera is not None and camera.type == "CAMERA" else None
    if lens is None or lens.type != "PERSP" or lens.shift_x or lens.shift_y:
        raise ReferenceError("The photon reference needs a perspective camera without shift: set the camera so.")
    clip = camera.calc_matrix_camera(depsgraph, x=size[0], y=size[1])
    matrix = camera.matrix_world
    position, forward, up = matrix.translation, -matrix.col[2].xyz, matrix.col[1].xyz
    return {
        "position": list(position),
        "look_at": list(position + forward),
        "up": list(up),
        "fov_degrees": math.degrees(2.0 * math.atan(1.0 / max(clip[0][0], clip[1][1]))),
    }
