"""Makes images/shapes.jpg: the model transport beside the referee, each shape lit from three sides.

    make_shape_images.py BUILD_FOLDER FOLDER ...

FOLDER: pictures by the referee, as tests/bench/shape_pictures.py makes them; shown is what has radius 3, eta 1.3 and
albedo 0.9. A row a shape; for front, side and back the referee and then the model. A row is as bright as its brightest
picture allows.
"""
import argparse
import importlib
import pathlib
import sys

import numpy
from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
ORDER = ("sphere", "cube", "flake", "rice", "sand", "torus", "peanut")
LIGHTS = ("front", "side", "back")


def chosen(image):
    albedo = image["sigma_s"] / (image["sigma_s"] + image["sigma_a"]) if numpy.isscalar(image["sigma_s"]) else 0.0
    return (image["radius_in_mean_free_paths"] == 3 and image["eta"] == 1.3 and image["g"] == 0
            and abs(albedo - 0.9) < 1e-6)


def rows(shapes_module, native, folders):
    """{shape: {light: (truth, ours)}}"""
    found = {}
    for folder in folders:
        shapes = shapes_module.Shapes(native, folder)
        for image in filter(chosen, shapes.images):
            pair = shapes.truth(image), shapes.draw(image, "transport", samples=8)[..., 0]
            found.setdefault(pathlib.Path(image["mesh"]).stem, {})[shapes_module.light_of(image)] = pair
    return found


def encoded(linear):
    """sRGB, 0 to 255."""
    value = numpy.clip(linear, 0.0, 1.0)
    curve = numpy.where(value <= 0.0031308, 12.92 * value, 1.055 * value ** (1 / 2.4) - 0.055)
    return numpy.round(255.0 * curve).astype(numpy.uint8)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the folder of the native module")
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    options = parser.parse_args()
    sys.path[:0] = [options.build, str(HERE.parent / "tests/bench")]
    found = rows(importlib.import_module("shapes"), importlib.import_module("mesograin_native"), options.folders)
    strips = []
    for shape in filter(found.get, ORDER):
        pictures = [picture for light in LIGHTS for picture in found[shape][light]]
        brightest = max(numpy.percentile(picture, 99.5) for picture in pictures)
        strips.append(numpy.concatenate(pictures, axis=1) / brightest)
    Image.fromarray(encoded(numpy.concatenate(strips))).save(HERE / "images/shapes.jpg", quality=88)


if __name__ == "__main__":
    main()
