# Our side of a trade curve: one picture that is refined sample by sample, and the time of a frame.
"""See `Progressive`. The user's properties are read, never written."""

import dataclasses
import statistics

from .. import export, meshes, native_module


class Progressive:
    """One evaluated scene and a view of it, ready for any number of settings.

    depsgraph: evaluated. size: (width, height) in pixels. overrides: {parameter: value} for every material,
    coefficients per scene unit. Raises native.Error with a sentence if the scene has no camera or cannot be drawn.
    """

    def __init__(self, depsgraph, size, overrides):
        native = native_module.get()
        self._overrides = overrides
        self._scene = export.read_scene(depsgraph, meshes.MeshCache())
        self._view = native.View(*size)
        self._camera = export.camera_from_scene(depsgraph, *size)
        self.warnings = self._scene.warnings

    def parameters(self, chosen):
        """{material name: {parameter: value}} as they are rendered. chosen: {parameter: value}."""
        return {
            instance.material.name: {**dict(instance.material.values), **self._overrides, **chosen}
            for instance in self._scene.instances
        }

    def begin(self, chosen, taps=None):
        """Starts a picture without samples. taps: of model 3, for each sample."""
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
        if taps:
            self._view.set_taps(taps)
        self._view.set_scene(dataclasses.replace(self._scene, instances=instances).to_native())
        self._view.set_camera(self._camera)

    def refine(self, samples):
        """The picture with so many samples a pixel in all, (h, w, 4) float32."""
        self._view.render(samples - self._view.samples)
        return self._view.read()

    def time_frames(self, frames):
        """(median milliseconds of a frame of one sample, {pass: median milliseconds}), the light maps being there."""
        totals, passes = [], {}
        for _ in range(frames):
            self._view.set_camera(self._camera)
            self._view.render(1)
            timings = self._view.timings()
            totals.append(sum(timing["milliseconds"] for timing in timings))
            for timing in timings:
                passes.setdefault(timing["pass"], []).append(timing["milliseconds"])
        return statistics.median(totals), {name: statistics.median(times) for name, times in passes.items()}
