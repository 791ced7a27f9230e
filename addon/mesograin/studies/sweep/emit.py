# Scripts that run a sweep's cases elsewhere: a Slurm job array, or GNU parallel.
"""See `slurm` and `parallel`. A task is a group of cases that share a reference, so that each is rendered once."""
import shlex
import sys
from pathlib import Path

LARGEST_ARRAY = 1000
"""Slurm's default MaxArraySize allows tasks up to this; beyond, a task takes several groups."""


def command(plan, out, blender):
    """The shell words that run this sweep with the Python that runs now; nothing is built or installed on the way."""
    words = [sys.executable, Path(__file__).resolve().with_name("command.py"), Path(plan.path).resolve()]
    return shlex.join(map(str, [*words, "--out", Path(out).resolve(), "--blender", blender]))


def slurm(plan, out, words, workers):
    """Text of a job array script, at most `workers` tasks at a time. out: absolute. words: of `command`."""
    last = len(plan.groups) - 1
    tasks = min(last + 1, LARGEST_ARRAY)
    # Slurm replaces %-words in the name of the log.
    log = str(out / "slurm").replace("%", "%%")
    return f"""\
#!/bin/sh
# {_about(plan)}
# Submit: sbatch {shlex.quote(str(out / 'sweep.slurm'))}
# When all tasks have ended: {words} --merge
#SBATCH --job-name=mesograin-sweep
#SBATCH --array=0-{tasks - 1}%{workers}
#SBATCH --output="{log}-%A_%a.log"
failed=0
for group in $(seq "$SLURM_ARRAY_TASK_ID" {tasks} {last}); do
  {words} --group "$group" || failed=$?
done
exit $failed
"""


def parallel(plan, out, words, workers):
    """Text of a script for GNU parallel, at most `workers` tasks at a time; run again, it goes on where it stopped."""
    return f"""\
#!/bin/sh
# {_about(plan)}
# When it has ended: {words} --merge
seq 0 {len(plan.groups) - 1} | exec parallel --jobs {workers} --eta {words} --group '{{}}'
"""


def _about(plan):
    title = " ".join(plan.title.split())
    return f"{title}: {len(plan.cases)} cases in {len(plan.groups)} groups, each with a reference of its own."
