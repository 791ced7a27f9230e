# The command line of `animate`: Blenders that render frames, watched, with the time that is left; or a script for many.
"""Run as `python3 command.py SCENE.blend`; see --help."""
import functools
import shutil
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))

from mesograin.command_line import batch  # noqa: E402
from mesograin.command_line.batch import DONE, FAILED, USAGE  # noqa: E402
from mesograin.durations import duration  # noqa: E402
from mesograin.studies.animation import arguments, emit, watched  # noqa: E402

NAME = "animate"
complain = functools.partial(batch.complain, NAME)


def main(words):
    chosen = arguments.build().parse_args(words)
    if not chosen.scene.is_file():
        return complain(f"there is no scene '{chosen.scene}'.", USAGE)
    if chosen.jobs < 1 or (chosen.tasks is not None and chosen.tasks < 1):
        return complain("--jobs and --tasks must be at least 1.", USAGE)
    blender = shutil.which(chosen.blender)
    if blender is None:
        return complain(f"Frames need Blender; there is none at '{chosen.blender}'. Name it with --blender.", USAGE)
    chosen.blender = blender
    if chosen.list or chosen.emit:
        return listed(chosen)
    return render(chosen)


def listed(chosen):
    found, code = [], DONE
    for event in watched.events(chosen, ["--list"]):
        if "complaint" in event:
            return complain(event["complaint"], event["exit"])
        if "frame" in event:
            found.append(event)
        code = event.get("code", code)
    if code:
        return complain(f"Blender ended with exit code {code} before it had told the frames.", FAILED)
    if chosen.list:
        for event in found:
            print(f"{event['frame']}\t{'there' if event['there'] else 'missing'}\t{event['file']}")
        return DONE
    tasks = min(chosen.tasks or emit.LARGEST_ARRAY, len(found))
    make = {"slurm": emit.slurm, "parallel": emit.parallel}[chosen.emit]
    print(make(chosen, len(found), tasks, arguments.words_of(chosen)), end="")
    return DONE


def render(chosen):
    first, parts = chosen.part or (0, 1)
    jobs = [["--part", f"{first + parts * job}/{parts * chosen.jobs}"] for job in range(chosen.jobs)]
    count, done, failed, code, started = 0, 0, 0, DONE, time.monotonic()
    for event in watched.side_by_side(chosen, jobs):
        if "complaint" in event:
            return complain(event["complaint"], event["exit"])
        if "frames" in event:
            count += event["frames"] - event["there"]
            if event["there"]:
                print(f"{event['there']} of {event['frames']} frames are there already", flush=True)
        elif "done" in event or "failed" in event:
            done += 1
            failed += "failed" in event
            left = (time.monotonic() - started) / done * (count - done)
            if "done" in event:
                what = f"frame {event['done']}: {event['file']}"
            else:
                what = f"frame {event['failed']} failed: {event['why']}"
            print(f"[{done}/{count}, about {duration(left)} left] {what}", flush=True)
        elif event.get("code") and not (event["code"] == FAILED and failed):
            code = FAILED
            complain(f"Blender ended with exit code {event['code']}; it last said: {event['last']}", code)
    return FAILED if failed else code


if __name__ == "__main__":
    batch.main(NAME, main, "Interrupted; frames that are done stay, and the same command goes on from there.")
