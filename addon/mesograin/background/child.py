# The background Blender's side: blender -b --factory-startup --python THIS -- TASK.json
"""Loads the add-on that this file belongs to, compares what the task says, and tells of it on standard output."""

import dataclasses
import json
import os
import shutil
import signal
import sys
import threading
import time
from pathlib import Path

ADDON = Path(__file__).resolve().parents[1]


class Channel:
    """Where events go: the standard output that there was at the start, since Cycles' own words are diverted."""

    def __init__(self):
        self._file = os.dup(1)

    def send(self, event, **values):
        from mesograin.background import protocol

        os.write(self._file, protocol.encode(event, **values))


def remove(folders):
    for folder in folders:
        shutil.rmtree(folder, ignore_errors=True)


def end_with_parent(folders):
    """Ends this process once its standard input ends, because the parent is gone; what it wrote goes with it."""

    def watch():
        while os.read(0, 4096):
            pass
        # First, because the signal ends the process at once while Cycles renders, and then nothing else is written.
        remove(folders)
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(1.0)
        remove(folders)
        os._exit(128 + signal.SIGTERM)

    threading.Thread(target=watch, daemon=True).start()


def main():
    """Returns the exit code."""
    task = json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text())
    end_with_parent(task["folders"])
    sys.path.insert(0, str(ADDON.parent))
    from mesograin.command_line import interruption

    channel = Channel()
    with interruption.Interruption() as interrupted:
        try:
            return compare(task, channel)
        except KeyboardInterrupt:
            remove(task["folders"])
            return interrupted.code


def compare(task, channel):
    import addon_utils
    import bpy
    import mesograin

    addon_utils.enable("cycles")
    if not hasattr(bpy.types.Scene, "mesograin"):
        mesograin.register()

    from mesograin import scripting
    from mesograin.background import snapshot

    try:
        snapshot.load(task["file"])
        found = scripting.compare(**task["arguments"],
                                  on_progress=lambda step: channel.send("step", **dataclasses.asdict(step)))
    except (scripting.ComparisonError, RuntimeError) as error:
        channel.send("failed", text=" ".join(str(error).split()))
        return 1
    for sentence in found.warnings:
        channel.send("sentence", text=sentence)
    channel.send("done")
    return 0


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    # What Blender frees at its end is not worth waiting for.
    os._exit(code)
