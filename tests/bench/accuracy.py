"""How far each model's sphere is from photon Monte Carlo, over materials, indices and radii.

    accuracy.py BUILD_FOLDER [--models M ...] [--taps N ...] [--out FOLDER] [--fresh] [--markdown FILE]

Exitance is what is compared: radiance is rendered from directions all around the sphere and summed over them, so no
exit lobe is assumed. relative_l1 is sum|model - truth|/sum truth over bins of cos(normal, light), total is
sum model/sum truth, dark_ratio the same for cosines below -1/2, noise_floor the truth's own standard error as a
relative_l1. Truth: scattering of every order from one up (tests/data/referee).
thesis_relative_l1 and so on are the same numbers of the thesis' form of the model (thesis_models.py), noise apart.
shade_ms is a frame's shade pass, 64x64 pixels. Writes accuracy.json, accuracy.csv and accuracy.html, prints the means.
"""
import argparse
import csv
import importlib
import json
import pathlib
import sys
import time

import accuracy_page
import numpy
import thesis_models

SIZE = 64
VIEWS = 10
REFEREE = pathlib.Path(__file__).resolve().parents[1] / "data" / "referee" / "sphere.json"


def sphere(native, segments=256, rings=128):
    """A smooth UV sphere of radius 1."""
    theta = numpy.linspace(0.0, numpy.pi, rings + 1)[:, None]
    phi = numpy.linspace(0.0, 2.0 * numpy.pi, segments + 1)[None, :]
    points = numpy.stack(numpy.broadcast_arrays(
        numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi), numpy.cos(theta)), axis=-1)
    points = points.reshape(-1, 3).astype(numpy.float32)
    first = (numpy.arange(rings)[:, None] * (segments + 1) + numpy.arange(segments)[None, :]).ravel()
    below = first + segments + 1
    triangles = numpy.concatenate([numpy.stack(half, axis=-1)
                                   for half in ((first, below, below + 1), (first, below + 1, first + 1))])
    return native.Mesh(points, points, triangles.astype(numpy.uint32))


class Cameras:
    """Orthographic views whose directions integrate over the sphere of directions, the light along +y."""

    def __init__(self, native, views=VIEWS, facing_power=1):
        """`facing_power` above 1 crowds the views towards those that face the light, where a phase function peaks."""
        nodes, weights = numpy.polynomial.legendre.leggauss(views)
        share = 0.5 * (nodes + 1.0)
        nodes, weights = 2.0 * share**facing_power - 1.0, weights * facing_power * share**(facing_power - 1)
        centre = (numpy.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0
        x, y = numpy.meshgrid(centre, -centre)
        inside = x * x + y * y < 1.0
        z = numpy.sqrt(numpy.maximum(0.0, 1.0 - x * x - y * y))
        clip = numpy.diag([1.0, 1.0, -0.5, 1.0])
        self.views = []
        for node, weight in zip(nodes, weights):
            sine = numpy.sqrt(1.0 - node * node)
            rotation = numpy.eye(4)
            rotation[:3, :3] = [[1.0, 0.0, 0.0], [0.0, sine, -node], [0.0, node, sine]]
            cosine = sine * y + node * z  # of normal and light
            # The mean over all directions is half the sum over the nodes; a pixel counts its area, 4 pi times.
            share = 0.5 * weight * 4.0 * numpy.pi * (2.0 / SIZE) ** 2
            self.views.append((native.Camera(rotation, clip), inside, cosine, share))

    def exitance(self, view, samples, bins):
        """(bins, 3) flux per area, per unit irradiance."""
        flux = numpy.zeros((bins, 3))
        for camera, inside, cosine, weight in self.views:
            view.set_camera(camera)
            view.render(samples)
            pixels = view.read()[..., :3].astype(float)
            index = numpy.clip(((cosine + 1.0) * 0.5 * bins).astype(int), 0, bins - 1)
            for channel in range(3):
                flux[:, channel] += weight * numpy.bincount(index.ravel(), pixels[..., channel].ravel(), bins)
        return flux / (4.0 * numpy.pi / bins)


def compare(exitance, truth, noise, cosines):
    dark = cosines < -0.5
    return {"relative_l1": float(numpy.abs(exitance - truth).sum() / truth.sum()),
            "total": float(exitance.sum() / truth.sum()),
            "dark_ratio": float(exitance[dark].sum() / max(truth[dark].sum(), 1e-30)),
            "dark_relative_l1": float(numpy.abs(exitance - truth)[dark].sum() / max(truth[dark].sum(), 1e-30)),
            "noise_floor": float(noise.sum() / truth.sum())}


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

    def save(rows):
        results.write_text(json.dumps({**made_by, "rows": rows}, indent=1))

    known = json.loads(results.read_text()) if results.exists() and not arguments.fresh else {"rows": []}
    rows = run(native, arguments.models, arguments.taps, known["rows"], save)
    device = made_by["device"]
    with open(arguments.out / "accuracy.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    (arguments.out / "accuracy.html").write_text(accuracy_page.render("accuracy.html.j2", rows, device))
    if arguments.markdown:
        arguments.markdown.write_text(accuracy_page.render("accuracy.md.j2", rows, device))
    print("\n".join(summary(rows)))


if __name__ == "__main__":
    main()
