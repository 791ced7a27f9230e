# The reference that no path tracer can make: a sphere with a smooth interface under a sun without extent, by photons.
"""See `take`."""

import json
import math

import numpy

from ..scene import export, lights, meshes
from . import referee
from .shot import ReferenceError

ROUNDNESS = 1e-3
"""How far vertices may lie off the sphere, as a part of its radius."""


def take(depsgraph, kind, size, samples, seed, cache=None, overrides=None, on_progress=None):
    """One image of one seed, as `shot.take`. Raises ReferenceError without a sphere or without the program."""
    scene = _scene(depsgraph, size, overrides or {})
    return referee.take(lambda path: path.write_text(json.dumps(scene), encoding="utf-8"), scene, kind, size, samples,
                        seed, cache, on_progress)


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
        " something else: choose the reference photon_scene."
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
