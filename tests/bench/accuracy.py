"""How far each model's sphere is from photon Monte Carlo, over materials, indices and radii.

    accuracy.py BUILD_FOLDER [--models M ...] [--taps N ...] [--out FOLDER] [--fresh] [--markdown FILE]

Exitance is what is compared: radiance is rendered from directions all around the sphere and summed over them, so no
exit lobe is assumed. The figures are those of sphere_exitance.compare; truth: scattering of every order from one up
(tests/data/referee). thesis_relative_l1 and so on are the same figures of the thesis' form of the model
(thesis_models.py). shade_ms is a frame's shade pass, 64x64 pixels. The same where scattering is not isotropic follows
(anisotropic.py), with the most samples. Writes accuracy.json, accuracy.csv, anisotropic.csv and accuracy.html, prints
the means.
"""
import argparse
import csv
import importlib
import json
import pathlib
import sys
import time

import accuracy_page
import anisotropic
import numpy
import thesis_models
from sphere_exitance import SIZE, Cameras, compare, sphere

REFEREE = pathlib.Path(__file__).resolve().parents[1] / "data" / "referee" / "sphere.json"


class Thesis:
    """The thesis' form of each model, computed once for each albedo."""

    def __init__(self, cosines):
        self._cosines = cosines
        self._known = {}

    def exitance(self, model, albedos, radius, eta):
        """(bins, 3) for three albedos."""
        columns = []
        for albedo in albedos:
            key = model, round(float(albedo), 12), radius, eta
            if key not in self._known:
                self._known[key] = thesis_models.MODELS[model](self._cosines, float(albedo), radius, eta)
            columns.append(self._known[key])
        return numpy.stack(columns, axis=-1)


class Bench:
    """Everything that all cases share."""

    def __init__(self, native, table):
        self._native = native
        self._table = table
        self._bins = table["bins"]
        self._cosines = (2.0 * numpy.arange(self._bins) + 1.0) / self._bins - 1.0
        self._mesh = sphere(native)
        self._cameras = Cameras(native)
        self._view = native.View(SIZE, SIZE)
        self._light = native.DirectionalLight((0.0, 1.0, 0.0), (1.0, 1.0, 1.0))
        self._thesis = Thesis(self._cosines)

    def measure(self, case, material, model, taps):
        """One row of the table."""
        albedo = numpy.array([self._table["albedos"][index] for index in material["albedo_index"]])
        truth = numpy.array([case["scattered"][index] for index in material["albedo_index"]]).T
        noise = numpy.array([case["scattered_noise"][index] for index in material["albedo_index"]]).T
        printed = compare(self._thesis.exitance(model, albedo, case["radius"], case["eta"]), truth, noise,
                          self._cosines)
        # sigma_t is the radius in mean free paths: every channel has its own albedo at the same radius.
        made = self._native.Material(sigma_s=tuple(albedo * case["radius"]),
                                     sigma_a=tuple((1.0 - albedo) * case["radius"]), eta=case["eta"], model=model,
                                     boundary="index_matched" if case["eta"] == 1.0 else "dielectric")
        self._view.set_scene(self._native.Scene(
            instances=[self._native.Instance(self._mesh, made, numpy.eye(4))], lights=[self._light]))
        if taps:
            self._view.set_taps(taps)
        exitance = self._cameras.exitance(self._view, 1 if taps else 4, self._bins)
        milliseconds = {entry["pass"]: entry["milliseconds"] for entry in self._view.timings()}["shade"]
        return {"material": material["name"], "eta": case["eta"], "radius": case["radius"], "model": model,
                "taps": taps, "shade_ms": milliseconds, **compare(exitance, truth, noise, self._cosines),
                **{f"thesis_{name}": printed[name]
                   for name in ("relative_l1", "total", "dark_ratio", "dark_relative_l1")}}


def key(row):
    return row["material"], row["eta"], row["radius"], row["model"], row["taps"]


def run(native, models, taps, known, save):
    """Rows of all cases; `known` ones are not measured again. `save` gets the rows so far after every sphere."""
    table = json.loads(REFEREE.read_text())
    bench = Bench(native, table)
    rows = {key(row): row for row in known}
    cases = [case for case in table["cases"] if case["entry"] == "refracted"]
    start = time.monotonic()
    for number, case in enumerate(cases):
        for material in table["materials"]:
            for model in models:
                for count in (taps if model == "model_3" else (0,)):
                    if (material["name"], case["eta"], case["radius"], model, count) not in rows:
                        row = bench.measure(case, material, model, count)
                        rows[key(row)] = row
        save(list(rows.values()))
        left = (time.monotonic() - start) / (number + 1) * (len(cases) - number - 1)
        print(f"{number + 1} of {len(cases)} spheres, about {left:.0f} s left", file=sys.stderr, flush=True)
    return list(rows.values())


def summary(rows):
    """Lines: mean relative_l1 by radius, one line for each model and number of taps."""
    radii = sorted({row["radius"] for row in rows})
    yield "relative L1 in %, mean over materials and eta; columns: radius in mean free paths, then all"
    yield f"{'':18}" + "".join(f"{radius:9g}" for radius in radii) + "      all"
    for model, taps in sorted({(row["model"], row["taps"]) for row in rows}):
        chosen = [row for row in rows if (row["model"], row["taps"]) == (model, taps)]
        means = [numpy.mean([row["relative_l1"] for row in chosen if row["radius"] == radius]) for radius in radii]
        means.append(numpy.mean([row["relative_l1"] for row in chosen]))
        yield f"{model + (f' N={taps}' if taps else ''):18}" + "".join(f"{100.0 * mean:9.2f}" for mean in means)


def write_csv(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0] if rows else ())
        writer.writeheader()
        writer.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--models", nargs="+", default=["model_1", "model_2", "model_3"])
    parser.add_argument("--taps", nargs="+", type=int, default=[16, 64])
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("accuracy"))
    parser.add_argument("--fresh", action="store_true", help="measure again what OUT holds from a broken-off run")
    parser.add_argument("--markdown", type=pathlib.Path, help="also writes the summary there")
    arguments = parser.parse_args()
    sys.path.insert(0, str(arguments.build))
    native = importlib.import_module("mesograin_native")
    arguments.out.mkdir(parents=True, exist_ok=True)
    results = arguments.out / "accuracy.json"
    made_by = {"about": __doc__, "device": native.device_info()["renderer"], "version": native.__version__}

    known = json.loads(results.read_text()) if results.exists() and not arguments.fresh else {}
    # Another version's rows hold other figures.
    known = known if known.get("about") == __doc__ else {}
    found = {"rows": known.get("rows", []), "anisotropic": known.get("anisotropic", [])}

    def save(name):
        def keep(rows):
            found[name] = rows
            results.write_text(json.dumps({**made_by, **found}, indent=1))
        return keep

    rows = run(native, arguments.models, arguments.taps, found["rows"], save("rows"))
    anisotropic_rows = anisotropic.run(native, [model for model in arguments.models if model != "model_1"],
                                       max(arguments.taps), found["anisotropic"], save("anisotropic"))
    device = made_by["device"]
    write_csv(arguments.out / "accuracy.csv", rows)
    write_csv(arguments.out / "anisotropic.csv", anisotropic_rows)
    given = rows, anisotropic.by_g(anisotropic_rows), device
    (arguments.out / "accuracy.html").write_text(accuracy_page.render("accuracy.html.j2", *given))
    if arguments.markdown:
        arguments.markdown.write_text(accuracy_page.render("accuracy.md.j2", *given))
    print("\n".join(summary(rows)))


if __name__ == "__main__":
    main()
