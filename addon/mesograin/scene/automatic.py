# The model AUTO: which one it is for a drawn thing, by its mesh, its size and its medium.
import dataclasses
import functools
import math
import operator
import weakref

import numpy as np

from .. import native_module
from ..schema import advice, models

_shapes = weakref.WeakKeyDictionary()  # {native.Mesh: {_stretch's key: its (volume, area, closed) at scale 1}}
MOST_SHAPES = 64
"""Of one mesh that are remembered; copies of it that are stretched have one each."""

WALKED = "transport"
MOST_WALKED = 32
"""Shapes of one material, as *Add Pile* makes at most: each takes seconds before it can be drawn."""
OF_MANY = "model_3", advice.ANGULAR["model_3"]
"""What serves more, and its error."""


def asked(material):
    """Whether an export.MaterialValues leaves its model to be chosen."""
    return ("model", models.AUTO.name) in material.values


def with_models(things, tolerance):
    """export.InstanceValues and heaps.HeapValues, each with the model that serves it if it is AUTO. tolerance: in %.
    Raises native.Error that names the material."""
    return [drawn if advised is None else dataclasses.replace(drawn, material=_with_model(drawn.material, advised[0]))
            for drawn, advised in zip(things, advice_for(things, tolerance))]


def advice_for(things, tolerance):
    """(name, measured error in %) of the model that serves each of the things drawn, None where that is not AUTO.
    Raises as with_models."""
    found = _advised_alone(things, tolerance)
    numerous = _of_many_shapes(things, found)
    return [OF_MANY if advised and advised[0] == WALKED and drawn.material.name in numerous else advised
            for drawn, advised in zip(things, found)]


def of_many_shapes(things, tolerance):
    """{name: how many shapes wear it} of AUTO's materials that OF_MANY serves, as light would be walked in each shape
    for too long. Raises as with_models."""
    return _of_many_shapes(things, _advised_alone(things, tolerance))


def _advised_alone(things, tolerance):
    return [_advise(drawn.material, shape(drawn.mesh, drawn.typical()), tolerance) if asked(drawn.material) else None
            for drawn in things]


def _of_many_shapes(things, found):
    shapes = {}
    for drawn, advised in zip(things, found):
        # What is clear shows what is behind by no other model, and nothing is walked in it.
        if advised and advised[0] == WALKED and any(dict(drawn.material.values)["sigma_s"]):
            shapes.setdefault(drawn.material.name, set()).add(drawn.mesh)
    return {name: len(worn) for name, worn in shapes.items() if len(worn) > MOST_WALKED}


@functools.lru_cache(maxsize=256)
def _advise(material, shape, tolerance):
    native = native_module.get()
    found = advice.advise(native, material.to_native(native), *shape, tolerance)
    return found.model, found.error


@functools.lru_cache(maxsize=256)
def _with_model(material, model):
    return dataclasses.replace(material, values=tuple({**dict(material.values), "model": model}.items()))


def shape(mesh, to_world):
    """(volume, area, whether it is closed) of a native.Mesh. to_world: 16 numbers, row by row."""
    known = _shapes.setdefault(mesh, {})
    stretch, scale = _stretch(to_world)
    if stretch not in known:
        if len(known) >= MOST_SHAPES:
            known.clear()
        matrix = np.array(to_world, dtype=np.float64).reshape(4, 4)
        matrix[:3, :3] /= scale
        known[stretch] = native_module.get().shape_of(mesh, matrix)
    volume, area, closed = known[stretch]
    return volume * scale**3, area * scale**2, closed


def _stretch(to_world):
    """(key, scale) of a transform: what is turned, moved, mirrored or scaled evenly has the key of what is not."""
    x, y, z = ((to_world[column], to_world[4 + column], to_world[8 + column]) for column in range(3))
    products = [sum(map(operator.mul, one, other)) for one, other in ((x, x), (y, y), (z, z), (x, y), (y, z), (z, x))]
    squared = (products[0] + products[1] + products[2]) / 3.0
    if not 0.0 < squared < math.inf:
        return tuple(products), 1.0
    return tuple(round(product / squared, 5) for product in products), math.sqrt(squared)
