# How often the significance test calls renders different that differ in their seed alone:
#   ./mesograin bench false_alarms [--groups N] [--kinds KIND ...] [--json FILE]
"""Cycles renders one sphere with many seeds. They are dealt out into groups that share no seed; in each, some seeds
play our picture and two the reference, and the test says whether they differ. None does, so every alarm is a false one.
The interval is Clopper and Pearson's of 95 % (Biometrika 26, 1934). Beside it stands the rate in DRAWN groups drawn at
random, which share seeds and so have no such interval, but are many. Runs inside Blender."""

import argparse
import json
import math
import pathlib
import sys
import time

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "addon"), str(ROOT / "tests" / "blender")]

SIZE = (48, 48)
SUNS = [((1.0, 1.0, 1.0), 20.0), ((-1.0, -1.0, -1.6), 10.0)]
SAMPLES = {"diffuse": 4, "glossy": 4, "volume_index_matched": 8, "subsurface": 8}
"""Of each pixel and seed: few, so that a seed is cheap and its noise high."""
DEALS = ((2, 2), (4, 2))
"""(seeds that play our picture, seeds of the reference)."""
RATES = (0.01, 0.05, 0.2)
"""Of which the first is the one that comparisons state; the others come often enough to be measured well."""


DRAWN = 4000


def renders(kind, count, tell):
    """(list of `count` images, (h, w) bool mask of what is compared)."""
    from cycles_scenes import depsgraph, make_sphere
    from mesograin import native_module
    from mesograin.cycles import kinds, nodes, recipes, settings, shot
    from mesograin.cycles.stage import Stage

    native = native_module.get()
    material = make_sphere(SUNS, model=kinds.KINDS[kind].models[0], scale=1.0, roughness=0.3)
    evaluated = depsgraph()
    values = shot.grain_values(evaluated, {}, material)

    def shots(chosen, samples, seeds):
        recipe = recipes.recipe(chosen.recipe, values, nodes.features())
        description = settings.settings(chosen, samples, 0, SIZE)
        with Stage(evaluated, description, lambda _: nodes.build("Mesograin seeds", recipe)) as stage:
            # The meshes are prepared once; what a seed decides is not kept.
            stage.scene.render.use_persistent_data = True
            for seed in seeds:
                stage.scene.cycles.seed = seed
                yield shot.render_stage(native, stage.scene, lambda _: None)

    [coverage] = shots(kinds.COVERAGE, kinds.COVERAGE.samples, (0,))
    images = []
    for image in shots(kinds.KINDS[kind], SAMPLES[kind], range(1, count + 1)):
        images.append(image)
        tell(len(images))
    return images, native.default_mask(coverage[..., 3])


def alarms(images, mask, groups, ours, rate):
    """How many false ones there are. groups: of indices, of which the first `ours` play our picture."""
    from mesograin.studies.comparison import significance

    dealt = ([images[index] for index in group] for group in groups)
    found = (significance.test(group[:ours], group[ours:], mask, rate)[0] for group in dealt)
    return sum(entry["verdict"] == significance.DIFFERS for entry in found)


def apart(count, size):
    """Groups of indices below `count` that share none."""
    return [range(at, at + size) for at in range(0, count - size + 1, size)]


def drawn(count, size):
    """DRAWN groups at random, the same in every run."""
    random = numpy.random.default_rng(1)
    return [random.choice(count, size, replace=False) for _ in range(DRAWN)]


def interval(count, trials, confidence=0.95):
    """(low, high) of the rate behind `count` events in `trials`."""
    tail = (1.0 - confidence) / 2.0

    def at_most(number, rate):
        if rate in (0.0, 1.0):
            return float(rate == 0.0 or number >= trials)
        logs = (math.lgamma(trials + 1) - math.lgamma(k + 1) - math.lgamma(trials - k + 1) + k * math.log(rate)
                + (trials - k) * math.log1p(-rate) for k in range(number + 1))
        return math.fsum(map(math.exp, logs))

    def where(number, probability):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if at_most(number, middle) > probability else (low, middle)
        return low

    return where(count - 1, 1.0 - tail) if count else 0.0, where(count, tail) if count < trials else 1.0


def measure(kind, count, tell):
    """Rows of the table."""
    from mesograin.studies.comparison import measure as comparison

    images, mask = renders(kind, count, tell)
    floor = comparison.compare(images[0], images[:2], mask)["noise_floor"]["relative_l1"]
    for ours, theirs in DEALS:
        groups, more = (deal(count, ours + theirs) for deal in (apart, drawn))
        for rate in RATES:
            found = alarms(images, mask, groups, ours, rate)
            yield {"kind": kind, "samples": SAMPLES[kind], "noise_floor": floor, "ours": ours, "theirs": theirs,
                   "stated": rate, "alarms": found, "groups": len(groups), "interval": interval(found, len(groups)),
                   "rate_of_drawn": alarms(images, mask, more, ours, rate) / DRAWN}


def main(words):
    parser = argparse.ArgumentParser(prog="mesograin bench false_alarms", description=__doc__)
    parser.add_argument("--groups", type=int, default=300, help="of four seeds, for each kind (default: 300)")
    parser.add_argument("--kinds", nargs="+", choices=tuple(SAMPLES), default=["diffuse", "volume_index_matched"])
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also writes the result there")
    chosen = parser.parse_args(words)

    import addon_utils
    import bpy
    import mesograin

    addon_utils.enable("cycles")
    mesograin.register()
    rows = []
    print(f"{'kind':<22}{'noise':>8}{'seeds':>7}{'stated':>8}{'alarms':>14}{'rate':>8}   {'95 % interval':<16}drawn")
    for kind in chosen.kinds:
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        started, count = time.monotonic(), 4 * chosen.groups

        def tell(done, kind=kind, started=started, count=count):
            if done % 100 == 0:
                left = (time.monotonic() - started) / done * (count - done)
                print(f"{kind}: {done} of {count} seeds, about {left:.0f} s left", file=sys.stderr, flush=True)

        for row in measure(kind, count, tell):
            rows.append(row)
            low, high = row["interval"]
            seeds, of = f"{row['ours']} : {row['theirs']}", f"{row['alarms']} of {row['groups']}"
            print(f"{kind:<22}{row['noise_floor']:>8.1%}{seeds:>7}{row['stated']:>8.0%}{of:>14}"
                  f"{row['alarms'] / row['groups']:>8.1%}   {f'{low:.1%} to {high:.1%}':<16}"
                  f"{row['rate_of_drawn']:.1%}", flush=True)
    if chosen.json:
        chosen.json.write_text(json.dumps({"about": __doc__, "size": SIZE, "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:])
