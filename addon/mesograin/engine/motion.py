# Motion blur: the moments of an exposure, when the scene is looked at and how many samples each has.
"""See `Exposure`."""
import dataclasses
import itertools
import math
import typing

import numpy as np

from .. import compat
from ..scene import export, meshes

MOST_MOMENTS = 64
"""In a frame: each is an evaluation of the scene. What moves by more pixels than there are moments is seen in steps."""
GOLDEN_RATIO = (math.sqrt(5.0) - 1.0) / 2.0
CURVE_STEPS = 256


class Moment(typing.NamedTuple):
    """time: in frames from the frame's own. samples: that see the scene so."""

    time: float
    samples: int


class Exposure:
    """What a final render looks at. values: export.SceneValues of the frame. blurred: whether anything may move."""

    def __init__(self, engine, depsgraph):
        self._engine, self._scene = engine, depsgraph.scene
        self.blurred = (self._scene.render.use_motion_blur
                        and getattr(depsgraph.view_layer, "use_motion_blur", True))
        self.values, self._read_again = export.read_scene_in_motion(depsgraph, meshes.MeshCache())
        self._materials = {}

    def native_scene(self, values):
        """The native.Scene of these values; a material is made once for all moments."""
        return values.to_native(self._materials)

    def moments(self, read_camera, samples):
        """Yields (export.SceneValues, native.Camera, how many samples see them so), of all samples together. While it
        does, Blender's frame is the moment's. The values are those of before, the very same, if nothing has moved."""
        if not self.blurred:
            yield self.values, read_camera(), samples
            return
        frame, subframe = self._scene.frame_current, self._scene.frame_subframe
        last = self.values
        try:
            for moment in moments(self._scene, samples):
                at = frame + subframe + moment.time
                self._engine.frame_set(math.floor(at), at - math.floor(at))
                now = moved(self.values, self._read_again())
                last = last if now == last else now
                yield last, read_camera(), moment.samples
        finally:
            self._engine.frame_set(frame, subframe)


def moments(scene, samples):
    """[Moment] of an exposure of so many samples, as the scene's shutter asks for it. Times are stratified, each as
    likely as the shutter is open then, and come in an order in which the first few are spread already."""
    count = min(samples, MOST_MOMENTS)
    ends = np.arange(count + 1) * samples // count
    shares = 0.5 * (ends[1:] + ends[:-1]) / samples
    owner = compat.owner_of_motion_blur_position(scene)
    opened = {"START": 0.0, "CENTER": -0.5, "END": -1.0}[owner.motion_blur_position if owner else "CENTER"]
    times = scene.render.motion_blur_shutter * (opened + _quantiles(scene.render.motion_blur_shutter_curve, shares))
    # Ranks of the golden ratio's multiples: neighbours in time are far apart in the order, and it is unlike those of
    # the sequences that samples take within pixels, lenses and lights.
    order = np.argsort(np.argsort(np.arange(count) * GOLDEN_RATIO % 1.0))
    return [Moment(float(times[number]), int(ends[number + 1] - ends[number])) for number in order]


def _quantiles(curve, shares):
    """When, of 0 to 1, so large shares of the light have come in. curve: how far the shutter is open."""
    curve.initialize()
    places = (np.arange(CURVE_STEPS) + 0.5) / CURVE_STEPS
    openness = np.array([max(curve.evaluate(curve.curves[0], float(place)), 0.0) for place in places])
    total = np.concatenate(([0.0], np.cumsum(openness)))
    if not total[-1] > 0.0:
        return shares
    return np.interp(shares, total / total[-1], np.linspace(0.0, 1.0, CURVE_STEPS + 1))


def moved(values, now):
    """export.SceneValues `values` with the transforms of `now`, the same scene at another time. What has no counterpart
    there, as it comes or goes within the exposure, stays; so do shapes, materials and lights."""
    return dataclasses.replace(
        values,
        instances=_moved(values.instances, now.instances, lambda thing, other: dataclasses.replace(
            thing, object_to_world=other.object_to_world)),
        heaps=_moved(values.heaps, now.heaps, lambda heap, other: dataclasses.replace(
            heap, placings=other.placings) if len(heap) == len(other) else heap))


def _moved(things, others, place):
    """Things take the place of those that have their name, one after the other; if there are as many."""
    by_name, numbers = {}, {}
    for other in others:
        by_name.setdefault(other.name, []).append(other)
    counts = {name: len(list(group)) for name, group in itertools.groupby(sorted(thing.name for thing in things))}
    found = []
    for thing in things:
        number = numbers.setdefault(thing.name, 0)
        numbers[thing.name] += 1
        counterparts = by_name.get(thing.name, [])
        found.append(place(thing, counterparts[number]) if len(counterparts) == counts[thing.name] else thing)
    return tuple(found)
