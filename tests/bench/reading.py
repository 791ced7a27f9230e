"""How long Blender's main thread reads a scene of scattered grains, as an artist's change of it makes it do.

Runs inside Blender: reading.py [--grains 100000] [--rounds 5]. Processor time of the fastest of some rounds, by where
grains get their colours from, and what of it Blender takes to name as many instances. Before Blender 5 it matters
whether two objects come before the first instance: then places are read at once, else one by one (scene/heaps.py).
"""
import argparse
import pathlib
import sys
import time

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "addon"))

import mesograin  # noqa: E402
from mesograin import compat  # noqa: E402
from mesograin.scene import export, meshes  # noqa: E402

SIDE = 10.0  # of the ground


def strew(count, first):
    """A ground with about `count` grains of sand; gives their material. first: it is the scene's first object."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if not first:
        bpy.ops.object.light_add(type="SUN")
        bpy.ops.object.camera_add()
    bpy.ops.mesh.primitive_plane_add(size=SIDE)
    ground = bpy.context.object
    bpy.ops.mesograin.scatter(kind="sand")
    for name, value in (("Density", count / SIDE**2), ("Size", 0.3 * SIDE / count**0.5), ("Spacing", 0.0)):
        compat.set_modifier_input(ground.modifiers[0], name, value)
    ground.update_tag()
    [material] = bpy.data.materials  # that of the grains, which came with them
    return material


def fastest(rounds, work):
    """Seconds of processor time."""
    def once():
        start = time.process_time()
        work()
        return time.process_time() - start
    return min(once() for _ in range(rounds))


def measure(said, rounds):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    depsgraph.update()
    cache = meshes.MeshCache()
    values = export.read_scene(depsgraph, cache)
    grains, coloured = sum(map(len, values.heaps)), sum(len(heap) for heap in values.heaps if heap.factors)
    read = fastest(rounds, lambda: export.read_scene(depsgraph, cache))
    named = fastest(rounds, lambda: [each.object for each in depsgraph.object_instances])
    print(f"{said:<42}{grains:>9}{coloured:>11}{read:>8.3f}{named:>8.3f}", flush=True)


def main():
    parser = argparse.ArgumentParser(prog="./mesograin bench reading", description=__doc__.split("\n\n")[0])
    parser.add_argument("--grains", type=int, default=100_000, help="how many are strewn (default: 100000)")
    parser.add_argument("--rounds", type=int, default=5, help="of which the fastest counts (default: 5)")
    chosen = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
    mesograin.register()
    print(f"{'colours':<42}{'grains':>9}{'coloured':>11}{'read s':>8}{'named s':>8}")
    for first in (False, True):
        colours = strew(chosen.grains, first).mesograin_colours
        order = "ground first" if first else "ground third"
        colours.vary = False
        measure(f"the material's, {order}", chosen.rounds)
        colours.vary, colours.source = True, "RANGE"
        measure(f"at random in a range, {order}", chosen.rounds)
        colours.source, colours.colour_attribute = "ATTRIBUTE", "grain_colour"
        bpy.ops.mesograin.add_attribute_reader()
        measure(f"of an attribute, {order}", chosen.rounds)


if __name__ == "__main__":
    main()
