# Makes docs/images/gallery_*.jpg and their lines of docs/gallery.md from blend_files/gallery, by both engines:
#   blender -b --factory-startup --python-exit-code 1 --python docs/make_gallery.py [-- [--keep DIR] [NAME ...]]
# NAME: of a heap (default: those that the page shows); --keep DIR: the pictures as EXR, too, of which Cycles' are not
# rendered again.
import json
import pathlib
import sys
import tempfile
import time

import bpy
import numpy as np

DOCS = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(DOCS.parent / "addon"), str(DOCS.parent / "blend_files")]

import make_gallery_files as files  # noqa: E402
import parts  # noqa: E402

BLOCK = 10
SEEDS = (1, 2)


def open_scene(name):
    bpy.ops.wm.open_mainfile(filepath=str(files.FOLDER / f"{name}.blend"))


# Pictures

def processor_seconds():
    """Of all threads, so that other work on the machine counts little."""
    return time.process_time()


def render(path):
    """((h, w, 3) linear, row 0 at the bottom; seconds of the processor), of the scene as its engine draws it."""
    scene = bpy.context.scene
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"
    scene.render.filepath = str(path)
    before = processor_seconds()
    bpy.ops.render.render(write_still=True)
    return parts.pixels_of(path), processor_seconds() - before


def ours(exchange, folder):
    scene = bpy.context.scene
    scene.render.engine, scene.mesograin.exchange = "MESOGRAIN", exchange
    return render(folder / f"{exchange}.exr")


def grains_alone(folder):
    """How much of each pixel grains cover."""
    scene, ground = bpy.context.scene, bpy.data.objects["Ground"]
    samples = scene.mesograin.samples
    ground.hide_render, scene.render.film_transparent, scene.mesograin.samples = True, True, 4
    pixels, _ = ours("off", folder)
    ground.hide_render, scene.render.film_transparent, scene.mesograin.samples = False, False, samples
    return pixels[..., 3]


def theirs(samples, folder):
    """(one picture for each of SEEDS, seconds of the processor for all)."""
    from mesograin.cycles import kinds, settings

    scene = bpy.context.scene
    took = folder / "cycles.json"
    if took.exists():
        return [parts.pixels_of(folder / f"cycles_{seed}.exr")[..., :3] for seed in SEEDS], json.loads(took.read_text())
    pictures, seconds = [], 0.0
    for seed in SEEDS:
        chosen = settings.settings(kinds.KINDS["volume_dielectric"], samples, seed, files.SIZE)
        chosen["render"]["film_transparent"] = False
        del chosen["image_settings"], chosen["view_settings"]
        settings.apply(scene, chosen)
        # Through rough glass, Multiscatter GGX, Cycles loses a third of lights that it asks for by themselves.
        scene.world.cycles.sampling_method = "NONE"
        picture, more = render(folder / f"cycles_{seed}.exr")
        pictures.append(picture[..., :3])
        seconds += more
    took.write_text(json.dumps(seconds))
    return pictures, seconds


# Numbers

def numbers(picture, references, covered):
    """(ratio of totals, relative L1 in blocks, that of the noise of the references' mean), where grains are."""
    where = parts.blocks(covered[..., None], BLOCK)[..., 0] > 0.5
    found, first, second = (parts.blocks(each[..., :3], BLOCK)[where] for each in (picture, *references))
    right = 0.5 * (first + second)
    return (found.sum() / right.sum(), np.abs(found - right).sum() / right.sum(),
            0.5 * np.abs(first - second).sum() / right.sum())


def shown(picture, exposure):
    """sRGB, 0 to 1."""
    linear = np.clip(picture[..., :3] * exposure, 0.0, 1.0)
    return np.where(linear < 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)


def take(heap, folder):
    """The two lines of docs/gallery.md of a Heap: numbers and pictures."""
    open_scene(heap.name)
    folder.mkdir(parents=True, exist_ok=True)
    pictures = {exchange: ours(exchange, folder) for exchange in ("heaps", "gathered")}
    covered = grains_alone(folder)
    references, seconds = theirs(heap.samples, folder)
    mean = np.mean(references, axis=0)
    exposure = 0.85 / np.percentile(mean[covered > 0.5].mean(axis=-1), 97.0)
    looks = [shown(picture, exposure) for picture in (*(each for each, _ in pictures.values()), mean)]
    parts.save_beside(DOCS / "images" / f"gallery_{heap.name}.jpg", looks, 85)
    cells = []
    for picture, took in pictures.values():
        total, off, noise = numbers(picture, references, covered)
        cells += [f"{took:.0f}", f"{total:.2f}", f"{100.0 * off:.1f} %"]
    return (f"| {heap.sentence}; {heap.count} grains, {heap.reference} | {' | '.join(cells)} | {seconds:.0f} |"
            f" {100.0 * noise:.1f} % |\n| ![](images/gallery_{heap.name}.jpg) ||||||||\n")


def shown_by(page):
    """Names of the heaps that the page shows."""
    text = page.read_text(encoding="utf-8")
    return [heap.name for heap in files.HEAPS if f"images/gallery_{heap.name}.jpg" in text]


def write_lines(page, heap, lines):
    """In place of those that the page has of a Heap, or below the others."""
    kept = page.read_text(encoding="utf-8").splitlines(keepends=True)
    old = next((row for row, line in enumerate(kept) if f"images/gallery_{heap.name}.jpg" in line), None)
    if old is not None:
        kept[old - 1:old + 1] = [lines]
    else:
        last = max(row for row, line in enumerate(kept) if "images/gallery_" in line)
        kept.insert(last + 1, lines)
    page.write_text("".join(kept), encoding="utf-8")


def main():
    import addon_utils

    addon_utils.enable("mesograin", default_set=True)
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    keep = pathlib.Path(words.pop(words.index("--keep") + 1)) if "--keep" in words else None
    page = DOCS / "gallery.md"
    asked = [word for word in words if word != "--keep"] or shown_by(page)
    for heap in files.HEAPS:
        if heap.name not in asked:
            continue
        with tempfile.TemporaryDirectory() as folder:
            write_lines(page, heap, take(heap, (keep or pathlib.Path(folder)) / heap.name))


if __name__ == "__main__":
    main()
