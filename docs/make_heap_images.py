"""Draws heaps without and with light between grains beside Cycles' from finished comparisons of the same cases.

    docs/make_heap_images.py WITHOUT WITH OUT.png

WITHOUT, WITH: folders that `./mesograin compare` wrote with --exchange off and without. A row for each case: both
pictures, the reference, and what is left of the difference. Above them the ratio of totals and relative L1 in blocks of
8 x 8 pixels, over those pixels that show grains: where the first case has light, an index-matched volume in which an
open ground is nothing.
"""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

SOURCE = pathlib.Path(__file__).resolve().parents[1]


def read_module():
    """mesograin_native, as it was built."""
    sys.path.insert(0, str(SOURCE / "build/release"))
    import mesograin_native

    return mesograin_native


def cases(folder):
    """{name: entry of results.json} of what was compared."""
    results = json.loads((folder / "results.json").read_text())
    return {case["name"]: case for case in results["cases"] if case["status"] == "done"}


def shown(pixels, exposure):
    """sRGB of linear radiance over white."""
    colours = pixels[..., :3] * exposure + (1.0 - pixels[..., 3:])
    colours = np.clip(colours, 0.0, 1.0)
    return np.where(colours < 0.0031308, 12.92 * colours, 1.055 * colours ** (1.0 / 2.4) - 0.055)


def blocks(picture, mask):
    """Sums over blocks of 8 x 8 pixels of what is in the mask."""
    height, width = (side // 8 * 8 for side in mask.shape)
    light = np.where(mask, picture[..., :3].mean(axis=-1), 0.0)[:height, :width]
    return light.reshape(height // 8, 8, width // 8, 8).sum(axis=(1, 3))


def numbers(picture, reference, mask):
    found, right = blocks(picture, mask), blocks(reference, mask)
    return f"in all {found.sum() / right.sum():.3f}, in blocks {np.abs(found - right).sum() / right.sum():.1%}"


def draw(without, with_, out):
    native = read_module()
    both = [(cases(without)[name], case) for name, case in cases(with_).items() if name in cases(without)]
    mask = native.read_exr(with_ / both[0][1]["files"]["reference"])[0][..., 1] > 0.0
    figure, axes = plt.subplots(len(both), 4, figsize=(16, 4.3 * len(both)), squeeze=False)
    for row, (dark, lit) in zip(axes, both):
        pictures = [native.read_exr(without / dark["files"]["model"])[0],
                    *(native.read_exr(with_ / lit["files"][name])[0] for name in ("model", "reference"))]
        exposure = 0.8 / np.percentile(pictures[2][..., :3][pictures[2][..., 3] > 0.5], 98)
        titles = (
            f"{lit['model']}, shadows alone\n{numbers(pictures[0], pictures[2], mask)}",
            f"with light between grains\n{numbers(pictures[1], pictures[2], mask)}",
            f"Cycles, {lit['reference_title']}\n{lit['reference_seconds']:.0f} s")
        print(lit["name"], *titles, sep="\n  ")
        for axis, picture, title in zip(row, pictures, titles):
            axis.imshow(shown(picture, exposure))
            axis.set_title(title, fontsize=10)
        error = (pictures[1][..., :3] - pictures[2][..., :3]).mean(axis=-1) * exposure
        row[3].imshow(error, cmap="RdBu_r", vmin=-0.2, vmax=0.2)
        row[3].set_title("with it less Cycles, red is too bright\n(full colour: a fifth of white)", fontsize=10)
        for axis in row:
            axis.set_axis_off()
    figure.tight_layout()
    figure.savefig(out, dpi=80)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    draw(*map(pathlib.Path, sys.argv[1:]))
