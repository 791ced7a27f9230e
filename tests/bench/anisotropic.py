"""How far each model's sphere is from photon Monte Carlo where scattering is not isotropic.

The same figures as accuracy.py's, without the thesis' forms, which know of g only 1 - g. Radii are in mean free paths,
not in reduced ones. Three albedos are drawn at once, as red, green and blue. Truth: sphere_anisotropic.json.
"""
import json
import pathlib
import sys
import time

import numpy
from sphere_exitance import SIZE, Cameras, compare, sphere

TABLE = pathlib.Path(__file__).resolve().parents[1] / "data" / "referee" / "sphere_anisotropic.json"


class Bench:
    """Everything that all cases share."""

    def __init__(self, native):
        self._native = native
        self.table = json.loads(TABLE.read_text())
        self._bins = self.table["bins"]
        self._cosines = (2.0 * numpy.arange(self._bins) + 1.0) / self._bins - 1.0
        self._mesh = sphere(native)
        self._cameras = {}
        self._view = native.View(SIZE, SIZE)
        self._light = native.DirectionalLight((0.0, 1.0, 0.0), (1.0, 1.0, 1.0))

    def cases(self):
        return [case for case in self.table["cases"] if case["entry"] == "refracted"]

    def _cameras_for(self, g):
        """The more forwards light scatters, the narrower is what leaves a thin grain: 14 views saw 4 % too little of
        it where g is 0.95."""
        views = 40 if g > 0.9 else 14
        return self._cameras.setdefault(views, Cameras(self._native, views=views, facing_power=3))

    def measure(self, case, model, taps):
        """A row for each albedo."""
        albedo = numpy.array(self.table["albedos"])
        made = self._native.Material(sigma_s=tuple(albedo * case["radius"]),
                                     sigma_a=tuple((1.0 - albedo) * case["radius"]), g=case["g"], eta=case["eta"],
                                     model=model, specular=False,
                                     boundary="index_matched" if case["eta"] == 1.0 else "dielectric")
        instance = self._native.Instance(self._mesh, made, numpy.eye(4))
        self._view.set_scene(self._native.Scene(instances=[instance], lights=[self._light]))
        if taps:
            self._view.set_taps(taps)
        exitance = self._cameras_for(case["g"]).exitance(self._view, 1 if taps else 4, self._bins)
        return [{"g": case["g"], "albedo": float(albedo[i]), "eta": case["eta"], "radius": case["radius"],
                 "model": model, "taps": taps,
                 **compare(exitance[:, i], numpy.array(case["scattered"][i]),
                           numpy.array(case["scattered_noise"][i]), self._cosines)}
                for i in range(len(albedo))]


def key(row):
    return row["g"], row["eta"], row["radius"], row["model"], row["taps"]


def run(native, models, taps, known, save):
    """Rows of all cases, model 3 with `taps`; `known` ones are not measured again. `save` gets the rows so far after
    every sphere."""
    bench = Bench(native)
    rows = list(known)
    done = {key(row) for row in rows}
    start = time.monotonic()
    cases = bench.cases()
    for number, case in enumerate(cases):
        for model in models:
            count = taps if model == "model_3" else 0
            if (case["g"], case["eta"], case["radius"], model, count) not in done:
                rows += bench.measure(case, model, count)
        save(rows)
        left = (time.monotonic() - start) / (number + 1) * (len(cases) - number - 1)
        print(f"{number + 1} of {len(cases)} spheres with g, about {left:.0f} s left", file=sys.stderr, flush=True)
    return rows


def by_g(rows):
    """(values of g, [(model, taps, [mean relative_l1 at each g])])."""
    values = sorted({row["g"] for row in rows})
    variants = sorted({(row["model"], row["taps"]) for row in rows})
    means = {(model, taps, g): float(numpy.mean([row["relative_l1"] for row in rows
                                                 if (row["model"], row["taps"], row["g"]) == (model, taps, g)]))
             for model, taps in variants for g in values}
    return values, [(model, taps, [means[model, taps, g] for g in values]) for model, taps in variants]
