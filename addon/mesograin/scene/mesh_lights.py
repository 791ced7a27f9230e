# Meshes that shine on others: each rectangle of one is an area light, as Cycles lights with emission.
import numpy as np

from . import lights, meshes

MOST_FACES = 6
"""More would cost each pixel too much."""

APART = 1e-4
"""How far in front of its face a light is, of its size: the face does not stand in its own light."""


def read(evaluated_object, matrix_world, slot, worn, radiance):
    """[lights.PlacedLightValues] of the faces that have a slot of meshes.slots_worn and send out radiance, linear RGB;
    None if they are more than a few, or no rectangles."""
    mesh = evaluated_object.to_mesh()
    try:
        slots = meshes.slots_of_faces([face.material_index for face in mesh.polygons], worn)
        faces = [face for face, of_face in zip(mesh.polygons, slots) if of_face == slot]
        if not 0 < len(faces) <= MOST_FACES:
            return None
        to_world = np.array(matrix_world)
        corners = [np.array([mesh.vertices[index].co for index in face.vertices]) @ to_world[:3, :3].T + to_world[:3, 3]
                   for face in faces]
        closed = 2 * len(mesh.edges) == len(mesh.loops)
    finally:
        evaluated_object.to_mesh_clear()
    if not all(map(_is_rectangle, corners)):
        return None
    mirrored = np.linalg.det(to_world[:3, :3]) < 0.0
    sides = ((-1.0 if mirrored else 1.0),) if closed else (1.0, -1.0)
    return [_light(evaluated_object.name, each, side, radiance) for each in corners for side in sides]


def _is_rectangle(corners):
    if len(corners) != 4:
        return False
    along, across = corners[1] - corners[0], corners[3] - corners[0]
    size = max(np.linalg.norm(along), np.linalg.norm(across))
    return bool(np.linalg.norm(corners[2] - corners[1] - across) <= 1e-4 * size
                and abs(along @ across) <= 1e-4 * size * size)


def _light(name, corners, side, radiance):
    """side: 1 where the face's corners go around counter-clockwise, -1 on the other."""
    half_x, half_y = 0.5 * (corners[1] - corners[0]), 0.5 * (corners[3] - corners[0])
    normal = side * np.cross(half_x, half_y)
    normal /= np.linalg.norm(normal)
    if side > 0.0:
        half_y = -half_y  # it shines against the cross product of its halves
    size = max(np.linalg.norm(half_x), np.linalg.norm(half_y))
    return lights.PlacedLightValues(name, "AreaLight", (
        ("position", tuple((corners.mean(axis=0) + APART * size * normal).tolist())),
        ("half_x", tuple(half_x.tolist())),
        ("half_y", tuple(half_y.tolist())),
        ("radiance", tuple(radiance)), ("ellipse", False), ("spread", np.pi), ("drawn", True)))
