# Makes docs/images/crystals.jpg and its lines of docs/gallery.md: one grain on a table, by both engines:
#   blender -b --factory-startup --python-exit-code 1 --python docs/make_crystals.py
import dataclasses
import pathlib
import sys
import tempfile

import bpy
import numpy as np

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent)]

import make_gallery as gallery  # noqa: E402  which finds parts, too
import parts  # noqa: E402

OUR_SAMPLES = 32
TABLE = (0.45, 0.2, 0.11)
LIGHTS = ((gallery.window, "a room with a window"), (gallery.soft, "a sun behind a thin cloud"))
# (shape, preset, changes of it)
CLEAR = {"sigma_s": (0.0,) * 3, "roughness": 0.0}
GRAINS = (("salt", "salt", {}), ("sugar", "sugar", {}), ("bead", "salt", {}), ("salt", "salt", CLEAR))
NAMES = ("salt", "sugar", "a bead of salt", "clear, smooth salt")
START, END = "| grain | light | total | blocks | noise |\n|---|---|---|---|---|\n", "\n![](images/crystals.jpg)"


def grain_on_table(grain, light):
    heap = gallery.Heap("grain", "", (grain,), 1, 0.3, TABLE, light, 96, roundness=0.15)
    gallery.pour(dataclasses.replace(heap, grains=((*grain[:2], {**grain[2], "model": "auto"}),)))
    instances = bpy.context.evaluated_depsgraph_get().object_instances
    place = next(each.matrix_world.translation.copy() for each in instances if each.is_instance)
    bpy.data.objects["Heap"].location.xy -= place.xy
    gallery.look_at(0.2, 0.22)
    return heap


def take(grain, light, folder):
    """((ratio of totals, relative L1 in blocks, noise), our picture, Cycles')."""
    heap = grain_on_table(grain, light)
    folder.mkdir()
    bpy.context.scene.mesograin.samples = OUR_SAMPLES
    picture, _ = gallery.ours("heaps", folder)
    covered = gallery.grains_alone(folder)
    references, _ = gallery.theirs(heap, folder)
    return gallery.numbers(picture, references, covered), picture, np.mean(references, axis=0)


def main():
    import addon_utils

    addon_utils.enable("mesograin", default_set=True)
    rows, strips = [], []
    with tempfile.TemporaryDirectory() as folder:
        for light, sentence in LIGHTS:
            looks = []
            for number, grain in enumerate(GRAINS):
                (total, off, noise), *pictures = take(grain, light, pathlib.Path(folder, f"{light.__name__}_{number}"))
                exposure = 0.85 / np.percentile(pictures[1].mean(axis=-1), 97.0)
                looks.append(np.concatenate([gallery.shown(picture, exposure) for picture in pictures]))
                rows.append(f"| {NAMES[number]} | {sentence} | {total:.2f} | {100.0 * off:.1f} % |"
                            f" {100.0 * noise:.1f} % |\n")
            strips.append(np.concatenate(looks, axis=1))
    parts.save_beside(gallery.DOCS / "images" / "crystals.jpg", strips, 85)
    page = gallery.DOCS / "gallery.md"
    text = page.read_text(encoding="utf-8")
    before, after = text[:text.index(START) + len(START)], text[text.index(END):]
    page.write_text(before + "".join(rows) + after, encoding="utf-8")


main()
