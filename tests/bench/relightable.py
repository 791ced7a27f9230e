"""How far a surface that is lit anew is from one that is baked for that light, by the number of components.

    relightable.py BUILD_FOLDER [--radii R ...] [--components K ...] [--size N]

An irregular grain of sand (albedo 0.9, eta 1.3) by the model transport, at radii of a ball as large in mean free paths.
relative L1 is sum|relit - baked| / sum baked over the texture, at 64 directions that nothing was fitted to; bytes are
those of the components in half floats.
"""
import argparse
import importlib
import pathlib
import sys

import numpy

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "addon"))


def grain(native):
    """(native.Mesh of sand, unwrapped, with smooth normals; its radius)."""
    made = importlib.import_module("mesograin.grains.kinds").sand(numpy.random.default_rng(3), 28, 0.7, 0.3)
    faces, uvs = (numpy.concatenate((each[:, [0, 1, 2]], each[:, [0, 2, 3]])) for each in (made.faces, made.uvs))
    corners = made.vertices[faces]
    facing = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = numpy.zeros_like(made.vertices)
    for corner in range(3):
        numpy.add.at(normals, faces[:, corner], facing)
    normals /= numpy.linalg.norm(normals, axis=1)[:, None]
    arrays = (corners.reshape(-1, 3), normals[faces].reshape(-1, 3), numpy.arange(faces.size).reshape(-1, 3),
              uvs.reshape(-1, 2))
    kinds = (numpy.float32, numpy.float32, numpy.uint32, numpy.float32)
    mesh = native.Mesh(*(array.astype(kind) for array, kind in zip(arrays, kinds)))
    return mesh, (0.75 * made.volume() / numpy.pi) ** (1 / 3)


def measure(native, radius, components, size):
    """Rows: (components, mean, worst)."""
    relightable, lobes = (importlib.import_module(f"mesograin.studies.baking.{name}") for name in
                          ("relightable", "lobes"))
    mesh, units = grain(native)
    sigma_t = radius / units
    sand = native.Material(model="transport", sigma_s=(0.9 * sigma_t,) * 3, sigma_a=(0.1 * sigma_t,) * 3, eta=1.3,
                           specular=False)
    instances = [native.Instance(mesh, sand, numpy.eye(4))]
    small = relightable.Lit(native, instances, numpy.eye(3), (relightable.SMALL,) * 2, 1)
    large = relightable.Lit(native, instances, numpy.eye(3), (size, size), 1)
    seen = numpy.array([small(each)[..., :3].ravel() for each in lobes.map_directions()])
    fitted = lobes.even_directions(relightable.FITTED)
    judged = lobes.even_directions(relightable.JUDGED, turn=1.0)
    baked, truth = (numpy.array([large(each)[..., :3].ravel() for each in directions]) for directions in
                    (fitted, judged))
    for count in components:
        maps = lobes.principal_maps(seen, count)
        textures = numpy.linalg.pinv(lobes.look_up(maps, fitted)) @ baked
        relit = numpy.maximum(lobes.look_up(maps, judged) @ textures, 0.0)
        errors = numpy.abs(relit - truth).sum(axis=1) / truth.sum(axis=1)
        yield count, errors.mean(), errors.max()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the folder of the native module")
    parser.add_argument("--radii", nargs="+", type=float, default=[1, 3])
    parser.add_argument("--components", nargs="+", type=int, default=[4, 6, 8, 12, 16, 25])
    parser.add_argument("--size", type=int, default=64, help="texels on each side (default: 64)")
    options = parser.parse_args()
    sys.path.insert(0, options.build)
    native = importlib.import_module("mesograin_native")
    print("| radius | components | mean % | worst % | kB at 256 x 256 texels |\n|---|---|---|---|---|")
    for radius in options.radii:
        for count, mean, worst in measure(native, radius, options.components, options.size):
            kilobytes = count * 3 * 2 * 256 * 256 / 1000
            print(f"| {radius:g} | {count} | {100 * mean:.2f} | {100 * worst:.2f} | {kilobytes:.0f} |", flush=True)


if __name__ == "__main__":
    main()
