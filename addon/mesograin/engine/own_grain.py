# The artist's own grain, to be shown in place of the shape on Blender's stage: kept by its material's name.
import typing

import numpy as np


class Grain(typing.NamedTuple):
    """As it lies in its scene."""

    meshes: tuple  # native.Meshes of one object
    to_world: tuple  # 16 numbers, row by row: to mm


_grains = {}


def keep(material, meshes, to_world, millimetres_per_unit):
    """Notes the grain of a material, and says whether it is another than before. meshes: native.Meshes. to_world: 16
    numbers, row by row."""
    grain = Grain(tuple(meshes), _stretched(to_world, millimetres_per_unit))
    before = _grains.get(material)
    _grains[material] = grain
    return grain != before


def of_parts(parts):
    """native.Meshes of the grain that a shape of these meshes.MeshParts is; of one that is many, the first of those of
    which it has the most."""
    for part in parts:
        bodies = part.bodies()
        if bodies:
            return [max(bodies, key=lambda body: len(body[1]))[0]]
    return [part.mesh for part in parts]


def keep_all(values):
    """Notes a grain of each material of an export.SceneValues: the first object that wears it, or the typical one of an
    array. Gives the names of the materials whose grain is another than before."""
    first, parts = {}, {}
    for drawn in (*values.instances, *values.heaps):
        parts.setdefault(_whole(drawn), []).append(drawn.mesh)
        if drawn.material.finish is None:
            first.setdefault(drawn.material.name, drawn)
    return [name for name, drawn in first.items()
            if keep(name, parts[_whole(drawn)] if _whole(drawn) is not None else [drawn.mesh], drawn.typical(),
                    values.millimetres_per_unit)]


def _whole(drawn):
    """The number of the object that an export.InstanceValues is a part of; None for what is whole."""
    return getattr(drawn, "object", None)


def of(material):
    """The Grain of the material of this name; None where none was seen."""
    return _grains.get(material)


def forget():
    """Another file's grains are others, whatever their materials' names."""
    _grains.clear()


def _stretched(to_world, factor):
    matrix = np.array(to_world, dtype=np.float64).reshape(4, 4)
    matrix[:3] *= factor
    return tuple(matrix.ravel().tolist())


def standing(grain, radius):
    """(16 numbers, factor): where a Grain stands on the ground above the origin, as large as a ball of this radius
    holds, and how many mm of it a unit of the ground is. None of what has no extent."""
    matrix = np.array(grain.to_world).reshape(4, 4)
    corners = np.concatenate([mesh.arrays()[0] for mesh in grain.meshes]).astype(np.float64) @ matrix[:3, :3].T
    least, most = corners.min(axis=0), corners.max(axis=0)
    middle = (least + most) / 2.0
    reach = np.linalg.norm(corners - middle, axis=1).max()
    if not reach > 0.0:
        return None
    shrink = radius / reach
    matrix[:3, :3] *= shrink
    matrix[:3, 3] = -shrink * np.array((middle[0], middle[1], least[2]))
    return tuple(matrix.ravel().tolist()), 1.0 / shrink
