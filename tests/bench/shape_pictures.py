"""Makes a folder for shapes.py: the referee's pictures of grains, by shape, radius, index, light and albedo.

    shape_pictures.py REFEREE FOLDER [--shapes S ...] [--radii R ...] [--indices ETA ...] [--g G] [--roughness ALPHA]
                      [--paths N] [--size N] [--coloured RED GREEN BLUE]

REFEREE is the program mesograin-referee. What FOLDER holds already is not traced again; manifest.json tells of all.
A radius is that of the sphere of equal volume, in mean free paths.
"""
import argparse
import itertools
import json
import pathlib
import subprocess
import sys

import numpy

SOURCE = pathlib.Path(__file__).resolve().parents[2]
RADIUS = 2.4  # of a sphere; others are as large in their longest direction, about
CAMERA = {"position": [0, 0, 6.5], "look_at": [0, 0, 0], "up": [0, 1, 0], "fov_degrees": 45}
LIGHTS = {"front": [0.5, 0.5, 0.70710678], "side": [0.8, 0.6, 0], "back": [-0.3, 0.4, -0.8660254]}
ALBEDOS = (0.9, 0.999, 0.5)  # each in a channel of its own
COLOURED_ALBEDOS = (0.999, 0.95, 0.6)


def grid_mesh(places):
    """Vertices and triangles of a surface that closes in both directions; places: (rows, columns, 3)."""
    rows, columns, _ = places.shape
    i, j = (grid.ravel() for grid in numpy.meshgrid(numpy.arange(rows), numpy.arange(columns), indexing="ij"))
    corner = [((i + a) % rows) * columns + (j + b) % columns for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    faces = numpy.concatenate((numpy.stack(corner[:3], axis=1), numpy.stack((corner[0], *corner[2:]), axis=1)))
    return places.reshape(-1, 3), faces


def cubed_sphere(reshape, segments=28):
    """Vertices and triangles of a unit sphere whose points `reshape` moves."""
    ball = grains().shape.sphere(segments)
    faces = numpy.concatenate((ball.faces[:, [0, 1, 2]], ball.faces[:, [0, 2, 3]]))
    return reshape(ball.vertices), faces


def grains():
    """The add-on's makers of grains, without Blender."""
    sys.path.insert(0, str(SOURCE / "addon/mesograin"))
    import grains.kinds  # pylint: disable=import-outside-toplevel
    import grains.shape
    return grains


def turned(vertices):
    """Askew to all axes, so that nothing is seen along an edge."""
    a, b = numpy.radians(35), numpy.radians(25)
    about_x = numpy.array([[1, 0, 0], [0, numpy.cos(a), -numpy.sin(a)], [0, numpy.sin(a), numpy.cos(a)]])
    about_y = numpy.array([[numpy.cos(b), 0, numpy.sin(b)], [0, 1, 0], [-numpy.sin(b), 0, numpy.cos(b)]])
    return vertices @ (about_y @ about_x).T


def torus():
    u, v = numpy.meshgrid(*(numpy.linspace(0, 2 * numpy.pi, n, endpoint=False) for n in (72, 40)), indexing="ij")
    out = 1.5 + 0.7 * numpy.cos(v)
    return grid_mesh(numpy.stack((out * numpy.cos(u), out * numpy.sin(u), 0.7 * numpy.sin(v)), axis=-1))


def peanut(segments=28):
    """Two balls grown together."""
    apart, ball = 0.9, 1.35

    def reach(directions):
        along = numpy.abs(directions[:, 2])
        return directions * (apart * along + numpy.sqrt(ball ** 2 - apart ** 2 * (1 - along ** 2)))[:, None]
    return cubed_sphere(reach, segments)


def sand(segments=28):
    made = grains().kinds.sand(numpy.random.default_rng(3), segments, 0.7, 0.3)
    faces = numpy.concatenate((made.faces[:, [0, 1, 2]], made.faces[:, [0, 2, 3]]))
    vertices = made.vertices - 0.5 * (made.vertices.min(axis=0) + made.vertices.max(axis=0))
    return vertices * (2.2 / numpy.linalg.norm(vertices, axis=1).max()), faces


MESHES = {"flake": lambda: cubed_sphere(lambda places: places * (2.0, 2.0, 0.4)),
          "rice": lambda: cubed_sphere(lambda places: places * (0.733, 0.733, 2.2)),
          "torus": torus, "peanut": peanut, "sand": sand}
SHAPES = ["sphere", "cube", *MESHES]
CUBE = SOURCE / "tests/data/shapes/cube.obj"


def mesh(shape):
    """Vertices (n, 3) and triangles (m, 3) of any of them but the sphere."""
    if shape != "cube":
        vertices, faces = MESHES[shape]()
        return turned(vertices), faces
    return read_obj(CUBE)


def read_obj(path):
    """Vertices (n, 3) and triangles (m, 3) of an OBJ file of nothing else."""
    lines = [line.split() for line in path.read_text().splitlines()]
    vertices = numpy.array([line[1:4] for line in lines if line and line[0] == "v"], dtype=float)
    faces = numpy.array([[word.split("/")[0] for word in line[1:4]] for line in lines if line and line[0] == "f"],
                        dtype=int) - 1
    return vertices, faces


def write_mesh(name, folder):
    """Writes NAME.obj; returns its file's name."""
    path = folder / f"{name}.obj"
    if name == "cube":
        path.write_text(CUBE.read_text())
    else:
        vertices, faces = mesh(name)
        path.write_text("".join([f"v {x:.5f} {y:.5f} {z:.5f}\n" for x, y, z in vertices]
                                + [f"f {a} {b} {c}\n" for a, b, c in faces + 1]))
    return path.name


def volume(path):
    """That an OBJ file's triangles enclose."""
    vertices, faces = read_obj(path)
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    return abs(float(numpy.einsum("ij,ij->i", a, numpy.cross(b, c)).sum()) / 6)


def medium(options, radius, size):
    """sigma_s and sigma_a, a channel each."""
    if options.coloured:
        sigma_t = numpy.array(options.coloured) * radius / size
        albedos = numpy.array(COLOURED_ALBEDOS)
    else:
        sigma_t, albedos = numpy.full(3, radius / size), numpy.array(ALBEDOS)
    return (sigma_t * albedos).tolist(), (sigma_t * (1 - albedos)).tolist()


def make(options, shape, radius, eta, light):
    """Traces one picture, if it is not there; returns what the manifest tells of it."""
    if shape == "sphere":
        mesh, geometry, size = "sphere", {"shape": "sphere", "radius": RADIUS}, RADIUS
    else:
        mesh = write_mesh(shape, options.folder)
        file = options.folder.resolve() / mesh
        geometry, size = {"shape": "mesh", "file": str(file)}, (0.75 * volume(file) / numpy.pi) ** (1 / 3)
    sigma_s, sigma_a = medium(options, radius, size)
    name = f"{shape}_e{eta:g}_R{radius:g}" + (f"_g{options.g:g}" if options.g else "") + \
        (f"_r{options.roughness:g}" if options.roughness else "") + \
        ("_coloured" + "_".join(f"{each:g}" for each in options.coloured) if options.coloured else "") + f"_{light}"
    picture = options.folder / f"{name}.exr"
    if not picture.exists():
        described = options.folder / f"{name}.json"
        described.write_text(json.dumps({
            "geometry": geometry, "camera": CAMERA, "resolution": [options.size, options.size],
            "lights": [{"type": "distant", "direction_to_light": LIGHTS[light], "irradiance_linear_rgb": 1}],
            "material": {"kind": "medium", "sigma_s": sigma_s, "sigma_a": sigma_a, "g": options.g, "eta": eta,
                         "roughness": options.roughness, "specular": False,
                         "boundary": "index_matched" if eta == 1.0 else "dielectric"}}))
        command = [options.referee, "render", described, "-o", picture, "-n", str(options.paths)]
        subprocess.run([*command, "--threads", str(options.threads)], check=True, stderr=subprocess.DEVNULL)
        described.unlink()
    about = {"file": picture.name, "mesh": mesh, "eta": eta, "g": options.g,
             "roughness": options.roughness, "irradiance": 1,
             "radius_in_mean_free_paths": radius, "direction_to_light": LIGHTS[light],
             "resolution": [options.size, options.size]}
    if shape == "sphere":
        about["radius"] = RADIUS
    if options.coloured:
        return [{**about, "channel": channel, "sigma_s": sigma_s, "sigma_a": sigma_a} for channel in "RGB"]
    return [{**about, "channel": channel, "sigma_s": sigma_s[i], "sigma_a": sigma_a[i]}
            for i, channel in enumerate("RGB")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("referee", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--shapes", nargs="+", default=SHAPES, choices=SHAPES)
    parser.add_argument("--radii", nargs="+", type=float, default=[1, 3, 10])
    parser.add_argument("--indices", nargs="+", type=float, default=[1.3, 1.5], metavar="ETA")
    parser.add_argument("--g", type=float, default=0.0)
    parser.add_argument("--roughness", type=float, default=0.0, metavar="ALPHA", help="GGX's, not of spheres")
    parser.add_argument("--coloured", nargs=3, type=float, metavar=("RED", "GREEN", "BLUE"),
                        help="red, green and blue are so many times the radius asked for, of unlike albedo")
    parser.add_argument("--paths", type=int, default=256, help="for a pixel (default: 256)")
    parser.add_argument("--size", type=int, default=96, help="pixels on a side (default: 96)")
    parser.add_argument("--threads", type=int, default=0, help="(default: all cores)")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    manifest = options.folder / "manifest.json"
    told = json.loads(manifest.read_text())["images"] if manifest.exists() else []
    for radius, eta, shape, light in itertools.product(options.radii, options.indices, options.shapes, LIGHTS):
        images = make(options, shape, radius, eta, light)
        told = [image for image in told if image["file"] != images[0]["file"]] + images
        manifest.write_text(json.dumps({"camera": CAMERA, "images": told}, indent=1) + "\n")


if __name__ == "__main__":
    main()
