"""How far light between grains is from path tracing for heaps by chance: of any grains, media and lights of the kinds
that are drawn, so that what is said of a heap's error is said of such as nobody chose.

    chance_heaps.py BUILD_FOLDER [--first N] [--count N] [--paths N] [--samples N] [--out FILE]

Each number is one heap: 696 balls, cubes, flakes, rice, peanuts or grains of sand with a medium in them whose channels
are unlike, under a wide lamp in a dim sky. The truth is traced beside it (mesograin-referee render). Errors are
relative L1 in blocks of 8 x 8 pixels of a picture of 64 x 64 of the heap's middle, without what the truth's noise adds.
FILE (default: chance_heaps.json) keeps what was measured; numbers that it has are not measured again. At the end it
says within what nine of ten heaps of each surface are.
"""
import argparse
import json
import math
import pathlib
import sys
import tempfile

import heap_light
import numpy
from heap_grains import GRAINS

SIZE = [64, 64]
EXCHANGES = ("heaps", "gathered")


def between(random, least, most):
    """Evenly over the logarithm."""
    return least * (most / least) ** random.uniform()


def case_of(number):
    """What is drawn, as JSON has it."""
    random = numpy.random.default_rng([7, number])
    radius = between(random, 0.1, 6.0)
    refracts = random.uniform() < 0.65
    return {"number": number, "grains": str(random.choice(GRAINS, p=[0.25] + [0.15] * 5)),
            "radius": [min(radius * math.exp(0.4 * random.normal()), 8.0) for _ in range(3)],
            "albedo": [1.0 - between(random, 0.002, 0.5) for _ in range(3)],
            "g": float(random.uniform(0.0, 0.9)) if random.uniform() < 0.4 else 0.0,
            "eta": float(random.uniform(1.2, 1.7)) if refracts else None,
            "elevation": float(random.uniform(10.0, 90.0)), "azimuth": float(random.uniform(0.0, 360.0))}


def sky(case):
    """(64, 128, 3): a lamp as wide as cos^4, five times as bright as what is about it; black below."""
    up = math.pi / 2.0 - (numpy.arange(64) + 0.5) * math.pi / 64
    around = (numpy.arange(128) + 0.5) * 2.0 * math.pi / 128
    lamp = (math.radians(case["elevation"]), math.radians(case["azimuth"]))
    cosine = (numpy.sin(up)[:, None] * math.sin(lamp[0])
              + numpy.cos(up)[:, None] * math.cos(lamp[0]) * numpy.cos(around - lamp[1]))
    radiance = 0.2 + numpy.maximum(cosine, 0.0) ** 4
    return numpy.repeat((radiance * (up[:, None] > 0.0))[..., None], 3, axis=2).astype(numpy.float32)


def scene(native, case, exchange):
    """heap_light's heap, of such grains in such light."""
    material = heap_light.medium(case["albedo"], case["radius"], case["eta"], case["g"])
    look = native.Material(model="model_2", boundary=material["boundary"], eta=case["eta"] or 1.3, g=case["g"],
                           **{name: tuple(material[name]) for name in ("sigma_a", "sigma_s")})
    return native.Scene(arrays=[heap_light.heap(native, look, case["grains"])], exchange=exchange,
                        world=native.World(image=native.Surroundings(sky(case))))


def middle(native):
    """heap_light's camera, of the same pixels' size in a smaller picture."""
    return heap_light.camera(native, SIZE[0] / heap_light.SIZE[0])


def measure(native, referee, case, paths, samples):
    """The case with its truth's noise and, by exchange, total and error in blocks, of all channels together."""
    with tempfile.TemporaryDirectory() as folder:
        right, noise = heap_light.truth_of_scene(native, referee, scene(native, case, "off"), paths,
                                                 pathlib.Path(folder), middle(native), SIZE)
    # A normal error's mean size is sqrt(2 / pi) of its deviation.
    noise *= math.sqrt(2.0 / math.pi)
    measured = {**case, "noise": noise}
    for exchange in EXCHANGES:
        view = native.View(*SIZE)
        view.set_scene(scene(native, case, exchange))
        view.set_camera(middle(native))
        view.render(samples)
        total, apart = heap_light.how_far(view.read()[..., :3], right)
        measured[exchange] = {"total": total, "blocks": math.sqrt(max(0.0, apart**2 - noise**2))}
        measured["stuff"] = view.statistics()["exchange"]["stuff"]
    return measured


def summary(cases):
    """Lines about heaps of each surface: from least to most of what a ball that stands for a grain is made of, as
    native.View.statistics tells, and what nine of ten are within."""
    for surface in sorted({case["stuff"][0]["surface"] for case in cases}):
        of = [case for case in cases if case["stuff"][0]["surface"] == surface]
        ranges = [f"{name} {min(case['stuff'][0][name][0] for case in of):.3g} to"
                  f" {max(case['stuff'][0][name][1] for case in of):.3g}"
                  for name in ("thickness", "albedo", "g", "eta")]
        yield f"{len(of)} heaps, {surface}, {', '.join(ranges)}"
        for exchange in EXCHANGES:
            total, apart = (sorted(found) for found in zip(*((abs(case[exchange]["total"] - 1.0),
                                                              case[exchange]["blocks"]) for case in of)))
            last = math.ceil(0.9 * len(of)) - 1
            yield (f"    {exchange:<9} nine of ten: total {total[last]:.1%}, blocks {apart[last]:.1%};"
                   f" worst: {total[-1]:.1%}, {apart[-1]:.1%}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the folder of the native module and of the referee")
    parser.add_argument("--first", type=int, default=0, help="heap's number (default: 0)")
    parser.add_argument("--count", type=int, default=120, help="of heaps (default: 120)")
    parser.add_argument("--paths", type=int, default=32, help="of the truth, a pixel (default: 32)")
    parser.add_argument("--samples", type=int, default=32, help="of each picture (default: 32)")
    parser.add_argument("--out", type=pathlib.Path, metavar="FILE", default=pathlib.Path("chance_heaps.json"))
    options = parser.parse_args()
    sys.path.insert(0, options.build)
    import mesograin_native as native

    referee = pathlib.Path(options.build) / "tests/referee/mesograin-referee"
    known = json.loads(options.out.read_text()) if options.out.exists() else []
    for number in range(options.first, options.first + options.count):
        if any(case["number"] == number for case in known):
            continue
        case = measure(native, referee, case_of(number), options.paths, options.samples)
        known.append(case)
        options.out.write_text(json.dumps(known, indent=1) + "\n")
        found = "  ".join(f"{name} {case[name]['total']:.3f} {case[name]['blocks']:.1%}" for name in EXCHANGES)
        print(f"{number:>4} {case['grains']:<8} R {case['radius'][1]:.2g} albedo {case['albedo'][1]:.4f}"
              f" g {case['g']:.2f} eta {case['eta'] or 1:.2f}  {found}  truth's noise {case['noise']:.1%}", flush=True)
    print(*summary(known), sep="\n")


if __name__ == "__main__":
    main()
