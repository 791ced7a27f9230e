# The model AUTO: which one it is for a drawn thing, by its mesh, its size and its medium.
import dataclasses
import functools
import weakref

import numpy as np

from .. import native_module
from ..schema import advice, models

_shapes = weakref.WeakKeyDictionary()  # {native.Mesh: {linear part of a transform: its (volume, area, closed)}}
MOST_SHAPES = 64
"""Of one mesh that are remembered; turned copies of it have one each."""


def asked(material):
    """Whether an export.MaterialValues leaves its model to be chosen."""
    return ("model", models.AUTO.name) in material.values


def with_model(drawn, tolerance):
    """An export.InstanceValues or heaps.HeapValues with the model that serves it, if it is AUTO. tolerance: in %.
    Raises native.Error that names the material."""
    if not asked(drawn.material):
        return drawn
    return dataclasses.replace(drawn, material=_with_model(drawn.material, advised(drawn, tolerance)[0]))


def advised(drawn, tolerance):
    """(name, measured error in %) of the model that serves a drawn thing whose model is AUTO. Raises as with_model."""
    return _advise(drawn.material, shape(drawn.mesh, drawn.typical()), tolerance)


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
    linear = tuple(to_world[row * 4 + column] for row in range(3) for column in range(3))
    if linear not in known:
        if len(known) >= MOST_SHAPES:
            known.clear()
        known[linear] = native_module.get().shape_of(mesh, np.array(to_world, dtype=np.float64).reshape(4, 4))
    return known[linear]
