"""What heaps of grains cost: milliseconds a sample, as ratios to a Lambert sphere that fills the same picture.

    heap.py BUILD_FOLDER [--grains N ...] [--samples N] [--shapes sphere ...] [--models lambert ...] [--size W H]
        [--visibility V] [--json FILE]

The picture has 960x540 pixels unless told, and the heap fills it; one sun, which casts shadows, and no light between
grains, which exchange.py measures. Each heap is measured in a process of its own. Its peak memory is told, in which
this program's own arrays count and a second scene while a material changes, and what is held once the picture is there
and those are gone; so is the first picture after a material has changed, in samples, and a frame of one sample while
the camera moves with each.
"""
import argparse
import json
import math
import pathlib
import resource
import statistics
import subprocess
import sys
import time

import numpy

from frame import sphere

SIZE = (960, 540)
SUN = ((1.0, 0.4, 1.2), (3.0,) * 3)
PARAMETERS = {"sigma_a": (0.05,) * 3, "sigma_s": (2.0,) * 3, "eta": 1.3, "roughness": 0.3,
              "reflectance": (0.6, 0.5, 0.4)}
MODELS_AT = 100_000
# The most that is asked for: ratios of Lambert's heaps by grains, of models' to Lambert's, of a slider's first picture
# to a frame; megabytes of a heap of a million; bytes held for a grain that is one more.
BARS = {"ratio": {10_000: 8.0, 100_000: 20.0, 1_000_000: 80.0}, "model": {"model_2": 3.0, "model_3": 6.0},
        "slider": 1.5, "megabytes": 1536.0, "bytes": 300.0}
GRAINS = [1_000, 10_000, 100_000, 1_000_000]


def shapes(native):
    """{name: native.Mesh}, of about radius 1."""
    positions, normals, triangles = sphere()
    unit = normals.astype(numpy.float64)
    x, y, z = unit.T
    bumps = 1.0 + 0.15 * numpy.sin(4.0 * x + 1.0) * numpy.cos(5.0 * y - 3.0 * z)
    irregular = (unit * bumps[:, None] * (1.0, 0.9, 0.75)).astype(numpy.float32)
    return {"sphere": native.Mesh(normals, normals, triangles), "irregular": native.Mesh(irregular, None, triangles)}


def places(count):
    """(n, 4, 4) transforms of a heap half as high as it is wide, turned at random, and how wide it is."""
    random = numpy.random.default_rng(1)
    side = math.ceil((2.0 * count) ** (1.0 / 3.0))
    number = numpy.arange(count)
    layer, row, column = number // side ** 2, number // side % side, number % side
    place = numpy.stack((column + 0.5 * (layer % 2), row + 0.5 * (layer % 2), 0.72 * layer), axis=-1) * 1.9
    place += random.uniform(0.0, 0.3, place.shape)
    place -= (0.95 * side, 0.95 * side, 1.9 * 0.72 * count / side ** 2)
    place[:, 2] += 1.2 * numpy.sin(0.5 * place[:, 0])
    turn = random.normal(size=(count, 4))
    w, x, y, z = (turn / numpy.linalg.norm(turn, axis=1, keepdims=True)).T
    rotation = numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    result = numpy.zeros((count, 4, 4), dtype=numpy.float32)
    result[:, :3, :3] = rotation.transpose(2, 0, 1) * random.uniform(0.8, 1.2, (count, 1, 1))
    result[:, :3, 3] = place
    result[:, 3, 3] = 1.0
    return result, 1.9 * side


def milliseconds(view, samples):
    """The median time of a sample."""
    times = []
    for _ in range(samples):
        start = time.perf_counter()
        view.render(1)
        times.append((time.perf_counter() - start) * 1e3)
    return statistics.median(times)


def make_view(native, size, visibility):
    view = native.View(*size, patient=False)
    view.set_visibility(visibility)
    return view


def sphere_view(native, size, visibility):
    """A Lambert sphere that covers all of the picture."""
    view = make_view(native, size, visibility)
    mesh = shapes(native)["sphere"]
    grain = native.Instance(mesh, native.Material(model="lambert", **PARAMETERS), numpy.eye(4))
    view.set_scene(native.Scene(instances=[grain], lights=[native.DirectionalLight(*SUN)]))
    view.set_camera(native.Camera.look_at((0.0, 0.0, 8.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 7.0, size[0] / size[1]))
    return view


def measure(native, shape, model, count, samples, size, visibility):
    """What one heap costs, as a dictionary."""
    reference = sphere_view(native, size, visibility)
    reference.render(3)
    transforms, width = places(count)
    view = make_view(native, size, visibility)
    material = native.Material(model=model, **PARAMETERS)
    heap = native.InstanceArray(shapes(native)[shape], material, transforms)
    del transforms

    def scene(**changes):
        changed = heap.with_material(native.Material(model=model, **{**PARAMETERS, **changes}))
        return native.Scene(arrays=[changed], lights=[native.DirectionalLight(*SUN)], exchange="off")

    def look_from(eye):
        return native.Camera.look_at(eye, (0.0, 0.0, -0.15 * width), (0.0, 0.0, 1.0), 18.0, size[0] / size[1])

    eye = (0.0, -0.6 * width, 1.05 * width)
    view.set_camera(look_from(eye))
    start = time.perf_counter()
    view.set_scene(scene())
    view.render(1)
    first = (time.perf_counter() - start) * 1e3
    view.render(1)
    alone, times, after = [], [], []
    for _ in range(samples):  # in turns, so that whatever else the machine does slows both
        alone.append(milliseconds(reference, 3))
        times.append(milliseconds(view, 1))
    for number in range(3):
        changed = scene(sigma_a=(0.06 + 0.001 * number,) * 3, reflectance=(0.5 + 0.01 * number,) * 3)
        start = time.perf_counter()
        view.set_scene(changed)
        view.render(1)
        after.append((time.perf_counter() - start) * 1e3)
    view.render(1)
    pixels = view.read()
    orbit = []
    for number in range(4 * samples):
        angle = math.radians(number + 1)
        turned = (math.sin(angle) * 0.6 * width, -math.cos(angle) * 0.6 * width, eye[2])
        start = time.perf_counter()
        view.set_camera(look_from(turned))
        view.render(1)
        orbit.append((time.perf_counter() - start) * 1e3)
    sample = statistics.median(times)
    return {"shape": shape, "model": model, "grains": count, "sphere_milliseconds": statistics.median(alone),
            "milliseconds": sample, "ratio": sample / statistics.median(alone), "first_milliseconds": first,
            "orbit_milliseconds": statistics.median(orbit), "after_a_slider": statistics.median(after) / sample,
            "coverage": float(pixels[..., 3].mean()),
            "passes": {entry["pass"]: entry["milliseconds"] for entry in view.timings()},
            "held_megabytes": held_megabytes(),
            "peak_megabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
            "device": native.device_info()["renderer"]}


def held_megabytes():
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 2.0 ** 20


def run_apart(options, shape, model, count):
    """measure(), in a process of its own."""
    words = [sys.executable, __file__, options.build, "--one", shape, model, str(count),
             "--samples", str(options.samples), "--visibility", options.visibility,
             "--size", *map(str, options.size)]
    return json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True).stdout)


def show(case):
    passes = ", ".join(f"{name} {milliseconds:.1f}" for name, milliseconds in case["passes"].items())
    print(f"{case['shape']:<10}{case['model']:<9}{case['grains']:>9}{case['milliseconds']:>9.1f}{case['ratio']:>8.1f}"
          f"{case['after_a_slider']:>8.2f}{case['orbit_milliseconds']:>9.1f}{case['first_milliseconds']:>9.0f}"
          f"{case['held_megabytes']:>7.0f}{case['peak_megabytes']:>7.0f}  {passes}",
          flush=True)


def judged(what, value, most):
    return f"{what}: {value:.2f}, at most {most:g}: {'met' if value <= most else 'missed'}"


def bars(of):
    """Sentences on what is asked for. of: {(shape, model, grains): case}."""
    for (shape, model, count), case in of.items():
        name = f"{shape}, {model}, {count} grains"
        if model == "lambert" and count in BARS["ratio"]:
            yield judged(f"{name}: samples of one sphere", case["ratio"], BARS["ratio"][count])
        if model in BARS["model"] and (shape, "lambert", count) in of:
            yield judged(f"{name}: times lambert's", case["ratio"] / of[shape, "lambert", count]["ratio"],
                         BARS["model"][model])
        if count == MODELS_AT:
            yield judged(f"{name}: frames from a slider to its picture", case["after_a_slider"], BARS["slider"])
        if count == 1_000_000:
            yield judged(f"{name}: peak megabytes, this program's own arrays among them", case["peak_megabytes"],
                         BARS["megabytes"])
            if (shape, model, MODELS_AT) in of:
                more = case["held_megabytes"] - of[shape, model, MODELS_AT]["held_megabytes"]
                yield judged(f"{name}: bytes held for each grain more than {MODELS_AT}",
                             more * 2.0 ** 20 / (count - MODELS_AT), BARS["bytes"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the folder of the native module")
    parser.add_argument("--grains", type=int, nargs="+", default=GRAINS,
                        help="sizes of heaps (default: 1000 to 1000000)")
    parser.add_argument("--samples", type=int, default=5, help="samples of each heap (default: 5)")
    parser.add_argument("--shapes", nargs="+", default=["sphere", "irregular"], choices=["sphere", "irregular"])
    parser.add_argument("--models", nargs="+", default=["lambert", "model_1", "model_2", "model_3"],
                        help=f"lambert's heaps are of all sizes, those of other models have {MODELS_AT} grains")
    parser.add_argument("--size", type=int, nargs=2, default=SIZE, metavar=("W", "H"), help="of the picture, pixels")
    parser.add_argument("--visibility", default="automatic", choices=["automatic", "drawn", "cast", "device_rays"],
                        help="how it is found what is seen (default: automatic)")
    parser.add_argument("--one", nargs=3, metavar=("SHAPE", "MODEL", "GRAINS"), help=argparse.SUPPRESS)
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also writes the result there")
    options = parser.parse_args()
    if options.one:
        sys.path.insert(0, options.build)
        import mesograin_native as native

        shape, model, count = options.one
        print(json.dumps(measure(native, shape, model, int(count), options.samples, tuple(options.size),
                                 options.visibility)))
        return

    print(f"{'shape':<10}{'model':<9}{'grains':>9}{'ms':>9}{'ratio':>8}{'slider':>8}{'orbit':>9}{'first':>9}{'held':>7}"
          f"{'peak':>7}  milliseconds of the passes")
    cases = []
    for shape in options.shapes:
        for model in options.models:
            for count in options.grains if model == "lambert" else [MODELS_AT]:
                cases.append(run_apart(options, shape, model, count))
                show(cases[-1])
    of = {(case["shape"], case["model"], case["grains"]): case for case in cases}
    for shape in options.shapes:
        if (shape, "lambert", 10_000) in of and (shape, "lambert", 1_000_000) in of:
            growth = of[shape, "lambert", 1_000_000]["ratio"] / of[shape, "lambert", 10_000]["ratio"]
            print(f"{shape}: a hundred times as many grains as 10000 cost {growth:.1f} times as much")
    for sentence in bars(of):
        print(sentence)
    print("ratio: to a Lambert sphere that fills the picture; slider: the first picture after a material changed, in"
          " samples; orbit: milliseconds of a frame while the camera moves; first: from no scene to a picture;"
          f" held, peak: megabytes; on {cases[0]['device']}")
    if options.json:
        options.json.write_text(json.dumps(cases, indent=1) + "\n")


if __name__ == "__main__":
    main()
