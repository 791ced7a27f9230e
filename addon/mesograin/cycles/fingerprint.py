# Describes a staged scene completely, so that a reference can be found again by what determines it.
"""Equal descriptions render equal images; see `describe` and `key`."""

import hashlib
import json

import bpy
import numpy

from . import lighting
from .stage import CAMERA_PROPERTIES

FORMAT = 3
"""Raised whenever a stored reference may no longer be used."""


def key(description):
    """The name of a reference in the cache: the SHA-256 of its description."""
    return hashlib.sha256(json.dumps(description, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def describe(stage, recipes, settings):
    """JSON-able description of a `stage.Stage`. recipes: {material name: recipe}. settings: of `settings.settings`."""
    meshes = {}

    def shape(mesh):
        if mesh.name not in meshes:
            meshes[mesh.name] = {"mesh": _mesh(mesh), "materials": [recipes[each.name] for each in mesh.materials]}
        return meshes[mesh.name]

    heaps = {heap.object.name for heap in stage.heaps}
    objects = [{**shape(heap.mesh), "matrices": _unordered(heap.matrices)} for heap in stage.heaps]
    for placed in stage.scene.collection.objects:
        if placed.name in heaps:
            continue
        matrix = [list(row) for row in placed.matrix_world]
        if placed.type == "MESH":
            objects.append({**shape(placed.data), "matrix": matrix})
        elif placed.type == "LIGHT":
            objects.append({**lighting.describe(placed.data), "matrix": matrix})
        elif placed.type == "CAMERA":
            camera = {name: getattr(placed.data, name) for name in CAMERA_PROPERTIES}
            objects.append({"camera": camera, "matrix": matrix})
    return {
        "format": FORMAT,
        "blender": bpy.app.version_string,
        "build": bpy.app.build_hash.decode("ascii", "replace"),
        "objects": sorted(objects, key=lambda described: json.dumps(described, sort_keys=True)),
        "world": lighting.describe_world(stage.world),
        "settings": settings,
    }


def _unordered(matrices):
    """Digest of (n, 4, 4) matrices, whatever their order."""
    rows = numpy.ascontiguousarray(matrices, dtype=numpy.float32).reshape(-1, 16)
    return hashlib.sha256(rows[numpy.lexsort(rows.T)].tobytes()).hexdigest()


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
