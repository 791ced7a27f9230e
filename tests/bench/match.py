# How near a match comes to coefficients that are known, from pictures that Cycles rendered:
#   ./mesograin bench match [--cases CASE ...] [--models MODEL ...] [--samples N] [--size N] [--json FILE]
"""Cycles renders an index-matched volume, on a sphere, on a grain of sand, and in a small heap whose grains light each
other; the match sees the picture and the scene, not the coefficients. Beside each coefficient found stands by how much
it is off, and the interval that the match states for it. Runs inside Blender."""

import argparse
import json
import math
import pathlib
import sys
import time

import bpy
from mathutils import Vector

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "addon"), str(ROOT / "tests" / "blender")]

SUNS = [((1.0, 1.0, 1.0), 20.0), ((-1.0, -1.0, -1.6), 10.0)]
MEDIA = {
    "sphere": {"sigma_s": (1.2, 1.0, 0.6), "sigma_a": (0.06, 0.2, 0.6)},
    "sand": {"sigma_s": (1.2, 1.0, 0.6), "sigma_a": (0.06, 0.2, 0.6)},
    "heap": {"sigma_s": (6.0, 5.0, 3.0), "sigma_a": (0.3, 1.0, 3.0)},
}
"""Per unit; the sphere's radius and the grain's are 2.4, those in the heap 0.4: three mean free paths."""
HEAP = 150
REFERENCE = "volume_index_matched"


def sphere(medium):
    """The sphere that comparisons begin with."""
    from cycles_scenes import make_sphere

    return make_sphere(SUNS, **medium)


def sand(medium):
    """In the sphere's place, an irregular grain as large."""
    from mesograin.grains import objects

    material = sphere(medium)
    bpy.context.object.data = objects.mesh("sand", size=2.4, seed=3, segments=28)
    bpy.context.object.data.materials.append(material)
    return material


def heap(medium):
    """Balls that fell to a heap, seen from the side and above."""
    from mesograin.grains import objects

    material = sphere(medium)
    bpy.data.objects.remove(bpy.context.object)
    pile = objects.pile_of(["bead"], HEAP, 0.4, seed=1, segments=16, variation=0.0)
    bpy.context.scene.collection.objects.link(pile)
    for thing in bpy.data.objects:
        if thing.type == "MESH" and thing.data.materials:
            thing.data.materials[0] = material
    camera = bpy.context.scene.camera
    camera.location = (0.0, -9.0, 6.0)
    camera.rotation_euler = Vector((0.0, -9.0, 5.0)).to_track_quat("Z", "Y").to_euler()
    camera.data.angle = math.radians(30.0)
    return material


CASES = {"sphere": sphere, "sand": sand, "heap": heap}


def prepare(case, size):
    """(depsgraph, material) of a case in an empty file."""
    from cycles_scenes import depsgraph

    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = size
    material = CASES[case]({**MEDIA[case], "model": "transport", "boundary": "index_matched", "eta": 1.0})
    return depsgraph(), material


def measure(case, models, size, samples, corrections, keep=None):
    """Dicts: one for each model."""
    from mesograin import native_module
    from mesograin.cycles import reference
    from mesograin.report import colours
    from mesograin.studies.comparison import results
    from mesograin.studies.comparison.progress import Progress
    from mesograin.studies.match import files, of_blender, search, target

    evaluated, material = prepare(case, size)
    started = time.monotonic()
    truth = reference.render(evaluated, REFERENCE, (size, size), samples=samples, seeds=(1,)).mean
    rendered = time.monotonic() - started
    # What is searched for is not given away.
    material.mesograin.sigma_a = material.mesograin.sigma_s = (1.0, 1.0, 1.0)
    bpy.context.view_layer.update()
    for model in models:
        whole = target.linear(case, truth)
        subject, small, _, _ = of_blender.subject(bpy.context.evaluated_depsgraph_get(), None, whole, size, 32,
                                                  REFERENCE)
        trace = of_blender.tracer(bpy.context.evaluated_depsgraph_get(), whole, small, 1, REFERENCE, samples)
        request = search.Request(("sigma_a", "sigma_s"), model, corrections=corrections, trace=trace)
        progress = Progress()
        progress.plan(search.steps(request, search.guess(subject)))
        started = time.process_time()
        found = search.search(native_module.get(), subject, small, request, progress)
        progress.close()
        if keep:
            stops = colours.exposure_for(found.target, found.mask)
            results.Output(keep).write_png(f"match_{case}_{model}.png",
                                           files.beside(found, lambda pixels: colours.expose(pixels, stops)))
        yield {"case": case, "model": model, "cycles_seconds": rendered, "cpu_seconds": time.process_time() - started,
               "renders": found.renders, "converged": found.converged,
               "blocks": found.metrics["relative_l1_blocks"],
               "found": {name: beside(found.intervals[name], MEDIA[case][name]) for name in ("sigma_s", "sigma_a")}}


def beside(entries, truth):
    """Intervals with what is true."""
    return [{**entry, "true": true} for entry, true in zip(entries, truth)]


def row(measured):
    """A line of Markdown."""
    def told(entry):
        off = f"{100.0 * (entry['value'] / entry['true'] - 1.0):+.1f}"
        if not entry["determined"]:
            return f"{off} (?)"
        inside = entry["low"] <= entry["true"] <= entry["high"]
        return f"{off} ({100.0 * (entry['high'] / entry['value'] - 1.0):.0f}{'' if inside else ', outside'})"

    columns = [" / ".join(map(told, measured["found"][name])) for name in ("sigma_s", "sigma_a")]
    return (f"| {measured['case']} | {measured['model']} | {' | '.join(columns)} | {100.0 * measured['blocks']:.1f} | "
            f"{measured['renders']} | {measured['cpu_seconds']:.0f} |")


HEADER = ("| case | model | sigma_s, R / G / B: % off (stated) | sigma_a | blocks, % off | renders | CPU s |\n"
          "|---|---|---|---|---|---|---|")


def main():
    parser = argparse.ArgumentParser(prog="./mesograin bench match", description=__doc__)
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES))
    parser.add_argument("--models", nargs="+", default=["transport", "model_3"])
    parser.add_argument("--samples", type=int, default=128, help="of Cycles, each pixel (default: 128)")
    parser.add_argument("--corrections", type=int, default=0, help="by Cycles, of the model (default: 0)")
    parser.add_argument("--size", type=int, default=96, help="pixels a side (default: 96)")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also writes the numbers there")
    parser.add_argument("--keep", type=pathlib.Path, metavar="FOLDER",
                        help="also keeps pictures there, Cycles' beside ours")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
    import addon_utils

    addon_utils.enable("cycles")
    import mesograin

    if not hasattr(bpy.types.Scene, "mesograin"):
        mesograin.register()
    print(HEADER, flush=True)
    rows = []
    for case in options.cases:
        for measured in measure(case, options.models, options.size, options.samples, options.corrections,
                                options.keep):
            rows.append(measured)
            print(row(measured), flush=True)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
