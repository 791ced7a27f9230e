# Starts work on a copy of the open file in a background Blender.
"""See `launch`."""

import json
import shutil
import tempfile
from pathlib import Path

import bpy

from . import snapshot
from .job import Job

CHILD = Path(__file__).resolve().parent / "child.py"


def launch(work, out, **arguments):
    """Copies the open file, starts a Blender that works on it, and returns its `Job`.

    work: of `child.WORKS`. out: folder for all files, without '//'. arguments: of that work, plain values.
    Raises OSError or RuntimeError with a reason if nothing could be started.
    """
    folder = Path(tempfile.mkdtemp(prefix="mesograin-"))
    try:
        saved = snapshot.save(folder)
        job = Job(folder, out)
        task = folder / "task.json"
        task.write_text(json.dumps({"file": saved, "work": work, "arguments": {**arguments, "out": str(job.staging)},
                                    "folders": [str(folder), str(job.staging)]}))
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    # Factory settings: what other add-ons do at start-up is none of a measurement's business.
    job.start([bpy.app.binary_path, "--background", "--factory-startup", "--python", str(CHILD), "--", str(task)])
    return job
