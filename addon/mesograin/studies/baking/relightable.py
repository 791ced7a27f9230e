# A surface for light from anywhere: a few textures, each of which counts as much as its lobe says of the direction that
# light comes from. Needs no Blender.
"""See `bake`. A texture is of radiance straight above the surface, for irradiance 1 on a plane that faces the light."""

import dataclasses
import math

import numpy

from . import lobes

FITTED = 128
"""Directions that the textures are fitted to."""

JUDGED = 64
"""Other directions, which the error is measured at."""

SMALL = 48
"""Texels on each side of what the lobes are found on."""


class Lit:
    """The texture of some instances under one parallel light of irradiance 1 and nothing else. `native`: the module;
    `to_world`: (3, 3), from the space in which the light's direction is told to the world."""

    def __init__(self, native, instances, to_world, size, samples):
        self._native, self._instances = native, instances
        self._to_world, self._samples = numpy.asarray(to_world, dtype=float), samples
        self.size = tuple(size)
        self._view = native.View(*size)
        self._cancelled = False  # between two directions no view renders

    def __call__(self, to_light):
        """(h, w, 4): premultiplied by the coverage in the last channel. None once it was cancelled."""
        if self._cancelled:
            return None
        towards = self._to_world @ to_light
        light = self._native.DirectionalLight(tuple(towards / numpy.linalg.norm(towards)), (1.0, 1.0, 1.0))
        self._view.set_scene(self._native.Scene(instances=self._instances, lights=[light], exchange="off"))
        self._view.set_bake(list(range(len(self._instances))), "above_surface")
        self._view.render(self._samples)
        return None if self._cancelled or self._view.samples != self._samples else self._view.read()

    @property
    def warnings(self):
        return self._view.warnings

    def cancel(self):
        """For good; from any thread."""
        self._cancelled = True
        self._view.cancel()


class Cancelled(Exception):
    """Nobody waits for it any more."""


@dataclasses.dataclass(frozen=True)
class Relightable:
    """textures: (count, h, w, 3) float32, premultiplied by `coverage`, (h, w). maps: (count, side, side). errors: of
    each direction of `judged`, sum|relit - baked| / sum baked over the texture."""

    textures: numpy.ndarray
    coverage: numpy.ndarray
    maps: numpy.ndarray
    judged: numpy.ndarray
    errors: numpy.ndarray

    def relit(self, to_light):
        """(h, w, 3): radiance for irradiance 1 from a direction in the surface's own space."""
        amounts = lobes.look_up(self.maps, [to_light])[0].astype(numpy.float32)
        return numpy.maximum(numpy.tensordot(amounts, self.textures, 1), 0.0)


def bake(small, large, count, tell=lambda fraction: None):
    """Relightable with `count` textures. small, large: a `Lit` of SMALL texels, to find the lobes on, and of the size
    that is wanted. tell is called with the share that is done. Raises Cancelled."""
    side = lobes.SIDE
    whole = side * side + _cost(large, small) * (FITTED + JUDGED)
    done = 0.0

    def lit(surface, direction, cost):
        nonlocal done
        texture = surface(direction)
        if texture is None:
            raise Cancelled
        done += cost
        tell(min(done / whole, 1.0))
        return texture

    seen = [lit(small, direction, 1.0)[..., :3].ravel() for direction in lobes.map_directions()]
    maps = lobes.principal_maps(numpy.array(seen), count)
    directions = lobes.even_directions(FITTED)
    fit = numpy.linalg.pinv(lobes.look_up(maps, directions)).astype(numpy.float32)  # least squares
    textures = coverage = None
    for number, direction in enumerate(directions):
        texture = lit(large, direction, _cost(large, small))
        if textures is None:
            textures = numpy.zeros((count, *texture.shape[:2], 3), numpy.float32)
            coverage = texture[..., 3].copy()
        for component in range(count):
            textures[component] += fit[component, number] * texture[..., :3]
    judged = lobes.even_directions(JUDGED, turn=1.0)
    made = Relightable(textures, coverage, maps, judged, numpy.zeros(JUDGED))
    for number, direction in enumerate(judged):
        texture = lit(large, direction, _cost(large, small))[..., :3]
        made.errors[number] = numpy.abs(made.relit(direction) - texture).sum() / max(texture.sum(), 1e-30)
    return made


def _cost(large, small):
    return max(math.prod(large.size) / math.prod(small.size), 1.0)
