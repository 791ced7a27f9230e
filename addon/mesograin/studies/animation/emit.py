# Scripts that render an animation's frames elsewhere: a Slurm job array, or GNU parallel.
"""See `slurm` and `parallel`. A task is a part of the frames, every Nth, so that a slow stretch is shared by all."""
import shlex
import sys
from pathlib import Path

LARGEST_ARRAY = 1000
"""Slurm's default MaxArraySize allows tasks up to this."""


def command(chosen, words):
    """The shell words that render this animation with the Python that runs now; nothing is built on the way."""
    run = [sys.executable, Path(__file__).resolve().with_name("command.py"), chosen.scene.resolve(), *words]
    return shlex.join(map(str, [*run, "--blender", chosen.blender]))


def slurm(chosen, count, tasks, words):
    """Text of a job array script of so many tasks, --jobs at a time if it is above 1."""
    folder = chosen.scene.resolve().parent
    log = str(folder / f"{chosen.scene.stem}-%A_%a.log".replace("%A", "\0A").replace("%a", "\0a"))
    log = log.replace("%", "%%").replace("\0", "%")  # Slurm replaces %-words in the name of the log
    return f"""\
#!/bin/sh
# {_about(chosen, count, tasks)}
# Submitted again, it renders what is missing.
#SBATCH --job-name=mesograin-animate
#SBATCH --array=0-{tasks - 1}{f"%{chosen.jobs}" if chosen.jobs > 1 else ""}
#SBATCH --output="{log}"
exec {command(chosen, words)} --part "$SLURM_ARRAY_TASK_ID/{tasks}"
"""


def parallel(chosen, count, tasks, words):
    """Text of a script for GNU parallel, --jobs tasks at a time; run again, it goes on where it stopped."""
    return f"""\
#!/bin/sh
# {_about(chosen, count, tasks)}
seq 0 {tasks - 1} | exec parallel --jobs {chosen.jobs} --eta {command(chosen, words)} --part '{{}}/{tasks}'
"""


def _about(chosen, count, tasks):
    return " ".join(f"{chosen.scene.name}: {count} frames in {tasks} tasks.".split())
