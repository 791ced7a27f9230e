# Makes docs/images/crystals.jpg and its lines of docs/gallery.md from blend_files/gallery, by both engines:
#   blender -b --factory-startup --python-exit-code 1 --python docs/make_crystals.py [-- --keep DIR]
# --keep DIR: the pictures as EXR, too, of which Cycles' are not rendered again.
import itertools
import pathlib
import sys
import tempfile

import numpy as np

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent)]

import make_gallery as gallery  # noqa: E402  which finds the others, too
import make_gallery_files as files  # noqa: E402
import parts  # noqa: E402

START, END = "| grain | light | total | blocks | noise |\n|---|---|---|---|---|\n", "\n![](images/crystals.jpg)"


def take(crystal, folder):
    """((ratio of totals, relative L1 in blocks, noise), our picture, Cycles')."""
    gallery.open_scene(crystal.name)
    folder.mkdir(parents=True, exist_ok=True)
    picture, _ = gallery.ours("heaps", folder)
    covered = gallery.grains_alone(folder)
    references, _ = gallery.theirs(crystal.heap.samples, folder)
    return gallery.numbers(picture, references, covered), picture, np.mean(references, axis=0)


def take_all(folder):
    """(lines of the table; a strip of pictures for each light)."""
    rows, strips = [], []
    for _, crystals in itertools.groupby(files.CRYSTALS, key=lambda each: each.light):
        looks = []
        for crystal in crystals:
            (total, off, noise), *pictures = take(crystal, folder / crystal.name)
            exposure = 0.85 / np.percentile(pictures[1].mean(axis=-1), 97.0)
            looks.append(np.concatenate([gallery.shown(picture, exposure) for picture in pictures]))
            rows.append(f"| {crystal.sentence} | {crystal.lit} | {total:.2f} | {100.0 * off:.1f} % |"
                        f" {100.0 * noise:.1f} % |\n")
        strips.append(np.concatenate(looks, axis=1))
    return rows, strips


def main():
    import addon_utils

    addon_utils.enable("mesograin", default_set=True)
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    with tempfile.TemporaryDirectory() as folder:
        rows, strips = take_all(pathlib.Path(words[1] if words[:1] == ["--keep"] else folder))
    parts.save_beside(gallery.DOCS / "images" / "crystals.jpg", strips, 85)
    page = gallery.DOCS / "gallery.md"
    text = page.read_text(encoding="utf-8")
    before, after = text[:text.index(START) + len(START)], text[text.index(END):]
    page.write_text(before + "".join(rows) + after, encoding="utf-8")


main()
