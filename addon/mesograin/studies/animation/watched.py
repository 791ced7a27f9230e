# Blenders that render frames, side by side: what they tell as it comes, and nothing of them left at the end.
"""See `events` and `side_by_side`."""
import json
import os
import queue
import signal
import subprocess
import threading
from pathlib import Path

from ...command_line import batch
from . import frames
from .arguments import words_of

PATIENCE_SECONDS = 5.0
"""What a Blender is given to end by itself, before it is killed."""


def events(chosen, words):
    """Yields what one Blender tells, and {"code", "last"} at its end: its exit code and its last line."""
    yield from side_by_side(chosen, [words])


def side_by_side(chosen, jobs):
    """The same of a Blender for each of `jobs`, words each. Whatever ends the loop, they and their half files are gone
    afterwards."""
    told, partials, running, readers = queue.SimpleQueue(), set(), [], []
    try:
        for words in jobs:
            running.append(batch.start(chosen.blender, Path(frames.__file__).resolve(),
                                       ["--scene-file", str(chosen.scene), *words_of(chosen), *words]))
            readers.append(threading.Thread(target=_read, args=(running[-1], told, partials), daemon=True))
            readers[-1].start()
        left = len(jobs)
        while left:
            event = told.get()
            left -= "code" in event
            yield event
    finally:
        _end(running)
        for reader in readers:
            reader.join(PATIENCE_SECONDS)
        for partial in partials:
            partial.unlink(missing_ok=True)


def _read(process, told, partials):
    last = ""
    for line in process.stdout:
        if line.startswith(frames.PREFIX):
            event = json.loads(line.removeprefix(frames.PREFIX))
            if "partial" in event:
                partials.add(Path(event["partial"]))
            told.put(event)
        elif line.strip() and not line.startswith("Blender quit"):
            last = line.strip()
    told.put({"code": process.wait(), "last": last})


def _end(running):
    for process in running:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGTERM)
    for process in running:
        try:
            process.wait(PATIENCE_SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
