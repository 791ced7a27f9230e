# Describes a staged scene completely, so that a reference can be found again by what determines it.
"""Equal descriptions render equal images; see `describe` and `key`."""

import hashlib
import json

import bpy
import numpy

from .stage import CAMERA_PROPERTIES

FORMAT = 2
"""Raised whenever a stored reference may no longer be used."""


def key(description):
    """The name of a reference in the cache: the SHA-256 of its description."""
    return hashlib.sha256(json.dumps(description, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def describe(scene, recipes, settings):
    """JSON-able description of a staged scene. recipes: {material name: recipe}. settings: `settings.settings(...)`."""
    meshes = {}
    objects = []
    for placed in scene.collection.objects:
        matrix = [list(row) for row in placed.matrix_world]
        if placed.type == "MESH":
            digest = meshes.setdefault(placed.data.name, _mesh(placed.data))
            materials = [recipes[material.name] for material in placed.data.materials]
            objects.append({"mesh": digest, "materials": materials, "matrix": matrix})
        elif placed.type == "LIGHT":
            light = placed.data
            objects.append({"sun": light.energy, "color": list(light.color), "angle": light.angle, "matrix": matrix})
        elif placed.type == "CAMERA":
            camera = {name: getattr(placed.data, name) for name in CAMERA_PROPERTIES}
            objects.append({"camera": camera, "matrix": matrix})
    return {
        "format": FORMAT,
        "blender": bpy.app.version_string,
        "build": bpy.app.build_hash.decode("ascii", "replace"),
        "objects": sorted(objects, key=lambda described: json.dumps(described, sort_keys=True)),
        "settings": settings,
    }


def _mesh(mesh):
    """Digest of all of a mesh that Cycles sees.

    Of the normals it holds what they are computed from: Blender sums them in threads, so that their last digit
    changes from one time to the next.
    """
    digest = hashlib.sha256()

    def add(collection, attribute, width, dtype):
        values = numpy.empty(len(collection) * width, dtype)
        collection.foreach_get(attribute, values)
        digest.update(f"{attribute}:{values.size}:".encode())
        digest.update(values.tobytes())

    add(mesh.vertices, "co", 3, numpy.float32)
    add(mesh.loops, "vertex_index", 1, numpy.int32)
    add(mesh.loops, "edge_index", 1, numpy.int32)
    add(mesh.polygons, "loop_start", 1, numpy.int32)
    add(mesh.polygons, "loop_total", 1, numpy.int32)
    add(mesh.polygons, "material_index", 1, numpy.int32)
    add(mesh.polygons, "use_smooth", 1, bool)
    add(mesh.edges, "use_edge_sharp", 1, bool)
    if hasattr(mesh, "use_auto_smooth"):
        digest.update(f"auto smooth:{mesh.use_auto_smooth}:{mesh.auto_smooth_angle}".encode())
    if mesh.has_custom_normals:
        digest.update(f"custom normals:{_custom_normals(mesh)}".encode())
    return digest.hexdigest()


def _custom_normals(mesh):
    """Three sums that change with any normal by more than their last digit does."""
    normals = numpy.empty((len(mesh.loops), 3), numpy.float32)
    if hasattr(mesh, "corner_normals"):
        mesh.corner_normals.foreach_get("vector", normals.ravel())
    else:
        mesh.calc_normals_split()
        mesh.loops.foreach_get("normal", normals.ravel())
    weights = numpy.cos(numpy.arange(len(normals), dtype=numpy.float64))
    return [round(float(total), 3) for total in weights @ normals.astype(numpy.float64)]
