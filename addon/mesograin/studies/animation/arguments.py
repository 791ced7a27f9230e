# The command line of `animate`, readable without Blender, and the words for the Blender that renders.
"""See `build` and `build_frames`."""

import argparse
import re
from pathlib import Path

from ...command_line import batch
from ...command_line.parser import Parser


def build():
    """The parser of `animate`."""
    made = Parser(
        prog="./mesograin animate",
        description="Renders the frames of an animation with the scene's own settings. Frames that are there whole are "
        "left alone, each other is written under a name of its own and renamed when it is whole.",
        epilog="Exit codes: 0 all frames are there, 1 some failed, 2 bad arguments or scene, 3 the folder cannot be "
        "written, 130 interrupted. Run again, it does only what is missing.",
    )
    made.add_argument("scene", type=Path, metavar="SCENE.blend", help="the scene")
    _add_frames(made)
    batch.add_jobs(made, "Blenders side by side (default: 1, which takes all cores)")
    batch.add_blender(made)
    made.add_argument("--part", type=part, default=None, metavar="I/N",
                      help="render part I of N alone, counted from 0: every Nth frame")
    made.add_argument("--list", action="store_true", help="print frame, file and whether it is there; render none")
    batch.add_emit(made, "print a script that renders the frames")
    made.add_argument("--tasks", type=int, default=None, metavar="N",
                      help="with --emit: into how many tasks the frames are divided (default: one each, at most 1000)")
    return made


def build_frames():
    """The parser of what the Blender that renders is told."""
    made = Parser(prog="frames", description="Renders frames of the open scene.")
    _add_frames(made)
    made.add_argument("--part", type=part, default=(0, 1))
    made.add_argument("--scene-file", type=Path, default=None)
    made.add_argument("--list", action="store_true")
    return made


def _add_frames(made):
    made.add_argument("--frames", type=frames, default=None, metavar="WHICH",
                      help="such as 1-250, 1-250x2 for every other, or 3,7,20-25 (default: the scene's)")
    made.add_argument("--out", default=None, metavar="PATH",
                      help="where frames go, # for digits, as Blender's output path (default: the scene's)")


def frames(text):
    """[frame numbers] of a word, each once and in order."""
    found = set()
    for word in text.split(","):
        parts = re.fullmatch(r"(-?\d+)(?:-(-?\d+)(?:x(\d+))?)?", word.strip())
        if not parts:
            raise argparse.ArgumentTypeError(f"frames such as 1-250, 1-250x2 or 3,7,20-25 are needed, '{text}' came")
        first, last, step = int(parts[1]), int(parts[2] or parts[1]), int(parts[3] or 1)
        if last < first or step < 1 or last - first > 1 << 20:
            raise argparse.ArgumentTypeError(f"frames from a first to a later last are needed, '{word}' came")
        found.update(range(first, last + 1, step))
    return sorted(found)


def part(text):
    """(I, N) of I/N."""
    parts = re.fullmatch(r"(\d+)/(\d+)", text)
    if not parts or not int(parts[1]) < int(parts[2]):
        raise argparse.ArgumentTypeError(f"I/N with I from 0 to N - 1 is needed, '{text}' came")
    return int(parts[1]), int(parts[2])


def words_of(chosen):
    """The words that say --frames and --out again."""
    words = [] if chosen.frames is None else ["--frames=" + ",".join(map(str, chosen.frames))]
    return words if chosen.out is None else [*words, "--out", chosen.out]
