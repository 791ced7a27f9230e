"""What each model's shade pass costs relative to lambert's: ratios within one run, frames of all models interleaved.

    frame.py BUILD_FOLDER [--frames N] [--models M ...] [--shapes S ...] [--eta ETA] [--g G] [--json FILE]

The scene: a sphere of 128x64 faces that fills 70 % of a 400x400 picture's width, two directional lights. Other shapes
are those of shape_pictures.py, as far away; each is beside lambert on the same shape.
"""
import argparse
import json
import math
import pathlib
import statistics
import sys

import numpy
import shape_pictures
import sphere_mesh

SIZE = 400
RADIUS = 2.4
SEGMENTS, RINGS = 128, 64
FIELD_OF_VIEW = 45.0  # degrees
WIDTH_FILLED = 0.7
PARAMETERS = {"sigma_a": (0.1,) * 3, "sigma_s": (0.9,) * 3, "roughness": 0.3, "reflectance": (0.5,) * 3}


def sphere():
    """(positions, normals, triangles) of a smooth UV sphere."""
    positions, normals, triangles = sphere_mesh.sphere(SEGMENTS, RINGS)
    return positions * numpy.float32(RADIUS), normals, triangles


def normals(positions, triangles):
    """Of vertices, the mean of the triangles beside them; (n, 3)."""
    corners = positions[triangles]
    across = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sums = numpy.zeros_like(positions)
    for corner in range(3):
        numpy.add.at(sums, triangles[:, corner], across)
    return sums / numpy.linalg.norm(sums, axis=1, keepdims=True)


def grain(shape):
    """(positions, normals, triangles)."""
    if shape == "sphere":
        return sphere()
    positions, triangles = shape_pictures.mesh(shape)
    return (positions.astype(numpy.float32), normals(positions, triangles).astype(numpy.float32),
            triangles.astype(numpy.uint32))


def make_views(native, shape, models, g, eta):
    """{model: a view of the shape}, for those that this build draws; g and eta: of the medium."""
    mesh = native.Mesh(*grain(shape))
    half_angle = math.atan(WIDTH_FILLED * math.tan(math.radians(FIELD_OF_VIEW / 2.0)))
    position = (RADIUS / math.sin(half_angle), 0.0, 0.0)
    camera = native.Camera.look_at(position, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), FIELD_OF_VIEW)
    lights = [native.DirectionalLight((1.0, 1.0, 1.0), (20.0,) * 3),
              native.DirectionalLight((-1.0, -1.0, -1.6), (10.0,) * 3)]
    boundary = "index_matched" if eta == 1.0 else "dielectric"
    views = {}
    for model in models:
        view = native.View(SIZE, SIZE)
        try:
            material = native.Material(model=model, g=g, eta=eta, boundary=boundary, **PARAMETERS)
            instances = [native.Instance(mesh, material, numpy.eye(4))]
            view.set_scene(native.Scene(instances=instances, lights=lights))
            view.set_camera(camera)
            view.render(1)  # shaders compiled, light maps warm
        except native.Error as error:
            print(f"{shape}, {model}: not measured: {error}", file=sys.stderr)
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
    parser.add_argument("--models", nargs="+", metavar="MODEL", help="beside lambert (default: all)")
    parser.add_argument("--shapes", nargs="+", default=["sphere"], choices=shape_pictures.SHAPES,
                        help="of the grain (default: sphere)")
    parser.add_argument("--eta", type=float, default=1.3, help="of the medium; 1: index-matched (default: 1.3)")
    parser.add_argument("--g", type=float, default=0.0, help="of the medium (default: 0)")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also writes the result there")
    options = parser.parse_args()
    sys.path.insert(0, options.build)
    import mesograin_native as native

    known = [entry["name"] for entry in native.schema()["models"]]
    if unknown := set(options.models or ()) - set(known):
        parser.error(f"--models needs names of {', '.join(known)}; got {', '.join(sorted(unknown))}")
    models = ["lambert", *(model for model in options.models or known if model != "lambert")]
    device = native.device_info()["renderer"]
    print(f"Shade pass, {SIZE}x{SIZE}, two lights, median of {options.frames} frames, on {device}")
    print(f"{'shape':<10}{'model':<12}{'milliseconds':>14}{'x lambert':>12}")
    shapes = {}
    for shape in options.shapes:
        times = measure(make_views(native, shape, models, options.g, options.eta), options.frames)
        medians = {model: statistics.median(each) for model, each in times.items()}
        ratios = {model: milliseconds / medians["lambert"] for model, milliseconds in medians.items()}
        for model, milliseconds in medians.items():
            print(f"{shape:<10}{model:<12}{milliseconds:>14.2f}{ratios[model]:>12.2f}")
        shapes[shape] = {"shade_milliseconds": medians, "relative_to_lambert": ratios}
    if options.json:
        result = {"device": device, "size": SIZE, "frames": options.frames, "eta": options.eta, "g": options.g,
                  "shapes": shapes}
        options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
