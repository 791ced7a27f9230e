# Baking as a command: blender -b --factory-startup --python THIS -- SCENE.blend -o OUT.exr [OPTION ...]
"""Puts the add-on into a Blender without window and bakes; the exit code says how it went."""

import sys
from pathlib import Path

ADDON = Path(__file__).resolve().parents[2]


def _run(chosen, _):
    from mesograin.command_line.process import FAILED, OK, open_scene, told

    native = open_scene(chosen.scene)

    from mesograin.cycles.reference import ReferenceError
    from mesograin.cycles.stage import StageError
    from mesograin.studies.baking import surface
    from mesograin.studies.comparison.progress import Progress

    progress = Progress()
    with told(progress, surface.OutputError, (surface.BakeError, ReferenceError, StageError, native.Error), FAILED):
        surface.require_writable(chosen.output)
        _bake(chosen, progress)
    return OK


def _bake(chosen, progress):
    import bpy
    from mesograin.scene import as_rendered

    with as_rendered.depsgraph(bpy.context) as depsgraph:
        _bake_shown(chosen, depsgraph, progress)


def _bake_shown(chosen, depsgraph, progress):
    from mesograin.scene import export
    from mesograin.studies.baking import surface

    overrides = export.overrides(chosen.settings, depsgraph.scene)
    name = surface.choose(depsgraph, chosen.object)
    own = {**overrides, "model": chosen.model} if chosen.model else overrides
    if chosen.relightable:
        _bake_relightable(chosen, depsgraph, name, own, progress)
        return
    ours = surface.Surface(depsgraph, name, chosen.size, chosen.view_from, own,
                           exchange=chosen.exchange)
    if chosen.compare:
        _compare(chosen, depsgraph, ours, overrides, progress)
        return
    for warning in ours.warnings:
        progress.say(f"bake: {warning}")
    progress.plan([(f"baking {name}", "bake", 1.0)])
    progress.begin()
    ours.render(chosen.samples, progress.update)
    progress.end()
    for warning in ours.drawn_otherwise:
        progress.say(f"bake: {warning}")
    progress.close()
    surface.write(chosen.output, ours.texture(chosen.margin), ours.provenance(chosen.margin),
                  chosen.half)
    models = ", ".join(sorted({values["model"] for values in ours.materials.values()}))
    print(f"{chosen.output}: {name}, {chosen.size[0]} x {chosen.size[1]} texels, {chosen.samples} samples by {models}",
          flush=True)


def _bake_relightable(chosen, depsgraph, name, overrides, progress):
    from mesograin.studies.baking import relightable_files
    from mesograin.studies.baking.relightable_bake import RelightableBake

    bake = RelightableBake(depsgraph, name, chosen.size, chosen.samples, chosen.components, overrides)
    progress.plan([(f"baking {name} from all sides", "bake", 1.0)])
    progress.begin()
    bake.bake(progress.update)
    bake.write(chosen.output, chosen.margin, chosen.half)
    bake.write_nodes(chosen.output)
    progress.end()
    for sentence in bake.warnings:
        progress.say(f"bake: {sentence}")
    progress.close()
    files = ", ".join(path.name for path in relightable_files.paths(chosen.output).values())
    print(f"{name}, {chosen.components} components of {chosen.size[0]} x {chosen.size[1]} texels: "
          f"{bake.errors_in_words()}")
    print(f"{chosen.output.absolute().parent}: {files}", flush=True)


def _compare(chosen, depsgraph, own, overrides, progress):
    from mesograin.cycles.cache import Cache
    from mesograin.studies.baking import comparison
    from mesograin.studies.comparison.verdict import verdict

    pair = comparison.Pair(
        depsgraph, own.name, chosen.size, chosen.samples, chosen.view_from, overrides, chosen.model, chosen.reference,
        chosen.reference_samples, Cache(), chosen.exchange)
    written, results = comparison.bake(
        chosen.output, own, pair, chosen.samples, chosen.margin, chosen.half, progress)
    metrics, floor = results["metrics"], results["noise_floor"]
    numbers = [f"{title} {_share(value)}" for title, value in (
        ("relative L1", metrics["relative_l1"]), ("in blocks", metrics["relative_l1_blocks"]),
        ("noise floor", floor["relative_l1"]), ("light in all", metrics["bias"]))]
    what = f"{own.name}, {results['model']} beside {results['reference_title']}"
    print(f"{what}: {verdict({**results, 'status': 'done'})}")
    print(f"{', '.join(numbers)}; {results['mask']['pixels']} texels; Cycles {results['reference_seconds']:.1f} s")
    print(f"{chosen.output.absolute().parent}: {', '.join(written)}", flush=True)


def _share(value):
    return "unknown" if value is None else format(value, ".2%")


if __name__ == "__main__":
    sys.path.insert(0, str(ADDON.parent))
    from mesograin.command_line import process
    from mesograin.studies.baking import arguments

    process.main("bake", arguments.parse, _run, "Interrupted: nothing was written.")
