# The comparison as a command: blender -b --factory-startup --python THIS -- [SCENE.blend] [OPTION ...]
"""Puts the add-on into a Blender without window, compares, writes the report; the exit code says how it went."""

import shlex
import sys
from pathlib import Path

ADDON = Path(__file__).resolve().parents[2]


def _run(chosen, words):
    from mesograin.command_line.process import FAILED, NO_OUTPUT, OK, CommandError, complain
    from mesograin.command_line.process import open_cache, open_scene, told

    native = open_scene(chosen.scene)

    from mesograin.studies.comparison.progress import Progress
    from mesograin.studies.comparison.results import OutputError
    from mesograin.studies.comparison.run import Request, cases, compare

    cache = open_cache(chosen)
    if chosen.clear_cache:
        try:
            count, size = cache.clear()
        except OSError as error:
            raise CommandError(f"The reference cache cannot be emptied: {error}.", NO_OUTPUT) from error
        print(f"{count} references removed from {cache.folder}, {size / 2**20:.1f} MiB.")
        return OK
    if not cases(chosen.models, chosen.references, chosen.part):
        of = f"the {chosen.part} part of " if chosen.part else ""
        asked = f"of the references {', '.join(chosen.references)} " if chosen.references else "of the references "
        raise CommandError(f"None {asked}answers {of}{', '.join(chosen.models)}.")

    request = Request(
        models=tuple(chosen.models),
        references=chosen.references and tuple(chosen.references),
        out=chosen.out,
        size=chosen.size,
        samples=chosen.samples,
        reference_samples=chosen.reference_samples,
        seeds=chosen.seeds,
        until=chosen.until,
        most_seeds=chosen.most_seeds,
        masks=tuple(chosen.masks),
        part=chosen.part,
        controls=chosen.controls,
        settings=chosen.settings,
        exchange=chosen.exchange,
        frames=chosen.frames,
        cache=cache,
        command=_command(words),
    )
    progress = Progress()
    with told(progress, OutputError, (native.Error,)):
        results = compare(request, progress)
    _print_table(results)
    written = chosen.no_report or _write_report(chosen.out)
    print(f"Results: {Path(chosen.out).absolute()}", flush=True)
    failed = [f"{case['name']}: {case['error']}" for case in results["cases"] if case["status"] != "done"]
    for sentence in failed:
        complain("compare", sentence)
    return FAILED if failed or not written else OK


def _command(words):
    """The line that repeats this comparison, from the repository's root."""
    return shlex.join(["./mesograin", "compare", *words])


def _print_table(results):
    """What matters most of each case; the rest is in the files."""
    titles = ("off in blocks", "relative L1", "noise floor", "bias", "ms/frame", "Cycles s", "significant")
    print(f"{'case':<32}" + "".join(f"{title:>{width}}" for title, width in zip(titles, (15, 13, 13, 8, 10, 10, 13))))
    for case in results["cases"]:
        if case["status"] != "done":
            print(f"{case['name']:<32}{'failed':>15}")
            continue
        metrics, floor = case["metrics"], case["noise_floor"]
        # First what noise does not explain, if one seed alone did not leave that unknown.
        off = metrics["relative_l1_blocks_corrected"]
        off = metrics["relative_l1_blocks"] if off is None else off
        numbers = (off, metrics["relative_l1"], floor["relative_l1"])
        shares = "".join(
            f"{'-' if value is None else format(value, '.2%'):>{width}}" for value, width in zip(numbers, (15, 13, 13))
        )
        bias = "-" if metrics["bias"] is None else f"{metrics['bias']:.4f}"
        test = case["significance"]
        significant = "-" if test is None else _significant(test)
        print(
            f"{case['name']:<32}{shares}{bias:>8}{case['frame_ms']:>10.2f}{case['reference_seconds']:>10.1f}"
            f"{significant:>13}"
        )


def _significant(test):
    """What the significance test found, in a few letters."""
    in_blocks = test["share_blocks"] or 0.0
    if not test["significant_pixels"] and not test["significant_blocks"]:
        return "nothing"
    return f"{test['share']:.1%} px" if test["share"] >= in_blocks else f"{in_blocks:.0%} blocks"


def _write_report(folder):
    """Whether report.html was written; if not, the reason stands on standard error."""
    from mesograin.studies.comparison import report_page

    try:
        report_page.write(folder)
    except report_page.ReportError as error:
        sys.stderr.write(f"compare: no report: {error}\n")
        return False
    return True


if __name__ == "__main__":
    sys.path.insert(0, str(ADDON.parent))
    from mesograin.command_line import process
    from mesograin.studies.comparison import arguments

    process.main("compare", arguments.parse, _run)
