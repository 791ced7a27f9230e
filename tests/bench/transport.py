"""How long the model transport takes to answer: for a new mesh, for another colour of it, for another extinction.

    transport.py BUILD_FOLDER [--radius R] [--mesh FILE] [--eta ETA] [--channels R G B]

Seconds of processor time, of all threads, until there is a coarse answer, until there is one within 5 % of the final
one, and until there is the final one; and how far the coarse picture is from it: sum|coarse - final| / sum final in
blocks of 8x8 pixels. Nothing that a run before has left is used.
"""
import argparse
import importlib
import os
import pathlib
import sys
import tempfile
import time

import numpy
import shapes

SOURCE = pathlib.Path(__file__).resolve().parents[2]
CAMERA = {"position": [0, 0, 6.5], "look_at": [0, 0, 0], "up": [0, 1, 0], "fov_degrees": 45}
LIGHT = {"type": "distant", "direction_to_light": [0.8, 0.6, 0], "irradiance_linear_rgb": 1}

NEAR = 0.05  # of the final picture: an answer that is no farther off serves


def answers(native, view, mesh, eta, sigma_s, sigma_a):
    """(processor seconds, picture) of each answer of `transport`, the final one last."""
    scene, camera, _ = native.load_scene({
        "geometry": {"shape": "mesh", "file": str(mesh)}, "camera": CAMERA, "resolution": [96, 96], "lights": [LIGHT],
        "material": {"kind": "medium", "sigma_s": sigma_s, "sigma_a": sigma_a, "eta": eta, "specular": False}},
        model="transport")
    started = time.process_time()
    view.set_scene(scene)
    view.set_camera(camera)
    view.render(1)
    drawn, known = [], 0.0
    while True:
        final = view.preparing is None
        if view.take_news() or final:
            seconds = time.process_time() - started - known
            before = time.process_time()
            view.render(8)
            drawn.append((seconds, shapes.blocks(view.read()[..., :3].sum(axis=2))))
            known += time.process_time() - before  # what drawing took
        if final:
            return drawn
        time.sleep(0.005)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the folder of the native module")
    parser.add_argument("--radius", type=float, default=3.0, help="of a ball as large, in mean free paths (default: 3)")
    parser.add_argument("--mesh", type=pathlib.Path, default=SOURCE / "tests/data/shapes/cube.obj")
    parser.add_argument("--eta", type=float, default=1.3, help="index of refraction (default: 1.3)")
    parser.add_argument("--channels", type=float, nargs=3, default=(1.0, 1.0, 1.0),
                        help="how much of the extinction each channel has (default: 1 1 1)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_CACHE_HOME"] = folder
        sys.path.insert(0, options.build)
        native = importlib.import_module("mesograin_native")
        # Of the cube in tests/data/shapes a radius of 3 is this extinction.
        sigma_t = 2.0160829658756 * options.radius / 3.0
        view = native.View(96, 96, patient=False)
        for name, thickness, albedo in (("a new mesh", 1.0, 0.9), ("another colour", 1.03, 0.8),
                                        ("white", 0.97, 0.999), ("twice the extinction", 2.0, 0.9),
                                        ("the first again, a little browner", 1.02, 0.85)):
            here = sigma_t * thickness * numpy.array(options.channels)
            drawn = answers(native, view, options.mesh, options.eta, list(here * albedo), list(here * (1 - albedo)))
            final = drawn[-1][1]
            told = [f"{seconds:.2f} s ({100 * numpy.abs(picture - final).sum() / final.sum():.1f} %)"
                    for seconds, picture in drawn[:-1]]
            near = next(seconds for seconds, picture in drawn
                        if numpy.abs(picture - final).sum() <= NEAR * final.sum())
            print(f"{name}: coarse {', '.join(told) or '-'}; within {100 * NEAR:.0f} % {near:.2f} s; "
                  f"final {drawn[-1][0]:.2f} s", flush=True)


if __name__ == "__main__":
    main()
