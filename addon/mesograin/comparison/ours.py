# Our side of a case: the scene with a model and a boundary of the comparison's choosing, rendered and timed.
"""See `Ours`. The user's properties are read, never written."""

import dataclasses
import statistics

from .. import export, meshes, native_module


SEEDS = 4
"""Our picture is the mean of this many parts of independent noise, whose spread tells how far it is sampled out."""


class Ours:
    """One evaluated scene and views of it, ready for any number of models.

    depsgraph: evaluated. size: (width, height) in pixels. overrides: {parameter: value} for every material,
    coefficients per scene unit. Raises native.Error with a sentence if the scene has no camera or cannot be drawn.
    """

    def __init__(self, depsgraph, size, overrides):
        native = native_module.get()
        self._overrides = overrides
        self._scene = export.read_scene(depsgraph, meshes.MeshCache())
        self._views = [native.View(*size, seed=seed) for seed in range(SEEDS)]
        self._camera = export.camera_from_scene(depsgraph, *size)
        self.warnings = self._scene.warnings

    def parameters(self, chosen):
        """{material name: {parameter: value}} as a case renders them. chosen: {parameter: value} of the case."""
        return {
            instance.material.name: {**dict(instance.material.values), **self._overrides, **chosen}
            for instance in self._scene.instances
        }

    @staticmethod
    def samples(samples):
        """How many samples a pixel `render` really takes: so many that all parts have as many."""
        parts = min(SEEDS, samples)
        return -(-samples // parts) * parts

    def suns(self, least_sun=0.0):
        """[(direction to the light, full angle in radians, irradiance)] as `render` takes them, the strongest first."""
        lights = sorted(self._lights(least_sun), key=lambda light: -sum(light.irradiance))
        return [(light.direction_to_light, light.angle, light.irradiance) for light in lights]

    def _lights(self, least_sun):
        return tuple(
            dataclasses.replace(light, angle=max(light.angle, least_sun)) for light in self._scene.lights
        )

    def render(self, chosen, samples, least_sun=0.0):
        """The scene with the case's choice of parameters, as parts of independent noise whose mean is the picture:
        a list of (h, w, 4) float32. samples: of each pixel, over all parts. least_sun: radians; narrower suns are
        widened to this."""
        parameters = self.parameters(chosen)
        instances = tuple(
            dataclasses.replace(
                instance,
                material=export.MaterialValues(
                    instance.material.name, tuple(parameters[instance.material.name].items())
                ),
            )
            for instance in self._scene.instances
        )
        scene = dataclasses.replace(self._scene, instances=instances, lights=self._lights(least_sun)).to_native()
        views = self._views[: min(SEEDS, samples)]
        parts = []
        for view in views:
            view.set_scene(scene)
            view.set_camera(self._camera)
            view.render(self.samples(samples) // len(views))
            parts.append(view.read())
        return parts

    def time_frames(self, frames):
        """(median milliseconds of a frame, [(pass, median milliseconds)]): one sample of what was rendered last."""
        totals, passes = [], {}
        view = self._views[0]
        for _ in range(frames):
            view.set_camera(self._camera)
            view.render(1)
            timings = view.timings()
            totals.append(sum(timing["milliseconds"] for timing in timings))
            for timing in timings:
                passes.setdefault(timing["pass"], []).append(timing["milliseconds"])
        return statistics.median(totals), [(name, statistics.median(times)) for name, times in passes.items()]
