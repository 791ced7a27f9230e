# The trade curve as a command: blender -b --factory-startup --python THIS -- [SCENE.blend] [OPTION ...]
"""Puts the add-on into a Blender without window, measures, writes the page; the exit code says how it went."""

import shlex
import sys
from pathlib import Path

ADDON = Path(__file__).resolve().parents[1]
OK, FAILED, BAD_INPUT, NO_OUTPUT = 0, 1, 2, 3


def main():
    """Returns the exit code; every problem is one sentence on standard error."""
    sys.path.insert(0, str(ADDON.parent))
    from mesograin.comparison import interruption
    from mesograin.trade import arguments

    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    chosen = arguments.parse(words)
    with interruption.Interruption() as interrupted:
        try:
            return _run(chosen, words)
        except KeyboardInterrupt:
            sys.stderr.write(f"\n{interruption.INTERRUPTED}\n")
            return interrupted.code


def _run(chosen, words):
    import addon_utils
    import bpy
    import mesograin
    from mesograin import native_module

    addon_utils.enable("cycles")
    if not hasattr(bpy.types.Scene, "mesograin"):
        mesograin.register()
    if chosen.scene:
        # Only now, so that the file finds its engine and its properties.
        try:
            bpy.ops.wm.open_mainfile(filepath=str(chosen.scene.absolute()), load_ui=False)
        except RuntimeError as error:
            reason = " ".join(str(error).split()).removeprefix("Error: ")
            return _complain(f"{chosen.scene} cannot be opened: {reason}", BAD_INPUT)

    from mesograin.comparison import report_page
    from mesograin.comparison.progress import Progress
    from mesograin.comparison.results import OutputError
    from mesograin.cycles.cache import Cache
    from mesograin.cycles.reference import ReferenceError
    from mesograin.cycles.stage import StageError
    from mesograin.trade.measure import Request, measure

    try:
        native = native_module.get()
        cache = Cache(chosen.cache, chosen.cache_limit)
    except (ValueError, native_module.Unavailable) as error:
        return _complain(error, BAD_INPUT)
    progress = Progress()
    try:
        results = measure(
            Request(
                out=chosen.out,
                reference=chosen.reference,
                models=chosen.models,
                samples=chosen.samples,
                taps=chosen.taps,
                reference_samples=chosen.reference_samples,
                cycles_samples=chosen.cycles_samples,
                size=chosen.size,
                frames=chosen.frames,
                settings=chosen.settings,
                cache=cache,
                command=shlex.join(["./mesograin", "trade", *words]),
            ),
            progress,
        )
    except OutputError as error:
        return _complain(error, NO_OUTPUT)
    except (native.Error, ReferenceError, StageError) as error:
        return _complain(error, BAD_INPUT)
    finally:
        progress.close()
    for entry in results["summary"]:
        print(entry["sentence"])
    try:
        page = report_page.write(chosen.out)
    except report_page.ReportError as error:
        return _complain(f"no report: {error}", FAILED)
    print(f"Results: {page.absolute()}", flush=True)
    return OK


def _complain(error, code):
    sys.stderr.write(f"trade: {error}\n")
    return code


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    sys.stderr.flush()
    sys.exit(code)
