"""What light between grains costs while a scene changes: milliseconds to the first and to the final answer after each
kind of change, how far the first is off, and what was found anew.

    exchange.py BUILD_FOLDER [--grains N] [--rounds N] [--json FILE]

A heap of equal balls, one sun and an even sky, seen by a view that waits for nothing, of 256 x 144 pixels. How far off:
relative L1 in blocks of 8 x 8 pixels between the first picture with new light and the final one. Medians of the rounds.
"""
import argparse
import json
import pathlib
import statistics
import sys
import time

import numpy

from heap import places, shapes

SIZE = (256, 144)
MATERIALS = {
    "lambert .8": {"model": "lambert", "reflectance": (0.8,) * 3},
    "albedo .9": {"model": "model_2", "sigma_a": (0.3,) * 3, "sigma_s": (2.7,) * 3, "boundary": "index_matched"},
    "albedo .999": {"model": "model_2", "sigma_a": (0.003,) * 3, "sigma_s": (2.997,) * 3, "boundary": "index_matched"},
    "dielectric": {"model": "model_2", "sigma_a": (0.003,) * 3, "sigma_s": (2.997,) * 3, "eta": 1.3},
}
PARTS = ("tables", "links", "sources", "solutions")


def blocks(view):
    view.render(4)
    return view.read()[..., 1].reshape(SIZE[1] // 8, 8, SIZE[0] // 8, 8).mean(axis=(1, 3))


def scenes(native, of, count, number):
    """{change: native.Scene}, of the same heap: as it is, and after each kind of change. number: of the round."""
    transforms, width = places(count)
    transforms = transforms.astype(numpy.float64)
    scale = 1.0 / numpy.linalg.norm(transforms[:, :3, 0], axis=1)
    transforms[:, :3, :3] *= scale[:, None, None]  # of one size: one kind
    mesh = shapes(native)["sphere"]
    sun, turned = (1.0, 0.4, 1.2), (1.0, 0.4 + 0.05 * number, 1.2)
    slider = {name: tuple(1.1 ** number * value for value in values) if name == "sigma_s" else values
              for name, values in of.items()}
    if "reflectance" in of:
        slider["reflectance"] = (0.8 - 0.02 * number,) * 3
    fallen = transforms.copy()
    fallen[:, 2, 3] -= 0.02 * number * (fallen[:, 2, 3] - fallen[:, 2, 3].min())

    def scene(material=of, to_light=sun, where=transforms, sky=0.3):
        heap = native.InstanceArray(mesh, native.Material(**material), where)
        return native.Scene(arrays=[heap], lights=[native.DirectionalLight(to_light, (3.0,) * 3)],
                            world=native.World((sky,) * 3), exchange="order_1")

    return width, {"nothing before": scene(), "slider": scene(material=slider), "light": scene(to_light=turned),
                   "sky": scene(sky=0.3 + 0.05 * number), "grains": scene(where=fallen)}


def follow(view, scene):
    """Sets a scene and waits for its light: what happened, as a dictionary."""
    statistics_ = view.statistics()["exchange"]
    before = statistics_["found"] if statistics_ else dict.fromkeys(PARTS, 0)
    started = time.perf_counter()
    view.set_scene(scene)
    set_ms = 1e3 * (time.perf_counter() - started)
    first = picture = None
    final = 0.0
    while True:
        known = view.preparing is None
        if view.take_news():
            final = time.perf_counter() - started
            if picture is None:
                first, picture = final, blocks(view)
        if known:
            break
        time.sleep(0.001)
    right = blocks(view)
    after = view.statistics()["exchange"]
    return {"set_ms": set_ms, "first_ms": 1e3 * first, "final_ms": 1e3 * final,
            "first_off": float(numpy.abs(picture - right).sum() / right.sum()),
            "found": {name: after["found"][name] - before[name] for name in PARTS}, "steps": after["steps"]}


def measure(native, of, count, rounds):
    """{change: dictionary} of one material."""
    found = {}
    for number in range(1, rounds + 1):
        width, changes = scenes(native, of, count, number)
        eye = (0.0, -0.6 * width, 1.05 * width)
        view = native.View(*SIZE, patient=False)
        view.set_camera(native.Camera.look_at(eye, (0.0, 0.0, -0.15 * width), (0.0, 0.0, 1.0), 18.0, SIZE[0] / SIZE[1]))
        base = changes["nothing before"]
        for name, scene in changes.items():
            found.setdefault(name, []).append(follow(view, scene))
            if scene is not base:
                follow(view, base)
        del view
    return {name: {key: statistics.median(one[key] for one in each) if key != "found" else each[-1][key]
                   for key in each[0]} for name, each in found.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the folder of the native module")
    parser.add_argument("--grains", type=int, default=10_000, help="in the heap (default: 10000)")
    parser.add_argument("--rounds", type=int, default=3, help="of changes (default: 3)")
    parser.add_argument("--materials", nargs="+", default=list(MATERIALS), choices=list(MATERIALS), metavar="NAME")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also writes the result there")
    options = parser.parse_args()
    sys.path.insert(0, options.build)
    import mesograin_native as native

    print(f"{'material':<13}{'change':<16}{'first ms':>9}{'off':>7}{'final ms':>9}  found anew: {', '.join(PARTS)}")
    cases = {}
    for name in options.materials:
        cases[name] = measure(native, MATERIALS[name], options.grains, options.rounds)
        for change, case in cases[name].items():
            counts = ", ".join(str(case["found"][part]) for part in PARTS)
            print(f"{name:<13}{change:<16}{case['first_ms']:>9.0f}{case['first_off']:>7.1%}{case['final_ms']:>9.0f}  "
                  f"{counts}", flush=True)
    if options.json:
        options.json.write_text(json.dumps({"grains": options.grains, "cases": cases}, indent=1) + "\n")


if __name__ == "__main__":
    main()
