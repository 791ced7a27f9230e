# Scripts that run a sweep's cases elsewhere: a Slurm job array, or GNU parallel.
"""See `slurm` and `parallel`."""
import shlex
from pathlib import Path


def slurm(plan, out, launcher, workers):
    """Text of a job array script, one task a case, at most `workers` at a time; merge after it with --merge."""
    out = Path(out).resolve()
    return f"""\
#!/bin/sh
# {plan.title}: {len(plan.cases)} cases. Submit with: sbatch {shlex.quote(str(out / 'sweep.slurm'))}
#SBATCH --job-name=mesograin-sweep
#SBATCH --array=0-{len(plan.cases) - 1}%{workers}
#SBATCH --output={out}/slurm-%A_%a.log
exec {_case_command(plan, out, launcher)} --case "$SLURM_ARRAY_TASK_ID"
"""


def parallel(plan, out, launcher, workers):
    """Text of a script for GNU parallel; run again, it goes on where it stopped. Merge after it with --merge."""
    out = Path(out).resolve()
    return f"""\
#!/bin/sh
# {plan.title}: {len(plan.cases)} cases under GNU parallel.
seq 0 {len(plan.cases) - 1} | exec parallel --jobs {workers} --eta \\
  {_case_command(plan, out, launcher)} --case '{{}}'
"""


def _case_command(plan, out, launcher):
    words = [str(launcher), "sweep", str(Path(plan.path).resolve()), "--out", str(out)]
    return " ".join(shlex.quote(word) for word in words)
