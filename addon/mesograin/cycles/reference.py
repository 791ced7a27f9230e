# A reference: images of independent seeds by Cycles, rendered or found in the cache, and what is common to them.
"""See `Sampling` and `render`."""

import math
from dataclasses import dataclass

import numpy

from ..scene import export
from . import beside, kinds, nodes, photon, photon_scene, shot
from .limits import limits
from .shot import PROVENANCE, ReferenceError

__all__ = ["PROVENANCE", "SEEDS", "Reference", "ReferenceError", "Sampling", "render"]

WIDEST_SUN = math.radians(175.4)
"""Where a flat disc is the sun: a Lambertian sphere differs by 3 % under one of 90 degrees, by 8 % under 120."""

SEEDS = (1, 2)
"""Two independent images by default: their difference tells the noise, their mean is the reference."""


@dataclass(frozen=True)
class Reference:
    """images: one (h, w, 4) float32 array for each seed, linear, premultiplied, row 0 at the top; alpha: coverage.
    seeds: their numbers. seconds: what rendering them took, now or when they were put into the cache. cached: whether
    nothing was rendered. provenance: one dict for each seed. notes: sentences about what Cycles could not express
    exactly."""

    images: tuple
    seeds: tuple
    seconds: float
    cached: bool
    provenance: tuple
    notes: tuple

    @property
    def mean(self):
        """The reference itself, (h, w, 4) float32."""
        return numpy.mean(self.images, axis=0, dtype=numpy.float64).astype(numpy.float32)

    @property
    def standard_error(self):
        """Of the mean, in radiance, (h, w, 3) float32; None with a single seed."""
        count = len(self.images)
        if count < 2:
            return None
        variance = numpy.var([image[..., :3] for image in self.images], axis=0, ddof=1, dtype=numpy.float64)
        return numpy.sqrt(variance / count).astype(numpy.float32)


class Sampling:
    """A reference that can be given more seeds; each is kept in the cache by itself.

    depsgraph: evaluated, of the scene with its `mesograin` properties. kind: a name in `kinds.KINDS`.
    size: (width, height) in pixels. samples: per pixel and seed; the kind's default if None.
    cache: a `Cache`, or None for none. overrides: {parameter: value} for every material, coefficients per scene unit.
    unwrapping: an `unwrapping.Unwrapping` for a baked texture instead of a picture; alpha is then 1 where it was baked.
    part: of `kinds.PARTS`, one that this kind has, or None for the whole.
    Raises ReferenceError for what Cycles cannot render at all, before anything is rendered.
    """

    def __init__(self, depsgraph, kind, size, samples=None, cache=None, overrides=None, unwrapping=None, part=None):
        self.kind = kinds.kind_of(kind, part)
        self.samples = samples or self.kind.samples
        self._depsgraph, self._size, self._cache, self._overrides = depsgraph, size, cache, overrides or {}
        self._unwrapping = unwrapping
        if unwrapping and not self.kind.has_texture:
            raise ReferenceError(f"The reference {kind} is a picture and has no texture: choose another.")
        self._staying, self.notes = _check(depsgraph, self.kind, self._overrides)
        self._coverage = None
        self._shots = {}

    def add(self, seeds, on_progress=None):
        """Renders those of `seeds` that are not there. on_progress: called with the fraction done, from any thread.

        Raises ReferenceError, StageError or native.Error with one sentence; the seeds before stay.
        """
        tell = on_progress or (lambda fraction: None)
        missing = [seed for seed in dict.fromkeys(seeds) if seed not in self._shots]
        covered = self.kind.coverage_pass or bool(self._staying)
        first = covered and not self._unwrapping and self._coverage is None
        steps = len(missing) + first
        for step, seed in enumerate(missing):
            self._shots[seed] = self._take(self.kind, self.samples, seed, _part(tell, step, steps))
        if first:
            covering = _part(tell, len(missing), steps)
            self._coverage = self._take(kinds.COVERAGE, kinds.COVERAGE.samples, 0, covering)

    def result(self):
        """What there is so far: a Reference of at least one seed."""
        taken = [self._shots[seed] for seed in sorted(self._shots)]
        images = [each.pixels for each in taken]
        if self._coverage:
            for image in images:
                image[..., 3] = self._coverage.pixels[..., 3]
        return Reference(
            images=tuple(images),
            seeds=tuple(sorted(self._shots)),
            seconds=sum(each.provenance["seconds"] for each in taken),
            cached=all(each.cached for each in taken),
            provenance=tuple(each.provenance for each in taken),
            notes=self.notes,
        )

    def _take(self, kind, samples, seed, on_progress):
        given = (self._depsgraph, kind, self._size, samples, seed, self._cache, self._overrides, on_progress)
        if kind.name == "photon_scene":
            return photon_scene.take(*given, self._staying)
        return photon.take(*given) if kind.referee else shot.take(*given, self._unwrapping, self._staying)

    def geometry(self):
        """(normal, way to the viewer mirrored at it), each (h, w, 3) float32 in world space, means over the pixel."""
        shots = [self._take(kind, kind.samples, 0, None) for kind in (kinds.NORMAL, kinds.MIRRORED)]
        return tuple(2.0 * each.pixels[..., :3] - 1.0 for each in shots)


def render(depsgraph, kind, size, samples=None, seeds=SEEDS, cache=None, overrides=None, on_progress=None):
    """Renders what `depsgraph` shows with the Cycles materials of a kind of reference; the user's scene stays as it is.

    Returns a Reference of these seeds. The arguments are those of `Sampling` and its `add`.
    """
    sampling = Sampling(depsgraph, kind, size, samples, cache, overrides)
    sampling.add(seeds, on_progress)
    return sampling.result()


def _part(tell, step, steps):
    """The progress of one of several steps, told as that of all."""
    return lambda done: tell((step + done) / steps)


def _check(depsgraph, kind, overrides):
    """(beside.stays, sentences on what Cycles can only approximate). Raises ReferenceError for the first material that
    it cannot render."""
    for instance in depsgraph.object_instances:
        if instance.show_self and instance.object.type == "POINTCLOUD":
            raise ReferenceError(f"Object '{instance.object.name}' is a point cloud, which a reference cannot show: "
                                 "hide it, or put an instance on each of its points.")
    materials = beside.drawn_materials(depsgraph)
    staying = frozenset() if kind.direct else beside.stays(materials)
    notes = [f"Material '{name}' is no grain: it stays what it is, in its mean colour, and its pixels do not count."
             for name in sorted(staying)]
    suns = [instance.object.data.angle for instance in depsgraph.object_instances
            if instance.show_self and export.is_sun(instance.object)]
    if any(angle < kind.least_sun for angle in suns):
        degrees = math.degrees(kind.least_sun)
        notes.append(f"Suns are taken {degrees:.0f} degrees wide on both sides, since Cycles cannot find smaller ones.")
    widest = max(suns, default=0.0)
    if not (kind.referee or nodes.features().even_suns or widest <= WIDEST_SUN):
        raise ReferenceError("This Blender's Cycles renders a sun as a flat disc, which was compared up to "
                             f"{math.degrees(WIDEST_SUN):.0f} degrees; got {math.degrees(widest):.0f}: narrow it.")
    if kind.smooth_interface and not suns:
        raise ReferenceError(f"The reference {kind.name} is measured by the strongest sun, and there is no visible "
                             "sun: add one, or choose another reference.")
    for name, material in sorted((name, each) for name, each in materials.items() if each and name not in staying):
        for limit in limits(shot.grain_values(depsgraph, overrides, material), kind.recipe):
            sentence = f"Material '{name}': {limit.sentence}"
            if limit.fatal:
                raise ReferenceError(sentence)
            notes.append(sentence)
    return staying, tuple(notes)
