# The command line of `sweep`: reads the plan, runs what is missing, merges and plots.
"""Run as `python3 command.py FILE.toml --out DIR`; see --help."""
import argparse
import os
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from sweep import emit, merge, plan, plots, run  # noqa: E402
from sweep.folder import Folder  # noqa: E402

LAUNCHER = Path(__file__).resolve().parents[3] / "mesograin"
DONE, FAILED, USAGE, UNWRITABLE, INTERRUPTED = 0, 1, 2, 3, 130


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one sentence."""

    def error(self, message):
        self.exit(USAGE, f"sweep: {message}; see --help.\n")


def parser():
    made = Parser(
        prog="mesograin sweep",
        description="Compares every case of a sweep file: one case one folder, resumable, failures recorded.",
        epilog="Exit codes: 0 all cases done, 1 some failed (the others are there), 2 bad arguments or sweep file, "
        "3 the output folder cannot be written, 130 interrupted. Run again, it does only what is missing.",
    )
    made.add_argument("file", help="the sweep, a TOML file (docs/sweeps.md)")
    made.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for cases, tables and plots")
    made.add_argument(
        "--jobs", type=int, default=1, metavar="N", help="cases side by side (default: 1; Cycles uses all cores)"
    )
    made.add_argument(
        "--blender",
        default=os.environ.get("MESOGRAIN_BLENDER", "blender"),
        metavar="PATH",
        help="Blender's executable (default: MESOGRAIN_BLENDER, or blender)",
    )
    made.add_argument("--case", type=int, metavar="I", help="run case I alone, counted from 0, and do not merge")
    made.add_argument("--list", action="store_true", help="print the cases and run none")
    made.add_argument("--merge", action="store_true", help="merge and plot what is there and run nothing")
    made.add_argument(
        "--emit",
        choices=("slurm", "parallel"),
        help="write a script that runs the cases as a Slurm job array or under GNU parallel, and run nothing",
    )
    return made


def main(words):
    chosen = parser().parse_args(words)
    try:
        swept = plan.read(chosen.file)
    except plan.PlanError as error:
        return complain(error, USAGE)
    if chosen.list:
        for index, case in enumerate(swept.cases):
            print(f"{index}\t{case.key}\t{case.label}")
        return DONE
    if chosen.jobs < 1:
        return complain(f"--jobs must be at least 1; got {chosen.jobs}.", USAGE)
    if chosen.case is not None and not 0 <= chosen.case < len(swept.cases):
        return complain(f"--case must lie between 0 and {len(swept.cases) - 1}; got {chosen.case}.", USAGE)

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
        cases = swept.cases if chosen.case is None else (swept.cases[chosen.case],)
        try:
            _, failed = run.run(cases, folder, chosen.blender, chosen.jobs, lambda line: print(line, flush=True))
        except run.Interrupted:
            return complain(
                "Interrupted; what is finished stays, and the same command goes on from there.", INTERRUPTED
            )
    if chosen.case is None:
        rows, missing = merge.merge(swept, folder)
        pictures = plots.draw(swept, rows, folder.out)
        print(f"{len(rows)} results in {folder.out / 'results.csv'}, {len(pictures)} plots beside it")
        if missing and chosen.merge:
            print(f"{len(missing)} of {len(swept.cases)} cases have no result yet, such as: {missing[0].label}")
            failed = failed or len(missing)
    return FAILED if failed else DONE


def write_script(chosen, swept):
    make = {"slurm": emit.slurm, "parallel": emit.parallel}[chosen.emit]
    path = chosen.out / {"slurm": "sweep.slurm", "parallel": "sweep-parallel.sh"}[chosen.emit]
    path.write_text(make(swept, chosen.out, LAUNCHER, chosen.jobs), encoding="utf-8")
    path.chmod(0o755)
    print(path)
    return DONE


def complain(sentence, code):
    print(f"sweep: {sentence}", file=sys.stderr)
    return code


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(complain("Interrupted.", INTERRUPTED))
