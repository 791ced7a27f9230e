# The background Blender's side: blender -b --factory-startup --python THIS -- TASK.json
"""Loads the add-on that this file belongs to, does what the task says, and tells of it on standard output."""

import dataclasses
import json
import os
import shutil
import signal
import sys
import threading
import time
from pathlib import Path

ADDON = Path(__file__).resolve().parents[2]


class Channel:
    """Where events go: the standard output that there was at the start, since Cycles' own words are diverted."""

    def __init__(self):
        self._file = os.dup(1)

    def send(self, event, **values):
        from mesograin.studies.background import protocol

        os.write(self._file, protocol.encode(event, **values))

    def step(self, step):
        """Tells of a `progress.Step`."""
        self.send("step", **dataclasses.asdict(step))

    def sentence(self, sentence):
        self.send("sentence", text=sentence)


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
            return work(task, channel)
        except KeyboardInterrupt:
            remove(task["folders"])
            return interrupted.code


def work(task, channel):
    import addon_utils
    import bpy
    import mesograin

    addon_utils.enable("cycles")
    if not hasattr(bpy.types.Scene, "mesograin"):
        mesograin.register()

    from mesograin.studies import scripting
    from mesograin.studies.background import snapshot
    from mesograin.studies.baking.surface import BakeError

    try:
        snapshot.load(task["file"])
        WORKS[task["work"]](channel, **task["arguments"])
    except (scripting.ComparisonError, BakeError, RuntimeError) as error:
        channel.send("failed", text=" ".join(str(error).split()))
        return 1
    channel.send("done")
    return 0


def compare(channel, **arguments):
    """Of pictures; the arguments are those of `scripting.compare`."""
    from mesograin.studies import scripting

    for sentence in scripting.compare(**arguments, on_progress=channel.step).warnings:
        channel.sentence(sentence)


def bake(channel, **arguments):
    """Of textures; the arguments are those of `baking.beside.bake`."""
    from mesograin.studies.baking import beside

    beside.bake(**arguments, on_step=channel.step, on_sentence=channel.sentence)


def match(channel, **arguments):
    """Of coefficients to a picture; the arguments are those of `match.run.match_image`."""
    from mesograin.studies.match import run

    run.match_image(**arguments, on_step=channel.step, on_sentence=channel.sentence)


WORKS = {"compare": compare, "bake": bake, "match": match}


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    # What Blender frees at its end is not worth waiting for.
    os._exit(code)
