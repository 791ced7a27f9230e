# The trade curve as a command: blender -b --factory-startup --python THIS -- [SCENE.blend] [OPTION ...]
"""Puts the add-on into a Blender without window, measures, writes the page; the exit code says how it went."""

import shlex
import sys
from pathlib import Path

ADDON = Path(__file__).resolve().parents[1]


def _run(chosen, words):
    from mesograin.comparison import report_page
    from mesograin.comparison.command_line import FAILED, NO_OUTPUT, OK, CommandError, open_scene

    native = open_scene(chosen.scene)

    from mesograin.comparison.progress import Progress
    from mesograin.comparison.results import OutputError
    from mesograin.cycles.cache import Cache
    from mesograin.cycles.reference import ReferenceError
    from mesograin.cycles.stage import StageError
    from mesograin.trade.measure import Request, measure

    try:
        cache = Cache(chosen.cache, chosen.cache_limit)
    except ValueError as error:
        raise CommandError(error) from error
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
        raise CommandError(error, NO_OUTPUT) from error
    except (native.Error, ReferenceError, StageError) as error:
        raise CommandError(error) from error
    finally:
        progress.close()
    for entry in results["summary"]:
        print(entry["sentence"])
    try:
        page = report_page.write(chosen.out)
    except report_page.ReportError as error:
        raise CommandError(f"no report: {error}", FAILED) from error
    print(f"Results: {page.absolute()}", flush=True)
    return OK


if __name__ == "__main__":
    sys.path.insert(0, str(ADDON.parent))
    from mesograin.comparison import command_line
    from mesograin.trade import arguments

    command_line.main("trade", arguments.parse, _run)
