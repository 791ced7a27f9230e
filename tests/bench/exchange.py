"""What light between grains costs while a scene changes: milliseconds to the first and to the final answer after each
kind of change, the processor's until both, how far the first is off, and what was found anew. How the light follows a
slider that does not rest. And what a sample costs that shows this light, over one that does not, and the memory of it
all.

    exchange.py BUILD_FOLDER [--grains N] [--rounds N] [--changes NAME ...] [--materials NAME ...] [--drag SECONDS]
                [--json FILE]

A heap of equal balls, one sun and an even sky, seen by a view that waits for nothing, of 256 x 144 pixels. How far off:
relative L1 in blocks of 8 x 8 pixels between the first picture with new light and the final one. Medians of the rounds.
Each material is measured in a process of its own. Where a machine has other work, the processor's milliseconds over its
cores are what a quiet one would need.
"""
import argparse
import json
import os
import pathlib
import resource
import statistics
import subprocess
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
    "clear": {"model": "model_2", "sigma_a": (0.0002,) * 3, "sigma_s": (0.1998,) * 3, "eta": 1.5},
}
PARTS = ("tables", "links", "sources", "solutions", "renewed")
CHANGES = ["slider", "light", "sky", "grain", "grains"]
DRAG_STEP = 0.05  # seconds between two changes of a slider that is dragged
DRAG_STEPS = 40


def blocks(view):
    view.render(4)
    return view.read()[..., 1].reshape(SIZE[1] // 8, 8, SIZE[0] // 8, 8).mean(axis=(1, 3))


def slid(of, number):
    """The material with its slider so many steps further."""
    if "reflectance" in of:
        return {**of, "reflectance": (0.8 - 0.02 * number,) * 3}
    return {**of, "sigma_s": tuple(1.1 ** number * value for value in of["sigma_s"])}


def scenes(native, of, count, number):
    """{change: what makes its native.Scene}, of the same heap: as it is, and after each kind of change. number: of the
    round."""
    transforms, width = places(count)
    scale = 1.0 / numpy.linalg.norm(transforms[:, :3, 0], axis=1)
    transforms[:, :3, :3] *= scale[:, None, None]  # of one size: one kind
    mesh = shapes(native)["sphere"]
    sun, turned = (1.0, 0.4, 1.2), (1.0, 0.4 + 0.05 * number, 1.2)
    heap = native.InstanceArray(mesh, native.Material(**of), transforms.astype(numpy.float64))

    def scene(array=heap, to_light=sun, sky=0.3):
        return native.Scene(arrays=[array], lights=[native.DirectionalLight(to_light, (3.0,) * 3)],
                            world=native.World((sky,) * 3), exchange="order_1")

    def elsewhere(move):
        where = transforms.astype(numpy.float64)
        move(where)
        return scene(native.InstanceArray(mesh, native.Material(**of), where))

    def move_one(where):
        where[-count // 20, :3, 3] += (0.0, 0.0, 0.3 * number)  # one of those on top

    def let_fall(where):
        where[:, 2, 3] -= 0.02 * number * (where[:, 2, 3] - where[:, 2, 3].min())

    return width, {"nothing before": scene,
                   "slider": lambda: scene(heap.with_material(native.Material(**slid(of, number)))),
                   "light": lambda: scene(to_light=turned), "sky": lambda: scene(sky=0.3 + 0.05 * number),
                   "grain": lambda: elsewhere(move_one), "grains": lambda: elsewhere(let_fall)}


def follow(view, scene):
    """Sets a scene and waits for its light: what happened, as a dictionary."""
    statistics_ = view.statistics()["exchange"]
    before = statistics_["found"] if statistics_ else dict.fromkeys(PARTS, 0)
    started = time.perf_counter()
    busy = time.process_time()
    view.set_scene(scene)
    set_ms = 1e3 * (time.perf_counter() - started)
    first = picture = None
    final = first_cpu = 0.0
    while True:
        known = view.preparing is None
        if view.take_news():
            final = time.perf_counter() - started
            cpu = time.process_time() - busy
            if picture is None:
                first, first_cpu, picture = final, cpu, blocks(view)
        if known:
            break
        time.sleep(0.001)
    right = blocks(view)
    after = view.statistics()["exchange"]
    return {"set_ms": set_ms, "first_ms": 1e3 * first, "final_ms": 1e3 * final,
            "first_cpu_ms": 1e3 * first_cpu, "cpu_ms": 1e3 * cpu,
            "first_off": float(numpy.abs(picture - right).sum() / right.sum()),
            "found": {name: after["found"][name] - before[name] for name in PARTS}, "steps": after["steps"]}


def drag(native, view, of, scene, seconds):
    """Moves a slider on every DRAG_STEP seconds: what is seen of new light meanwhile, as a dictionary. off: of the
    picture that is seen when the slider has moved for so long, from the final one of the same place of the slider."""
    heap = scene.arrays[0]
    began = latest = time.perf_counter()
    waits, step = [], 0
    while time.perf_counter() - began < seconds:
        step += 1
        material = native.Material(**slid(of, 2.9 * (1.0 - abs(1.0 - step / DRAG_STEPS % 2.0))))
        here = native.Scene(arrays=[heap.with_material(material)], lights=scene.lights, world=scene.world,
                            exchange="order_1")
        view.set_scene(here)
        while True:  # once at least: a material may take as long as a step
            if view.take_news():
                now = time.perf_counter()
                waits.append(1e3 * (now - latest))
                latest = now
            if time.perf_counter() >= began + step * DRAG_STEP:
                break
            time.sleep(0.001)
    waits.append(1e3 * (time.perf_counter() - latest))
    seen = blocks(view)
    while view.preparing is not None:
        time.sleep(0.001)
    view.take_news()
    right = blocks(view)
    return {"lights": len(waits) - 1, "steps": step, "longest_ms": max(waits), "median_ms": statistics.median(waits),
            "off": float(numpy.abs(seen - right).sum() / right.sum())}


def sample_milliseconds(view):
    started = time.perf_counter()
    view.render(1)
    return 1e3 * (time.perf_counter() - started)


def over_direct(native, view, scene, camera):
    """What a sample of a scene whose light is known costs, over one without light between grains. They take turns, so
    that what else the machine does slows both."""
    direct = native.View(*SIZE, patient=False)
    direct.set_camera(camera)
    direct.set_scene(native.Scene(arrays=scene.arrays, lights=scene.lights, world=scene.world, exchange="off"))
    times = ([], [])
    for _ in range(24):
        for one, of in zip((view, direct), times):
            of.append(sample_milliseconds(one))
    return statistics.median(times[0][4:]) / statistics.median(times[1][4:])


def measure(native, of, count, rounds, wanted, seconds):
    """({change: dictionary} of one material, of a drag of so many seconds, a frame's cost over that of a direct one,
    the megabytes until a first view has shown the final light)."""
    found = {}
    frames = dragged = shown = None
    for number in range(1, rounds + 1):
        width, changes = scenes(native, of, count, number)
        eye = (0.0, -0.6 * width, 1.05 * width)
        camera = native.Camera.look_at(eye, (0.0, 0.0, -0.15 * width), (0.0, 0.0, 1.0), 18.0, SIZE[0] / SIZE[1])
        view = native.View(*SIZE, patient=False)
        view.set_camera(camera)
        base = changes["nothing before"]()
        for name, make in changes.items():
            first = name == "nothing before"
            if name not in wanted and not first:
                continue
            scene = base if first else make()
            found.setdefault(name, []).append(follow(view, scene))
            if not first:
                follow(view, base)
            elif frames is None:
                shown = peak_megabytes()
                frames = over_direct(native, view, scene, camera)
                if seconds:
                    dragged = drag(native, view, of, scene, seconds)
                    follow(view, base)
        del view
    medians = {name: {key: statistics.median(one[key] for one in each) if key != "found" else each[-1][key]
                      for key in each[0]} for name, each in found.items()}
    return medians, dragged, frames, shown


def peak_megabytes():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def measure_one(options, name):
    import mesograin_native as native
    changes, dragged, frames, shown = measure(native, MATERIALS[name], options.grains, options.rounds, options.changes,
                                              options.drag)
    return {"changes": changes, "drag": dragged, "frame_over_direct": frames,
            "shown_megabytes": shown, "peak_megabytes": peak_megabytes()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the folder of the native module")
    parser.add_argument("--grains", type=int, default=10_000, help="in the heap (default: 10000)")
    parser.add_argument("--rounds", type=int, default=3, help="of changes (default: 3)")
    parser.add_argument("--materials", nargs="+", default=list(MATERIALS), choices=list(MATERIALS), metavar="NAME")
    parser.add_argument("--changes", nargs="*", default=CHANGES, choices=CHANGES, metavar="NAME",
                        help="after the first picture, which is always measured (default: all)")
    parser.add_argument("--drag", type=float, default=3.0, metavar="SECONDS",
                        help="that a slider is dragged for (default: 3; 0: none is)")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also writes the result there")
    parser.add_argument("--one", metavar="NAME", help=argparse.SUPPRESS)
    options = parser.parse_args()
    sys.path.insert(0, options.build)
    if options.one:
        print(json.dumps(measure_one(options, options.one)))
        return
    print(f"{'material':<13}{'change':<16}{'first ms':>9}{'cpu ms':>8}{'off':>7}{'final ms':>9}{'cpu ms':>8}"
          f"{'steps':>6}  found anew: {', '.join(PARTS)}")
    cases = {}
    for name in options.materials:
        words = [sys.executable, __file__, options.build, "--one", name, "--grains", str(options.grains),
                 "--rounds", str(options.rounds), "--drag", str(options.drag), "--changes", *options.changes]
        cases[name] = json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True).stdout)
        for change, case in cases[name]["changes"].items():
            counts = ", ".join(str(case["found"][part]) for part in PARTS)
            print(f"{name:<13}{change:<16}{case['first_ms']:>9.0f}{case['first_cpu_ms']:>8.0f}{case['first_off']:>7.1%}"
                  f"{case['final_ms']:>9.0f}{case['cpu_ms']:>8.0f}{case['steps']:>6.0f}  {counts}")
        if dragged := cases[name]["drag"]:
            print(f"{name:<13}a slider moved {dragged['steps']} times in {options.drag:g} s: new light "
                  f"{dragged['lights']} times, after {dragged['median_ms']:.0f} ms, {dragged['longest_ms']:.0f} at "
                  f"most; the last picture {dragged['off']:.1%} off")
        print(f"{name:<13}a sample is {cases[name]['frame_over_direct']:.2f} times that without light between grains; "
              f"{cases[name]['shown_megabytes']:.0f} MB at most until one view has shown it, "
              f"{cases[name]['peak_megabytes']:.0f} in all, with a second view", flush=True)
    if options.json:
        options.json.write_text(json.dumps({"grains": options.grains, "load": os.getloadavg(), "cases": cases},
                                           indent=1) + "\n")


if __name__ == "__main__":
    main()
