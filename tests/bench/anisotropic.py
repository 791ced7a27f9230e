"""How far each model's sphere is from photon Monte Carlo where scattering is not isotropic.

    anisotropic.py BUILD_FOLDER [--models M ...] [--taps N ...] [--g G ...] [--every]

The same figures as accuracy.py's, without the thesis' forms, which know of g only 1 - g. Radii are in mean free paths,
not in reduced ones. Three albedos are drawn at once, as red, green and blue. Truth: sphere_anisotropic.json.
"""
import argparse
import importlib
import json
import pathlib
import sys

import accuracy
import numpy

TABLE = accuracy.REFEREE.with_name("sphere_anisotropic.json")


class Bench:
    """Everything that all cases share."""

    def __init__(self, native):
        self._native = native
        self.table = json.loads(TABLE.read_text())
        self._bins = self.table["bins"]
        self._cosines = (2.0 * numpy.arange(self._bins) + 1.0) / self._bins - 1.0
        self._mesh = accuracy.sphere(native)
        self._cameras = accuracy.Cameras(native, views=14, facing_power=3)
        self._view = native.View(accuracy.SIZE, accuracy.SIZE)
        self._light = native.DirectionalLight((0.0, 1.0, 0.0), (1.0, 1.0, 1.0))

    def cases(self):
        return [case for case in self.table["cases"] if case["entry"] == "refracted"]

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
        exitance = self._cameras.exitance(self._view, 1 if taps else 4, self._bins)
        return [{"g": case["g"], "albedo": float(albedo[i]), "eta": case["eta"], "radius": case["radius"],
                 "model": model, "taps": taps,
                 **accuracy.compare(exitance[:, i], numpy.array(case["scattered"][i]),
                                    numpy.array(case["scattered_noise"][i]), self._cosines)}
                for i in range(len(albedo))]


def run(native, models, taps, wanted=None):
    """Rows of all cases, or of those whose g is wanted."""
    bench = Bench(native)
    return [row for case in bench.cases() if wanted is None or case["g"] in wanted
            for model in models for count in (taps if model == "model_3" else (0,))
            for row in bench.measure(case, model, count)]


def by_g(rows):
    """[(g, name of the model, [mean relative_l1 at each radius, then all])], after the radii."""
    radii = sorted({row["radius"] for row in rows})
    lines = []
    for g, model, taps in sorted({(row["g"], row["model"], row["taps"]) for row in rows}):
        chosen = [row for row in rows if (row["g"], row["model"], row["taps"]) == (g, model, taps)]
        groups = [[row for row in chosen if row["radius"] == radius] for radius in radii] + [chosen]
        lines.append((g, model + (f" N={taps}" if taps else ""),
                      [float(numpy.mean([row["relative_l1"] for row in group])) for group in groups]))
    return radii, lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--models", nargs="+", default=["model_2", "model_3"])
    parser.add_argument("--taps", nargs="+", type=int, default=[64])
    parser.add_argument("--g", nargs="+", type=float)
    parser.add_argument("--every", action="store_true", help="print every case as well")
    arguments = parser.parse_args()
    sys.path.insert(0, str(arguments.build))
    rows = run(importlib.import_module("mesograin_native"), arguments.models, arguments.taps, arguments.g)
    if arguments.every:
        for row in rows:
            print(f"g {row['g']:5g} eta {row['eta']:3g} radius {row['radius']:4g} albedo {row['albedo']:5g} "
                  f"{row['model']} L1 {100 * row['relative_l1']:6.1f} total {row['total']:.3f} "
                  f"dark {row['dark_ratio']:.3f} noise {100 * row['noise_floor']:.1f}")
    radii, lines = by_g(rows)
    print(f"{'':24}" + "".join(f"{radius:9g}" for radius in radii) + "      all")
    for g, name, means in lines:
        print(f"{g:5g} {name:18}" + "".join(f"{100.0 * mean:9.2f}" for mean in means))


if __name__ == "__main__":
    main()
