"""What each model's shade pass costs relative to lambert's: ratios within one run, frames of all models interleaved.

    frame.py BUILD_FOLDER [--frames N] [--g G] [--json FILE]

The scene: a sphere of 128x64 faces that fills 70 % of a 400x400 picture's width, two directional lights.
"""
import argparse
import json
import math
import pathlib
import statistics
import sys

import numpy
import sphere_mesh

SIZE = 400
RADIUS = 2.4
SEGMENTS, RINGS = 128, 64
FIELD_OF_VIEW = 45.0  # degrees
WIDTH_FILLED = 0.7
PARAMETERS = {"sigma_a": (0.1,) * 3, "sigma_s": (0.9,) * 3, "eta": 1.3, "roughness": 0.3, "reflectance": (0.5,) * 3}


def sphere():
    """(positions, normals, triangles) of a smooth UV sphere."""
    positions, normals, triangles = sphere_mesh.sphere(SEGMENTS, RINGS)
    return positions * numpy.float32(RADIUS), normals, triangles


def make_views(native, g):
    """{model: a view of the sphere}, for every model that this build draws; g: of the medium."""
    mesh = native.Mesh(*sphere())
    half_angle = math.atan(WIDTH_FILLED * math.tan(math.radians(FIELD_OF_VIEW / 2.0)))
    position = (RADIUS / math.sin(half_angle), 0.0, 0.0)
    camera = native.Camera.look_at(position, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), FIELD_OF_VIEW)
    lights = [native.DirectionalLight((1.0, 1.0, 1.0), (20.0,) * 3),
              native.DirectionalLight((-1.0, -1.0, -1.6), (10.0,) * 3)]
    views = {}
    for model in (entry["name"] for entry in native.schema()["models"]):
        view = native.View(SIZE, SIZE)
        try:
            material = native.Material(model=model, g=g, **PARAMETERS)
            instances = [native.Instance(mesh, material, numpy.eye(4))]
            view.set_scene(native.Scene(instances=instances, lights=lights))
            view.set_camera(camera)
            view.render(1)  # shaders compiled, light maps warm
        except native.Error as error:
            print(f"{model}: not measured: {error}", file=sys.stderr)
            continue
        views[model] = view
    return views


def measure(views, frames):
    """{model: [milliseconds of the shade pass]}."""
    times = {model: [] for model in views}
    for _ in range(frames):
        for model, view in views.items():
            view.render(1)
            times[model].append(sum(entry["milliseconds"] for entry in view.timings() if entry["pass"] == "shade"))
    return times


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the folder of the native module")
    parser.add_argument("--frames", type=int, default=100, help="frames of each model (default: 100)")
    parser.add_argument("--g", type=float, default=0.0, help="of the medium (default: 0)")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also writes the result there")
    options = parser.parse_args()
    sys.path.insert(0, options.build)
    import mesograin_native as native

    times = measure(make_views(native, options.g), options.frames)
    medians = {model: statistics.median(each) for model, each in times.items()}
    device = native.device_info()["renderer"]
    print(f"Shade pass, {SIZE}x{SIZE}, two lights, median of {options.frames} frames, on {device}")
    print(f"{'model':<12}{'milliseconds':>14}{'x lambert':>12}")
    for model, milliseconds in medians.items():
        print(f"{model:<12}{milliseconds:>14.2f}{milliseconds / medians['lambert']:>12.2f}")
    if options.json:
        result = {"device": device, "size": SIZE, "frames": options.frames, "shade_milliseconds": medians,
                  "relative_to_lambert": {model: value / medians["lambert"] for model, value in medians.items()}}
        options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
