"""Draws heaps without and with light between grains beside Cycles' from finished comparisons of the same cases.

    docs/make_heap_images.py WITHOUT WITH GATHERED OUT.png

WITHOUT, WITH, GATHERED: folders that `./mesograin compare` wrote with --exchange off, heaps and gathered. A row for
each case: the pictures, the reference, and what is left of the difference in the second. Above them the ratio of
totals and relative L1 in blocks of 8 x 8 pixels, over the pixels that were compared, those that show grains. Prints
these, and by how much Cycles' own noise is in them.
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


def shown(pixels, alpha, exposure):
    """sRGB of linear radiance over white."""
    colours = pixels[..., :3] * exposure + (1.0 - alpha[..., None])
    colours = np.clip(colours, 0.0, 1.0)
    return np.where(colours < 0.0031308, 12.92 * colours, 1.055 * colours ** (1.0 / 2.4) - 0.055)


def blocks(picture, mask):
    """Sums over blocks of 8 x 8 pixels of what is in the mask."""
    height, width = (side // 8 * 8 for side in mask.shape)
    light = np.where(mask, picture[..., :3].mean(axis=-1), 0.0)[:height, :width]
    return light.reshape(height // 8, 8, width // 8, 8).sum(axis=(1, 3))


def noise(deviation, reference, mask):
    """What noise leaves of relative L1 in blocks if it is normal, and that of one pixel's channels the same."""
    deviations = np.sqrt(blocks(deviation**2, mask))
    return f"{np.sqrt(2.0 / np.pi) * deviations.sum() / blocks(reference, mask).sum():.1%}"


def numbers(picture, reference, mask):
    found, right = blocks(picture, mask), blocks(reference, mask)
    return f"in all {found.sum() / right.sum():.3f}, in blocks {np.abs(found - right).sum() / right.sum():.1%}"


COLUMNS = ("shadows alone", "with light between grains", "gathered")


def draw(folders, out):
    native = read_module()

    def picture(folder, case, name):
        return native.read_exr(folder / case["files"][name])[0]

    found = [cases(folder) for folder in folders]
    names = [name for name in found[0] if all(name in each for each in found)]
    figure, axes = plt.subplots(len(names), 5, figsize=(20, 4.3 * len(names)), squeeze=False)
    for row, name in zip(axes, names):
        case = found[0][name]
        ours = [picture(folder, each[name], "model") for folder, each in zip(folders, found)]
        reference, deviation = (picture(folders[0], case, which) for which in ("reference", "noise"))
        mask = picture(folders[0], case, "mask")[..., 0] > 0.5
        exposure = 0.8 / np.percentile(reference[..., :3][reference[..., 3] > 0.5], 98)
        titles = [f"{case['model']}, {column}\n{numbers(each, reference, mask)}" for column, each in zip(COLUMNS, ours)]
        titles.append(f"{case['reference_title']}\n{case['reference_seconds']:.0f} s, noise in blocks "
                      f"{noise(deviation, reference, mask)}")
        print(name, *titles, sep="\n  ")
        for axis, each, title in zip(row, (*ours, reference), titles):
            axis.imshow(shown(each, ours[0][..., 3], exposure))
            axis.set_title(title, fontsize=10)
        error = (ours[1][..., :3] - reference[..., :3]).mean(axis=-1) * exposure
        row[4].imshow(error, cmap="RdBu_r", vmin=-0.2, vmax=0.2)
        row[4].set_title("the second less Cycles, red is too bright\n(full colour: a fifth of white)", fontsize=10)
        for axis in row:
            axis.set_axis_off()
    figure.tight_layout()
    figure.savefig(out, dpi=64)


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    *given, written = map(pathlib.Path, sys.argv[1:])
    draw(given, written)
