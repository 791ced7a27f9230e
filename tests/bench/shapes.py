"""How far models' pictures of grains are from photon Monte Carlo, by shape, size, light and medium.

    shapes.py BUILD_FOLDER FOLDER [--models M ...] [--taps N] [--samples N] [--only TEXT ...] [--albedos A ...]
              [--json FILE] [--pictures FOLDER]

FOLDER holds a manifest.json: a camera, and for each image its EXR file, its mesh (an OBJ file, or "sphere" and its
radius), medium and light. Figures are of blocks of 8x8 pixels: relative_l1 is sum|picture - truth| / sum truth, total
is sum picture / sum truth; noise is what the truth's own noise adds to relative_l1, where its file tells; of_front is
sum|picture - truth| over what the truth of the same grain lit from the front sums to, where FOLDER has that. The truth
holds light that was scattered at least once, no specular reflection.
"""
import argparse
import importlib
import json
import pathlib
import sys

import numpy

BLOCK = 8


def blocks(pixels):
    """Sums over blocks of pixels, (h / 8, w / 8)."""
    height, width = (side // BLOCK * BLOCK for side in pixels.shape)
    return pixels[:height, :width].astype(float).reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK).sum(axis=(1, 3))


def compare(picture, truth):
    """Figures of one picture, given both in radiance, premultiplied by coverage."""
    drawn, true = blocks(picture), blocks(truth)
    return {"relative_l1": float(numpy.abs(drawn - true).sum() / true.sum()), "total": float(drawn.sum() / true.sum())}


def of_front(shapes, image):
    """By what a relative L1 of this image is multiplied to be one of the brightness from the front; None if unknown."""
    same = ("mesh", "eta", "g", "roughness", "sigma_s", "sigma_a", "resolution", "irradiance")
    for other in shapes.images:
        if light_of(other) == "front" and all(other.get(key) == image.get(key) for key in same) and \
                other.get("channel") == image.get("channel"):
            return float(shapes.truth(image).sum() / shapes.truth(other).sum())
    return None


class Shapes:
    """Draws what a manifest's images show."""

    def __init__(self, native, folder):
        self._native = native
        self._folder = pathlib.Path(folder)
        self._manifest = json.loads((self._folder / "manifest.json").read_text())
        self.images = self._manifest["images"]

    def truth(self, image):
        return self._channel(image, "")

    def noise(self, image):
        """Standard error of each pixel of the truth, or None."""
        return self._channel(image, "noise.")

    def _channel(self, image, prefix):
        pixels, channels, _ = self._native.read_exr(str(self._folder / image["file"]))
        name = prefix + image.get("channel", "R")
        return pixels[..., list(channels).index(name)] if name in channels else None

    def draw(self, image, model, taps=64, samples=32, **changed):
        """Radiance and coverage, (h, w, 4). `changed`: keys of the material that are other than the image's."""
        geometry = ({"shape": "sphere", "radius": image["radius"]} if image["mesh"] == "sphere" else
                    {"shape": "mesh", "file": str((self._folder / image["mesh"]).resolve())})
        eta = image["eta"]
        scene, camera, (width, height) = self._native.load_scene({
            "geometry": geometry, "camera": self._manifest["camera"], "resolution": image["resolution"],
            "lights": [{"type": "distant", "direction_to_light": image["direction_to_light"],
                        "irradiance_linear_rgb": image["irradiance"]}],
            "material": {"kind": "subsurface", "sigma_s": image["sigma_s"], "sigma_a": image["sigma_a"],
                         "g": image["g"], "eta": eta, "specular": False, "roughness": image.get("roughness", 0.0),
                         "boundary": "index_matched" if eta == 1.0 else "dielectric", **changed}}, model=model)
        view = self._native.View(width, height)
        view.set_scene(scene)
        view.set_camera(camera)
        view.set_taps(taps)
        view.render(samples)
        return view.read()

    def keep(self, path, drawn):
        """A picture, for looking at."""
        path.parent.mkdir(parents=True, exist_ok=True)
        self._native.write_exr(str(path), numpy.repeat(drawn[..., None], 3, axis=2), ["R", "G", "B"])


def share_of_noise(noise, truth):
    """The mean of |noise| of blocks, which are about normal, as a part of what they hold."""
    return float(numpy.sqrt(2.0 / numpy.pi) * numpy.sqrt(blocks(noise ** 2)).sum() / blocks(truth).sum())


def albedo(image):
    """Of the channel that an image's truth is of."""
    channel = "RGB".index(image.get("channel", "R"))
    sigma_s, sigma_a = (numpy.broadcast_to(image[name], 3)[channel] for name in ("sigma_s", "sigma_a"))
    return float(sigma_s / (sigma_s + sigma_a))


def measure(shapes, images, models, taps, samples, pictures=None):
    """Rows: one for each image and model."""
    for image in images:
        truth, noise = shapes.truth(image), shapes.noise(image)
        for model in models:
            drawn = shapes.draw(image, model, taps, samples)[..., "RGB".index(image.get("channel", "R"))]
            if pictures:
                shapes.keep(pictures / f"{pathlib.Path(image['file']).stem}_{model}.exr", drawn)
            figures = compare(drawn, truth)
            if (share := of_front(shapes, image)) is not None:
                figures["of_front"] = share * figures["relative_l1"]
            yield {"file": image["file"], "shape": pathlib.Path(image["mesh"]).stem, "eta": image["eta"],
                   "radius": image["radius_in_mean_free_paths"], "light": light_of(image),
                   "albedo": albedo(image), "g": image["g"], "roughness": image.get("roughness", 0.0), "model": model,
                   **figures,
                   **({} if noise is None else {"noise": share_of_noise(noise, truth)})}


def light_of(image):
    """front, side or back, by how the light falls on what the camera looks at along -z."""
    z = image["direction_to_light"][2] / numpy.linalg.norm(image["direction_to_light"])
    return "front" if z > 0.3 else "back" if z < -0.3 else "side"


def table(rows):
    """Lines of Markdown: relative L1 in % and the total, by model and light."""
    models = sorted({row["model"] for row in rows})
    lights = [light for light in ("front", "side", "back") if any(row["light"] == light for row in rows)]
    columns = [(model, light) for model in models for light in lights]
    heads = " | ".join(f"{model} {light}" for model, light in columns)
    yield f"| shape | eta | g | roughness | albedo | radius | {heads} |"
    yield "|---" * (6 + len(columns)) + "|"

    def case_of(row):
        return tuple(row[key] for key in ("shape", "eta", "g", "roughness")) + (round(row["albedo"], 6), row["radius"])
    cases = {case_of(row): {} for row in rows}
    for row in rows:
        case = cases[case_of(row)]
        noise = f" (noise {100.0 * row['noise']:.1f})" if "noise" in row else ""
        told = row["light"] == "back" and "of_front" in row
        front = f" = {100.0 * row['of_front']:.1f} of front" if told else ""
        case[row["model"], row["light"]] = f"{100.0 * row['relative_l1']:.1f} / {row['total']:.2f}{front}{noise}"
    for (shape, eta, g, roughness, of_channel, radius), case in sorted(cases.items()):
        figures = " | ".join(case.get(column, "") for column in columns)
        yield f"| {shape} | {eta:g} | {g:g} | {roughness:g} | {of_channel:g} | {radius:g} | {figures} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the folder of the native module")
    parser.add_argument("folder", type=pathlib.Path, help="the truth: EXR files, meshes and manifest.json")
    parser.add_argument("--models", nargs="+", default=["model_2", "model_3"])
    parser.add_argument("--taps", type=int, default=64, help="model 3's samples for a pixel and frame (default: 64)")
    parser.add_argument("--samples", type=int, default=32, help="frames of each picture (default: 32)")
    parser.add_argument("--only", nargs="+", default=[""], metavar="TEXT",
                        help="images whose file's name holds one of these")
    parser.add_argument("--albedos", nargs="+", type=float, metavar="A", help="and of these albedos")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also writes the rows there")
    parser.add_argument("--pictures", type=pathlib.Path, metavar="FOLDER", help="also keeps the pictures there")
    options = parser.parse_args()
    sys.path.insert(0, options.build)
    native = importlib.import_module("mesograin_native")
    shapes = Shapes(native, options.folder)
    images = [image for image in shapes.images if any(text in image["file"] for text in options.only)
              and (not options.albedos or any(abs(albedo(image) - each) < 1e-6 for each in options.albedos))]
    rows = list(measure(shapes, images, options.models, options.taps, options.samples, options.pictures))
    print("Relative L1 in % / total over the truth's, in blocks of 8x8 pixels")
    print("\n".join(table(rows)))
    for model in options.models:
        mean = numpy.mean([row["relative_l1"] for row in rows if row["model"] == model])
        print(f"{model}: mean {100.0 * mean:.2f} %")
    if options.json:
        result = {"about": __doc__, "device": native.device_info()["renderer"], "taps": options.taps,
                  "samples": options.samples, "rows": rows}
        options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
