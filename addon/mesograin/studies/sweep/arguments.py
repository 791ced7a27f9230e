# The command line of `sweep`, readable without Blender.
"""See `build`."""

from pathlib import Path

from ...command_line import batch
from ...command_line.parser import Parser


def build():
    """The parser."""
    made = Parser(
        prog="./mesograin sweep",
        description="Compares every case of a sweep file: one case one folder, resumable, failures recorded.",
        epilog="Exit codes: 0 all cases done, 1 some failed (the others are there), 2 bad arguments or sweep file, "
        "3 the output folder cannot be written, 130 interrupted. Run again, it does only what is missing.",
    )
    made.add_argument("file", help="the sweep, a TOML file (docs/sweeps.md)")
    made.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for cases, tables and plots")
    batch.add_jobs(made, "cases side by side (default: 1; Cycles uses all cores)")
    batch.add_blender(made)
    made.add_argument("--case", type=int, metavar="I", help="run case I alone, counted from 0, and do not merge")
    made.add_argument(
        "--group",
        type=int,
        metavar="I",
        help="run only the cases of group I, which share a reference, counted from 0, and do not merge",
    )
    made.add_argument("--no-report", action="store_true", help="write the tables, no page and no plots")
    made.add_argument("--list", action="store_true", help="print the cases and run none")
    made.add_argument("--merge", action="store_true", help="merge what is there, write the page and run nothing")
    batch.add_emit(made, "write a script that runs the cases")
    return made
