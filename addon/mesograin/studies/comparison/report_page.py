# Has the system's Python write report.html beside a comparison's results: the add-on itself needs no more than numpy.
"""See `write`."""

import os
import shutil
import subprocess
from pathlib import Path

BUILDER = Path(__file__).resolve().parents[2] / "report" / "build.py"


class ReportError(Exception):
    """There is no report; one sentence, or several lines of the Python that was asked."""


def write(folder):
    """Writes `folder`/report.html and returns its path. folder: of a results.json and its pictures.

    The Python is MESOGRAIN_PYTHON, else the system's; it needs jinja2, matplotlib and numpy. Raises ReportError.
    """
    python = os.environ.get("MESOGRAIN_PYTHON") or shutil.which("python3", path="/usr/bin:/usr/local/bin") or "python3"
    # Blender's own Python must not lead another one to its modules.
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONHOME", "PYTHONPATH")}
    try:
        done = subprocess.run([python, str(BUILDER), str(folder)], env=environment, capture_output=True, text=True)
    except OSError as error:
        raise ReportError(f"{python} cannot be run ({error.strerror}): set MESOGRAIN_PYTHON.") from error
    if done.returncode != 0:
        raise ReportError(done.stderr.strip() or f"{python} ended with exit code {done.returncode}.")
    return Path(folder) / "report.html"
