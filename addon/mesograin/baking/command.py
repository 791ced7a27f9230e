# Baking as a command: blender -b --factory-startup --python THIS -- SCENE.blend -o OUT.exr [OPTION ...]
"""Puts the add-on into a Blender without window and bakes; the exit code says how it went."""

import sys
from pathlib import Path

ADDON = Path(__file__).resolve().parents[1]
OK, NOT_BAKED, BAD_INPUT, NO_OUTPUT = 0, 1, 2, 3


def main():
    """Returns the exit code; every problem is one sentence on standard error."""
    sys.path.insert(0, str(ADDON.parent))
    from mesograin.baking import arguments

    chosen = arguments.parse(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])

    from mesograin.comparison import interruption

    with interruption.Interruption() as interrupted:
        try:
            return _run(chosen)
        except KeyboardInterrupt:
            sys.stderr.write("\nInterrupted: nothing was written.\n")
            return interrupted.code


def _run(chosen):
    import addon_utils
    import bpy
    import mesograin
    from mesograin import native_module

    addon_utils.enable("cycles")
    if not hasattr(bpy.types.Scene, "mesograin"):
        mesograin.register()
    try:
        # Only now, so that the file finds its engine and its properties.
        bpy.ops.wm.open_mainfile(filepath=str(chosen.scene.absolute()), load_ui=False)
    except RuntimeError as error:
        reason = " ".join(str(error).split()).removeprefix("Error: ")
        return _complain(f"{chosen.scene} cannot be opened: {reason}", BAD_INPUT)
    try:
        native = native_module.get()
    except native_module.Unavailable as error:
        return _complain(error, BAD_INPUT)

    from mesograin.baking import surface
    from mesograin.comparison.progress import Progress
    from mesograin.cycles.reference import ReferenceError
    from mesograin.cycles.stage import StageError

    progress = Progress()
    try:
        surface.require_writable(chosen.output)
        return _bake(chosen, progress)
    except surface.OutputError as error:
        return _complain(error, NO_OUTPUT)
    except (surface.BakeError, ReferenceError, StageError, native.Error) as error:
        return _complain(error, NOT_BAKED)
    finally:
        progress.close()


def _bake(chosen, progress):
    import bpy
    from mesograin import export
    from mesograin.baking import surface

    depsgraph = bpy.context.evaluated_depsgraph_get()
    unit = depsgraph.scene.mesograin.millimetres_per_unit
    overrides = {parameter: export.per_unit(parameter, value, unit) for parameter, value in chosen.settings.items()}
    name = surface.choose(depsgraph, chosen.object)
    if chosen.compare:
        return _compare(chosen, depsgraph, name, overrides, progress)
    if chosen.model:
        overrides["model"] = chosen.model
    ours = surface.Surface(depsgraph, name, chosen.size, chosen.view_from, overrides)
    for warning in ours.warnings:
        progress.say(f"bake: {warning}")
    progress.plan([(f"baking {name}", "bake", 1.0)])
    progress.begin()
    ours.render(chosen.samples, progress.update)
    progress.end()
    progress.close()
    surface.write(chosen.output, ours.texture(chosen.margin), ours.provenance(chosen.margin),
                  chosen.half)
    models = ", ".join(sorted({values["model"] for values in ours.materials.values()}))
    print(f"{chosen.output}: {name}, {chosen.size[0]} x {chosen.size[1]} texels, {chosen.samples} samples by {models}",
          flush=True)
    return OK


def _compare(chosen, depsgraph, name, overrides, progress):
    from mesograin.baking import comparison
    from mesograin.comparison.verdict import verdict
    from mesograin.cycles.cache import Cache

    ours, theirs, mask, results = comparison.compare(
        depsgraph, name, chosen.size, chosen.samples, chosen.view_from, overrides, chosen.model, chosen.reference,
        chosen.reference_samples, Cache(), progress)
    progress.close()
    written = comparison.write(chosen.output, ours, theirs, mask, results)
    metrics, floor = results["metrics"], results["noise_floor"]
    numbers = [f"{title} {_share(value)}" for title, value in (
        ("relative L1", metrics["relative_l1"]), ("in blocks", metrics["relative_l1_blocks"]),
        ("noise floor", floor["relative_l1"]), ("light in all", metrics["bias"]))]
    print(f"{name}, {results['model']} beside {results['reference_title']}: {verdict({**results, 'status': 'done'})}")
    print(f"{', '.join(numbers)}; {results['mask']['pixels']} texels; Cycles {results['reference_seconds']:.1f} s")
    print(f"{chosen.output.absolute().parent}: {', '.join(written)}", flush=True)
    return OK


def _share(value):
    return "unknown" if value is None else format(value, ".2%")


def _complain(error, code):
    sys.stderr.write(f"bake: {error}\n")
    return code


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    sys.stderr.flush()
    sys.exit(code)
