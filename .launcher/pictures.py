"""Makes the documentation's pictures anew, and the lines of its pages that tell what was measured in them.

    pictures.py BUILD BLENDER LOGS FOLDER [NAME ...]

Each is made by commands that stand on its page; what they render of Cycles and trace of photons stays in FOLDER, and is
not made again as long as it lies there.
"""
import dataclasses
import os
import pathlib
import shutil
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "addon"))

from mesograin.durations import duration  # noqa: E402

PYTHON = "/usr/bin/python3"
LAUNCHER = SOURCE / "mesograin"
IMAGES = SOURCE / "docs/images"


@dataclasses.dataclass(frozen=True)
class Workplace:
    """Where commands find what they need, and leave what they make."""

    build: pathlib.Path
    blender: str
    logs: pathlib.Path
    folder: pathlib.Path

    def in_blender(self, script, *words):
        """What runs a script of docs inside Blender, its chatter in a log."""
        return [PYTHON, SOURCE / ".launcher/run_blender.py", self.logs / f"{script}.log", self.blender, "--background",
                "--factory-startup", "--python-exit-code", "1", "--python", SOURCE / f"docs/{script}.py", "--", *words]


@dataclasses.dataclass(frozen=True)
class Picture:
    """sentence: what is seen. minutes: on two cores, from nothing. commands: a function of a Workplace. images: a
    pattern of those in docs/images. kept: the file in the folder that becomes the image, where no command writes it."""

    sentence: str
    minutes: float
    commands: object
    images: str
    kept: str = ""


def tutorial(at):
    return [at.in_blender("make_tutorial")]


def gallery(at):
    return [at.in_blender("make_gallery", "--keep", at.folder / "gallery")]


def crystals(at):
    return [at.in_blender("make_crystals", "--keep", at.folder / "crystals")]


def scenes(at):
    return [at.in_blender("make_side_by_side")]


def heaps(at):
    """Three comparisons, which share Cycles' pictures."""
    kinds = ("volume_index_matched", "volume_lambert", "subsurface")
    made = {way: at.folder / f"heaps_{way}" for way in ("off", "heaps", "gathered")}
    compare = [LAUNCHER, "compare", "--blender", at.blender, SOURCE / "blend_files/heap.blend", "--models", "model_2",
               "--references", *kinds, "--size", "400x400", "--samples", "16", "--reference-samples", "8", "--seeds",
               "2", "--cache", at.folder / "cycles"]
    return [*([*compare, "--exchange", way, "--out", out] for way, out in made.items()),
            [PYTHON, SOURCE / "docs/make_heap_images.py", *made.values(), IMAGES / "heaps.png"]]


def shapes(at):
    """Photons, where they are not there yet, and the model beside them."""
    traced = at.folder / "shapes"
    return [[PYTHON, SOURCE / "tests/bench/shape_pictures.py", os.environ["MESOGRAIN_REFEREE"], traced, "--radii",
             "3", "--indices", "1.3", "--paths", "64"],
            [PYTHON, SOURCE / "docs/make_shape_images.py", at.build, traced]]


def match(at):
    return [[LAUNCHER, "bench", "--blender", at.blender, "match", "--cases", "sphere", "--models", "model_2",
             "--corrections", "3", "--keep", at.folder / "match"]]


def comparison(at):
    """The README's."""
    return [[LAUNCHER, "compare", "--blender", at.blender, SOURCE / "blend_files/heap.blend", "--models", "model_2",
             "--references", "volume_index_matched", "--size", "480x320", "--samples", "16", "--reference-samples",
             "32", "--cache", at.folder / "cycles", "--out", at.folder / "comparison"]]


PICTURES = {
    "tutorial": Picture("the tutorial's steps", 2, tutorial, "tutorial_*.png"),
    "comparison": Picture("a heap beside Cycles, and the difference", 4, comparison, "comparison.png",
                          "comparison/plots/overview.png"),
    "match": Picture("a ball and the coefficients found in it", 1, match, "match.png",
                     "match/match_sphere_model_2.png"),
    "scenes": Picture("scenes of Cycles' nodes by both engines", 3, scenes, "scene_*.jpg"),
    "crystals": Picture("one grain on a table by both engines", 3, crystals, "crystals.jpg"),
    "gallery": Picture("heaps by both engines", 7, gallery, "gallery_*.jpg"),
    "heaps": Picture("a heap without and with light between grains, and by Cycles", 9, heaps, "heaps.png"),
    "shapes": Picture("seven shapes by photons and by the model", 3, shapes, "shapes.jpg"),
}


def make(picture, at):
    """Runs the commands of a Picture. Ends the process where one fails, or leaves an image as it was."""
    before = {image: image.stat().st_mtime_ns for image in IMAGES.glob(picture.images)}
    for command in picture.commands(at):
        done = subprocess.run([str(word) for word in command], check=False, stdin=subprocess.DEVNULL)
        if done.returncode:
            sys.exit(done.returncode)
    if picture.kept:
        shutil.copyfile(at.folder / picture.kept, IMAGES / picture.images)
    left = [image.name for image, when in before.items() if image.stat().st_mtime_ns == when]
    if left:
        sys.exit(f"mesograin: nothing has written docs/images/{left[0]}; is it of a scene that is no more?")


def main():
    build, blender, logs, folder, *asked = sys.argv[1:]
    at = Workplace(pathlib.Path(build), blender, pathlib.Path(logs), pathlib.Path(folder).resolve())
    at.folder.mkdir(parents=True, exist_ok=True)
    names = asked or list(PICTURES)
    begun, behind = time.monotonic(), 0.0
    for number, name in enumerate(names):
        picture = PICTURES[name]
        ahead = sum(PICTURES[each].minutes for each in names[number:])
        slowness = (time.monotonic() - begun) / (60.0 * behind) if behind else 1.0
        print(f"{number + 1} of {len(names)}, {name}: {picture.sentence}; about {duration(60.0 * ahead * slowness)}"
              " left for all", flush=True)
        make(picture, at)
        behind += picture.minutes
    print(f"{len(names)} of {len(names)} done in {duration(time.monotonic() - begun)}; pictures are in {IMAGES}")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        print("\nStopped; what was rendered stays, and the same command goes on from there.", file=sys.stderr)
        sys.exit(130)
