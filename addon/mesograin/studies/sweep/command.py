# The command line of `sweep`: reads the plan, runs what is missing, merges and writes the page.
"""Run as `python3 command.py FILE.toml --out DIR`; see --help."""
import functools
import shlex
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))

from mesograin.command_line import batch  # noqa: E402
from mesograin.command_line.batch import DONE, FAILED, INTERRUPTED, UNWRITABLE, USAGE  # noqa: E402
from mesograin.studies.comparison import report_page  # noqa: E402
from mesograin.studies.sweep import arguments, emit, merge, plan, run  # noqa: E402
from mesograin.studies.sweep.folder import Folder  # noqa: E402

NAME = "sweep"
complain = functools.partial(batch.complain, NAME)


def main(words):
    chosen = arguments.build().parse_args(words)
    try:
        swept = plan.read(chosen.file)
    except plan.PlanError as error:
        return complain(error, USAGE)
    if chosen.list:
        group_of = {index: number for number, group in enumerate(swept.groups) for index in group}
        for index, case in enumerate(swept.cases):
            print(f"{index}\t{group_of[index]}\t{case.key}\t{case.label}")
        return DONE
    if chosen.jobs < 1:
        return complain(f"--jobs must be at least 1; got {chosen.jobs}.", USAGE)
    for option, count in (("case", len(swept.cases)), ("group", len(swept.groups))):
        number = getattr(chosen, option)
        if number is not None and not 0 <= number < count:
            return complain(f"--{option} must lie between 0 and {count - 1}; got {number}.", USAGE)

    folder = Folder(chosen.out)
    try:
        folder.create()
        if chosen.emit:
            return write_script(chosen, swept)
        return sweep(chosen, swept, folder)
    except OSError as error:
        return complain(
            f"The sweep's folder '{chosen.out}' cannot be written: {error.strerror or error}.", UNWRITABLE
        )


def sweep(chosen, swept, folder):
    failed = 0
    if not chosen.merge:
        if shutil.which(chosen.blender) is None:
            return complain(
                f"A sweep needs Blender; there is none at '{chosen.blender}'. Name it with --blender.", USAGE
            )
        try:
            _, failed = run.run(swept, asked_groups(chosen, swept), folder, chosen.blender, chosen.jobs, say)
        except run.Interrupted:
            return complain(
                "Interrupted; what is finished stays, and the same command goes on from there.", INTERRUPTED
            )
    if chosen.case is None and chosen.group is None:
        rows, missing = merge.merge(swept, folder)
        merge.describe(swept, folder, shlex.join(["./mesograin", "sweep", chosen.file, "--out", str(chosen.out)]))
        print(f"{len(rows)} results in {folder.out / 'results.csv'}")
        if rows and not chosen.no_report:
            try:
                print(f"The page: {report_page.write(folder.out)}")
            except report_page.ReportError as error:
                return complain(f"no report: {error}", FAILED)
        if missing and chosen.merge:
            print(f"{len(missing)} of {len(swept.cases)} cases have no result yet, such as: {missing[0].label}")
            failed = failed or len(missing)
    return FAILED if failed else DONE


def say(line):
    print(line, flush=True)


def asked_groups(chosen, swept):
    """The groups of case indices that this run is about."""
    if chosen.case is not None:
        return ((chosen.case,),)
    return swept.groups if chosen.group is None else (swept.groups[chosen.group],)


def write_script(chosen, swept):
    blender = shutil.which(chosen.blender)
    if blender is None:
        sentence = f"The script needs Blender; there is none at '{chosen.blender}'. Name it with --blender."
        return complain(sentence, USAGE)
    make = {"slurm": emit.slurm, "parallel": emit.parallel}[chosen.emit]
    path = chosen.out / {"slurm": "sweep.slurm", "parallel": "sweep-parallel.sh"}[chosen.emit]
    text = make(swept, chosen.out.resolve(), emit.command(swept, chosen.out, blender), chosen.jobs)
    path.write_text(text, encoding="utf-8")
    path.chmod(0o755)
    print(path)
    return DONE


if __name__ == "__main__":
    batch.main(NAME, main, "Interrupted.")
