# Our side of a case: the scene with a model and a boundary of the comparison's choosing, rendered and timed.
"""See `Ours`. The user's properties are read, never written."""

import dataclasses
import statistics
import time

from ... import native_module
from ...cycles import beside, kinds
from ...engine import stated_error
from ...scene import export, lights, meshes
from ...schema import models


LOOKS_EVERY = 0.002
"""Seconds from one look for news of light to the next."""

SHOWN_BEFORE = 40
"""Samples of a picture after which a viewport knows the light in its grains."""

SEEDS = 4
"""Our picture is the mean of this many parts of independent noise, whose spread tells how far it is sampled out."""


class Ours:
    """One evaluated scene and views of it, ready for any number of models.

    depsgraph: evaluated. size: (width, height) in pixels. overrides: {parameter: value} for every material,
    coefficients per scene unit. parts: of independent noise that a picture consists of, at most. exchange: of the
    schema's choices, or None for the scene's own.
    Raises native.Error with a sentence if the scene has no camera or cannot be drawn.
    """

    def __init__(self, depsgraph, size, overrides, parts=SEEDS, exchange=None):
        native = native_module.get()
        self._overrides = overrides
        self._staying = beside.stays(beside.drawn_materials(depsgraph))
        scene = export.read_scene(depsgraph, meshes.MeshCache(), varied=False)
        if exchange:
            scene = dataclasses.replace(scene, exchange=exchange)
        # What is behind the grains is no part of a comparison: Cycles' film is transparent, too.
        self._scene = dataclasses.replace(scene, world=scene.world.before_film())
        self._views = self._all_views = [native.View(*size, seed=seed) for seed in range(parts)]
        self._size, self._camera = size, export.camera_from_scene(depsgraph, *size, sharp=True)
        self.warnings = scene.warnings

    def parameters(self, chosen, direct=False):
        """{material name: {parameter: value}} as a case renders them; where objects of a material are given several
        models, it has all their names. chosen, direct: as `begin` takes them."""
        found = {}
        scene = self._with(chosen, direct)
        for material in scene.with_models_chosen().materials:
            values = dict(material.values)
            known = found.setdefault(material.name, values)
            if values["model"] not in known["model"].split(", "):
                known["model"] += f", {values['model']}"
        return found

    def replaced(self, name, chosen):
        """The values of a parameter in whose place, in materials of grains, the case's own choice is drawn."""
        known = [{**dict(material.values), **self._overrides} for material in self._scene.materials
                 if material.name not in self._staying]
        own = [values[name] for values in known if models.CHOICES[values["model"]].translucent]
        return sorted(set(own) - {chosen[name]}) if name in chosen else []

    def _with(self, chosen, direct):
        """What is no grain stays what it is beside grains, in its mean colour, as on the other side; under direct light
        alone it is what the kind of reference asks of everything."""

        def change(material):
            if not direct and material.name in self._staying:
                return material
            values = {**dict(material.values), **self._overrides}
            values.update(kinds.of_material(chosen, values))
            return export.MaterialValues(material.name, tuple(values.items()))

        return self._scene.with_materials(change)

    @property
    def samples(self):
        """How many samples a pixel there are, over all parts."""
        return sum(view.samples for view in self._views)

    def suns(self, least_sun=0.0):
        """[(direction to the light, full angle in radians, irradiance)] as `begin` takes them, the strongest first."""
        suns = [light for light in self._lights(least_sun) if isinstance(light, lights.SunValues)]
        strongest = sorted(suns, key=lambda light: -sum(light.irradiance))
        return [(light.direction_to_light, light.angle, light.irradiance) for light in strongest]

    def _lights(self, least_sun):
        return tuple(
            dataclasses.replace(light, angle=max(light.angle, least_sun)) if isinstance(light, lights.SunValues)
            else light for light in self._scene.lights
        )

    def _lit(self, chosen, least_sun, direct):
        return dataclasses.replace(self._with(chosen, direct), lights=self._lights(least_sun),
                                   exchange="off" if direct else self._scene.exchange)

    def from_nothing(self, chosen, least_sun=0.0, taps=None):
        """(milliseconds, (h, w, 4) float32) of the first picture with light between grains in it, of one sample, as a
        viewport shows it that has just been opened: nothing of that light is known, and what is found first is refined
        later. None where no light goes between grains. Arguments as `begin` has them, which must follow."""
        nothing = dataclasses.replace(self._scene, instances=(), heaps=()).to_native()
        for view in self._all_views:
            view.set_scene(nothing)  # so that none holds what another model had found
        scene = self._lit(chosen, least_sun, False)
        started = time.perf_counter()
        view = native_module.get().View(*self._size, patient=False)
        if taps:
            view.set_taps(taps)
        view.set_scene(scene.to_native())
        view.set_camera(self._camera)
        view.render(1)
        while (exchange := view.statistics()["exchange"]) and not exchange["milliseconds"]:
            awaited = view.awaited
            if view.take_news():
                view.render(1)
            elif awaited:
                time.sleep(LOOKS_EVERY)
            else:
                return None  # it could not be found, which a patient view will say
        return exchange and (1000.0 * (time.perf_counter() - started), view.read())

    def once_solved(self, frames, chosen, least_sun=0.0, taps=None):
        """(median milliseconds of so many, (h, w, 4) float32 of the last) pictures of one sample that a viewport shows,
        light between grains being solved. None where no light goes between grains. Other arguments as `begin` has
        them."""
        return self._shown_before(1, frames, chosen, least_sun, taps)

    def in_known_light(self, frames, chosen, least_sun=0.0, taps=None):
        """The same of a viewport that has shown SHOWN_BEFORE samples before, so that it knows the light in grains,
        too."""
        return self._shown_before(SHOWN_BEFORE, frames, chosen, least_sun, taps)

    def _shown_before(self, samples, frames, chosen, least_sun, taps):
        view = native_module.get().View(*self._size, patient=False)
        if taps:
            view.set_taps(taps)
        view.set_scene(self._lit(chosen, least_sun, False).to_native())
        view.set_camera(self._camera)
        view.render(1)
        while view.preparing is not None:
            time.sleep(LOOKS_EVERY)
        view.take_news()
        view.render(samples)
        if not view.statistics()["exchange"]:
            return None
        milliseconds, _ = self._time_frames(view, frames)
        return milliseconds, view.read()

    def begin(self, chosen, least_sun=0.0, taps=None, direct=False):
        """Starts a picture without samples. chosen: the case's choice of parameters. least_sun: radians; narrower suns
        are widened to this. taps: of model 3, for each sample; None as they were. direct: without light between
        grains."""
        scene = self._lit(chosen, least_sun, direct).to_native()
        self._views = self._all_views
        for view in self._views:
            if taps:
                view.set_taps(taps)
            view.set_scene(scene)
            view.set_camera(self._camera)

    def refine(self, samples):
        """The picture with at least so many samples a pixel in all, as parts of independent noise, as many samples in
        each, whose mean it is: a list of (h, w, 4) float32."""
        self._views = self._all_views[:samples]
        share = -(-samples // len(self._views))
        for view in self._views:
            view.render(share - view.samples)
        return [view.read() for view in self._views]

    @property
    def exchange(self):
        """Of the schema's choices, as asked for."""
        return self._scene.exchange

    @property
    def exchanged(self):
        """What native.View.statistics says of light between grains in the last picture, and its stated error; None
        where there is none."""
        counts = self._views[0].statistics()["exchange"]
        return counts and {**counts, "stated_error": stated_error.sentence(counts)}

    @property
    def drawn_otherwise(self):
        """One sentence for each thing in the last picture that the model asked for did not draw."""
        return self._views[0].warnings

    def time_frames(self, frames):
        """(median milliseconds of a frame of one sample, {pass: median milliseconds}), the light maps being there."""
        return self._time_frames(self._views[0], frames)

    def _time_frames(self, view, frames):
        totals, passes = [], {}
        for _ in range(frames):
            view.set_camera(self._camera)
            view.render(1)
            timings = view.timings()
            totals.append(sum(timing["milliseconds"] for timing in timings))
            for timing in timings:
                passes.setdefault(timing["pass"], []).append(timing["milliseconds"])
        return statistics.median(totals), {name: statistics.median(times) for name, times in passes.items()}

    def time_further(self, samples):
        """Median milliseconds of so many samples that refine the picture of one that `time_frames` has left: a first
        one takes cheaper ways."""
        view = self._views[0]
        totals = []
        for _ in range(samples):
            view.render(1)
            totals.append(sum(timing["milliseconds"] for timing in view.timings()))
        return statistics.median(totals)
