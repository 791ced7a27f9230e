# Small scenes for the tests of the Cycles side, and what their pixels should be.
import math
import os
import pathlib

import bpy
import numpy as np
from mathutils import Vector

RADIUS = 2.4
DISTANCE = 6.5
BUILD = pathlib.Path(os.environ.get("MESOGRAIN_BUILD") or pathlib.Path(__file__).resolve().parents[2] / "build/release")
REFEREE = BUILD / "tests/referee/mesograin-referee"


def make_sphere(suns, camera=(0.0, 0.0, DISTANCE), segments=128, rings=64, **parameters):
    """A smooth sphere of radius RADIUS, seen from `camera` with 45 degrees; returns its material.
    suns: [(direction to the light, irradiance)]."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=rings, radius=RADIUS)
    sphere = bpy.context.object
    sphere.data.polygons.foreach_set("use_smooth", [True] * len(sphere.data.polygons))
    material = bpy.data.materials.new("Sand")
    for name, value in parameters.items():
        setattr(material.mesograin, name, value)
    sphere.data.materials.append(material)
    for towards, irradiance in suns:
        light = bpy.data.lights.new("Sun", "SUN")
        light.energy, light.angle = irradiance, 0.0
        place("Sun", light).rotation_euler = Vector(towards).to_track_quat("Z", "Y").to_euler()
    lens = bpy.data.cameras.new("Camera")
    lens.angle = math.radians(45.0)
    bpy.context.scene.camera = place("Camera", lens)
    bpy.context.scene.camera.location = camera
    bpy.context.scene.camera.rotation_euler = Vector(camera).to_track_quat("Z", "Y").to_euler()
    bpy.context.scene.mesograin.millimetres_per_unit = 1.0
    return material


def place(name, data):
    placed = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(placed)
    return placed


def depsgraph():
    bpy.context.view_layer.update()
    return bpy.context.evaluated_depsgraph_get()


def sphere_points(size, camera=(0.0, 0.0, DISTANCE), subpixels=4):
    """What the camera sees of the sphere: (normals, directions to the viewer), each (size, size, s, s, 3), and the
    hits, (size, size, s, s) bool; s = subpixels a side."""
    view = bpy.context.scene.camera.matrix_world.to_3x3()
    samples = ((np.arange(size * subpixels) + 0.5) / (size * subpixels) * 2.0 - 1.0) * math.tan(math.radians(22.5))
    x, y = np.meshgrid(samples, -samples)
    towards = np.stack([x, y, -np.ones_like(x)], axis=-1) @ np.array(view).T
    towards /= np.linalg.norm(towards, axis=-1, keepdims=True)
    eye = np.array(camera)
    along = towards @ eye
    under_root = along**2 - (eye @ eye - RADIUS**2)
    hits = under_root > 0.0
    distance = -along - np.sqrt(np.maximum(under_root, 0.0))
    normals = (eye + distance[..., None] * towards) / RADIUS

    def split(values):
        shape = (size, subpixels, size, subpixels, *values.shape[2:])
        return np.swapaxes(values.reshape(shape), 1, 2)

    return split(normals), split(-towards), split(hits)


def unit(vector):
    return np.array(vector, dtype=float) / np.linalg.norm(vector)
