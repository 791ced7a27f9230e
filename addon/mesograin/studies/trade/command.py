# The trade curve as a command: blender -b --factory-startup --python THIS -- [SCENE.blend] [OPTION ...]
"""Puts the add-on into a Blender without window, measures, writes the page; the exit code says how it went."""

import shlex
import sys
from pathlib import Path

ADDON = Path(__file__).resolve().parents[2]


def _run(chosen, words):
    from mesograin.command_line.process import FAILED, OK, CommandError, open_cache, open_scene, told
    from mesograin.studies.comparison import report_page

    native = open_scene(chosen.scene)

    from mesograin.cycles.reference import ReferenceError
    from mesograin.cycles.stage import StageError
    from mesograin.studies.comparison.progress import Progress
    from mesograin.studies.comparison.results import OutputError
    from mesograin.studies.trade.measure import Request, measure

    cache = open_cache(chosen)
    progress = Progress()
    with told(progress, OutputError, (native.Error, ReferenceError, StageError)):
        results = measure(
            Request(
                out=chosen.out,
                reference=chosen.reference,
                models=chosen.models,
                samples=chosen.samples,
                taps=chosen.taps,
                reference_samples=chosen.reference_samples,
                traced_samples=chosen.traced_samples,
                size=chosen.size,
                frames=chosen.frames,
                settings=chosen.settings,
                exchange=chosen.exchange,
                cache=cache,
                command=shlex.join(["./mesograin", "trade", *words]),
            ),
            progress,
        )
    for entry in (*results["summary"], *results["summary_shown"]):
        print(entry["sentence"])
    try:
        page = report_page.write(chosen.out)
    except report_page.ReportError as error:
        raise CommandError(f"no report: {error}", FAILED) from error
    print(f"Results: {page.absolute()}", flush=True)
    return OK


if __name__ == "__main__":
    sys.path.insert(0, str(ADDON.parent))
    from mesograin.command_line import process
    from mesograin.studies.trade import arguments

    process.main("trade", arguments.parse, _run)
