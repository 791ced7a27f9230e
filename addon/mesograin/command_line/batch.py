# What commands share that run Blenders of their own, here or by a batch system: their options, their end, exit codes.
"""See `add_blender`, `add_emit`, `main` and `start`. Readable without Blender."""

import os
import shutil
import signal
import subprocess
import sys

DONE, FAILED, USAGE, UNWRITABLE, INTERRUPTED = 0, 1, 2, 3, 130
"""Exit codes."""


def add_jobs(parser, what):
    """--jobs. what: of which so many run side by side."""
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help=what)


def add_blender(parser):
    """--blender."""
    parser.add_argument(
        "--blender",
        default=os.environ.get("MESOGRAIN_BLENDER", "blender"),
        metavar="PATH",
        help="Blender's executable (default: MESOGRAIN_BLENDER, or blender)",
    )


def add_emit(parser, what):
    """--emit. what: it does with a script, and for what."""
    parser.add_argument(
        "--emit",
        choices=("slurm", "parallel"),
        help=f"{what} as a Slurm job array or under GNU parallel, and run nothing",
    )


def main(name, run, interrupted):
    """Ends the process with the exit code of run(words). interrupted: what to say after Ctrl-C, or after the signal by
    which a batch system ends a job."""
    def interrupt(*_):
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, interrupt)
    try:
        sys.exit(run(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(complain(name, interrupted, INTERRUPTED))


def complain(name, sentence, code):
    """One sentence on standard error; returns the code."""
    print(f"{name}: {sentence}", file=sys.stderr)
    return code


def start(blender, script, words):
    """The process of a Blender without a window that runs a script, with its output in a pipe, and in a session of its
    own, so that all of it can be ended; where the system can, it also ends when this process is killed and cannot end
    it."""
    command = [blender, "--background", "--factory-startup", "--python-exit-code", "1", "--python", str(script), "--",
               *words]
    if shutil.which("setpriv"):
        command = ["setpriv", "--pdeathsig", "KILL", *command]
    return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            text=True, errors="replace", start_new_session=True)
