"""How far light between grains is from path tracing: totals and blocks of a heap of 696 balls, or of other grains
turned this way and that in their places, for kinds of grains and lights.

    heap_light.py BUILD_FOLDER [--grains G] [--kinds K ...] [--lights L ...] [--models M ...] [--exchanges E ...]
        [--samples N] [--paths N] [--angle DEGREES] [--out FOLDER] [--markdown FILE]

The truth is traced beside it (mesograin-referee heap, of others than balls render): so many paths a pixel, and its
own noise in blocks is told.
Errors are relative L1 in blocks of 8 x 8 pixels of a picture of 96 x 96, over all channels. A sun that balls with a
refracting surface are lit by is 20 degrees wide, or as wide as asked for: where it is narrower than 17 the balls are
traced as meshes, for which the sun's light in them is stored (g 0 alone), as no path finds it, and light counts
that was scattered: what flat facets mirror of it is not what balls do. What is drawn with the exchange off is
also told, in green, beside the share of the truth that was scattered in one ball alone and went through all others
unscattered; its noise is not told, and about that of the truth. Writes heap_light.json and heap_light.html, and prints
a line for each.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import heap_light_page
import numpy
from heap_grains import GRAINS, mesh, turns

DATA = pathlib.Path(__file__).resolve().parents[1] / "data/heaps"
MANIFEST = json.loads((DATA / "manifest.json").read_text())
SIZE = MANIFEST["resolution"]
SUNS = {"sun": 45.0, "low": 15.0}
LIGHTS = [*SUNS, "sky"]
WIDE, NARROW = math.radians(20.0), 0.3
"""Suns across: by default, and what the referee stores (docs/referee.md)."""


def medium(albedo, radius, eta=None, g=0):
    """A material as tests/data/heaps/manifest.json has it; albedo and radius (mean free paths): one, or by channel."""
    albedo, radius = numpy.broadcast_arrays(numpy.asarray(albedo, float), numpy.asarray(radius, float))
    return {"kind": "subsurface", "sigma_s": (albedo * radius).tolist(), "sigma_a": ((1.0 - albedo) * radius).tolist(),
            "g": g, **({"boundary": "index_matched"} if eta is None else {"boundary": "dielectric", "eta": eta})}


KINDS = {"lambert .3": {"kind": "diffuse", "reflectance": 0.3}, "lambert .8": {"kind": "diffuse", "reflectance": 0.8},
         **{f"{albedo:.3g} radius {radius}".lstrip("0"): medium(albedo, radius)
            for albedo in (0.9, 0.999) for radius in (1, 3, 10)},
         "coloured": medium((0.999, 0.97, 0.8), (1.0, 3.0, 5.0)),
         "eta 1.3": medium(0.999, 3, 1.3), "eta 1.5": medium(0.999, 3, 1.5),
         "coloured, eta 1.5": medium((0.999, 0.97, 0.8), (1.0, 3.0, 5.0), 1.5),
         "forward, eta 1.3": medium(0.999, 8, 1.3, g=0.8), "clear": medium(0.999, 0.2, 1.5)}


def light_of(name, material, grains="balls", angle=WIDE):
    if name == "sky":
        return {"type": "hemisphere"}
    above = math.radians(SUNS[name])
    aside = (math.cos(above), 0.0) if name == "sun" else (0.0, math.cos(above))
    return {"type": "distant", "direction_to_light": [*aside, math.sin(above)],
            "angle": angle if "eta" in material or grains != "balls" else 0.0}


def truth_of_scene(native, referee, traced, paths, folder, seen, size, scattered=False):
    """(picture, its noise in blocks over the mean) of a native.Scene, seen by a native.Camera; of what was scattered
    alone, if asked for."""
    case, picture = folder / "scene.json", folder / "truth.exr"
    native.write_scene(str(case), traced, seen, size)
    subprocess.run([referee, "render", case, "-o", picture, "-n", str(paths),
                    *["--scattered"] * scattered], check=True, stderr=subprocess.DEVNULL)
    channel = channels(native, picture)
    noise = numpy.sqrt(blocks((channel["noise.G"] ** 2)[..., None])) / 8.0
    return numpy.stack([channel[name] for name in "RGB"], -1), float(noise.mean() / channel["G"].mean())


def channels(native, picture):
    pixels, names, _ = native.read_exr(picture)
    return dict(zip(names, numpy.moveaxis(pixels, -1, 0)))


def truth(native, referee, material, light, paths, folder):
    """(picture, its noise in blocks over the mean, its share in green of one ball alone, (h, w, 1))."""
    case, picture = folder / "heap.json", folder / "truth.exr"
    case.write_text(json.dumps({"spheres": str(DATA / "spheres.csv"), "camera": MANIFEST["camera"], "resolution": SIZE,
                                "material": material, "light": light}))
    subprocess.run([referee, "heap", case, "-o", picture, "-n", str(paths)], check=True)
    channel = channels(native, picture)
    noise = numpy.sqrt(blocks((channel["noise.G"] ** 2)[..., None])) / 8.0
    colours = numpy.stack([channel[name] for name in "RGB"], -1)
    own = sum(channel[f"{name}.G"] for name in ("direct", "crossed", "behind"))
    return colours, float(noise.mean() / channel["G"].mean()), own[..., None]


def blocks(picture):
    height, width = picture.shape[:2]
    return picture.reshape(height // 8, 8, width // 8, 8, -1).mean(axis=(1, 3))


def how_far(found, right):
    """(ratio of totals, relative L1 in blocks)."""
    return (float(found.sum() / right.sum()),
            float(numpy.abs(blocks(found) - blocks(right)).sum() / blocks(right).sum()))


def scene(native, material, model, light, exchange, grains="balls", specular=True):
    if material["kind"] == "diffuse":
        look = native.Material(model=model, reflectance=(material["reflectance"],) * 3)
    else:
        sigmas = {name: tuple(numpy.broadcast_to(material[name], 3)) for name in ("sigma_a", "sigma_s")}
        look = native.Material(model=model, boundary=material["boundary"], eta=material.get("eta", 1.3),
                               g=material["g"], specular=specular, **sigmas)
    if light["type"] == "distant":
        sun = native.DirectionalLight(light["direction_to_light"], (math.pi,) * 3, angle=light["angle"])
        shines = {"lights": [sun]}
    else:
        sky = numpy.zeros((64, 128, 3), numpy.float32)
        sky[:32] = 1.0
        shines = {"world": native.World(image=native.Surroundings(sky))}
    return native.Scene(arrays=[heap(native, look, grains)], exchange=exchange, **shines)


def heap(native, look, grains):
    """Such grains, one of GRAINS, in the places of the balls, as a native.InstanceArray of a native.Material."""
    places = numpy.loadtxt(DATA / "spheres.csv", delimiter=",", skiprows=1)
    transforms = numpy.zeros((len(places), 4, 4))
    transforms[:, :3, :3] = places[:, 3, None, None] * (numpy.eye(3) if grains == "balls" else turns(len(places)))
    transforms[:, :3, 3] = places[:, :3]
    transforms[:, 3, 3] = 1.0
    return native.InstanceArray(mesh(native, grains), look, transforms)


def camera(native, part=1.0):
    """That of the stored truth; of its picture's middle, such a part of its width and height."""
    seen = MANIFEST["camera"]
    axes = numpy.array([seen["right"], seen["up"], [-x for x in seen["direction"]]])
    world_to_camera = numpy.eye(4)
    world_to_camera[:3, :3] = axes
    world_to_camera[:3, 3] = -axes @ (numpy.array(seen["centre"]) - 60.0 * numpy.array(seen["direction"]))
    clip = numpy.diag([1.0 / (part * seen["half_width"]), 1.0 / (part * seen["half_height"]), -2.0 / 199.0, 1.0])
    clip[2, 3] = -201.0 / 199.0
    return native.Camera(world_to_camera, clip)


def measure(native, of, model, exchange, samples, grains, specular=True):
    """One way to draw a heap against its truth: numbers as a dictionary, and the picture."""
    material, light, (right, noise, own) = of
    view = native.View(*SIZE)
    view.set_scene(scene(native, material, model, light, exchange, grains, specular))
    view.set_camera(camera(native))
    view.render(samples)
    found = view.read()[..., :3]
    total, in_blocks = how_far(found, right)
    numbers = {"model": model, "exchange": exchange, "total": total, "truth_noise": noise, "blocks": in_blocks,
               "finite": bool(numpy.isfinite(found).all())}
    if exchange == "off" and own is not None:
        numbers["own_total"], numbers["own_blocks"] = how_far(found[..., 1:2], own)
    return numbers, found


def own_share(case):
    """What a line says beside: how far light that met one ball alone is from its share of the truth."""
    return f"  met one ball alone {case['own_total']:.3f} {case['own_blocks']:.1%}" if "own_total" in case else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the folder of the native module and of the referee")
    parser.add_argument("--grains", default="balls", choices=GRAINS, help="(default: balls)")
    parser.add_argument("--kinds", nargs="+", default=list(KINDS), choices=list(KINDS), metavar="K",
                        help=f"of grains: {', '.join(KINDS)} (default: all)")
    parser.add_argument("--lights", nargs="+", default=LIGHTS, choices=LIGHTS)
    parser.add_argument("--models", nargs="+", default=["model_2"],
                        help="of grains that are no lambert (default: model_2)")
    parser.add_argument("--exchanges", nargs="+", default=["order_1", "gathered"],
                        choices=["off", "order_1", "heaps", "gathered", "path_traced"])
    parser.add_argument("--samples", type=int, default=16, help="of each picture (default: 16)")
    parser.add_argument("--paths", type=int, default=128, help="of the truth, a pixel (default: 128)")
    parser.add_argument("--angle", type=float, default=math.degrees(WIDE), metavar="DEGREES",
                        help="across the suns of grains that refract, or are no balls (default: 20)")
    parser.add_argument("--out", type=pathlib.Path, metavar="FOLDER", help="for the page and the JSON (default: .)",
                        default=pathlib.Path())
    parser.add_argument("--markdown", type=pathlib.Path, metavar="FILE", help="also writes a table there")
    options = parser.parse_args()
    sys.path.insert(0, options.build)
    import mesograin_native as native

    referee = pathlib.Path(options.build) / "tests/referee/mesograin-referee"
    options.out.mkdir(parents=True, exist_ok=True)
    cases, pictures = [], []
    with tempfile.TemporaryDirectory() as folder:
        for kind in options.kinds:
            material = KINDS[kind]
            label = kind if options.grains == "balls" else f"{kind}, {options.grains}"
            for name in options.lights:
                light = light_of(name, material, options.grains, math.radians(options.angle))
                stored = 0.0 < light.get("angle", 0.0) < NARROW
                # Few paths find the wide sun, or lights that a path must leave the heap towards.
                paths = options.paths * (16 if light.get("angle") and not stored else 1)
                if options.grains == "balls" and not stored:
                    right = truth(native, referee, material, light, paths, pathlib.Path(folder))
                else:
                    traced = scene(native, material, "lambert" if material["kind"] == "diffuse" else "model_2", light,
                                   "off", options.grains)
                    traced_picture = truth_of_scene(native, referee, traced, paths, pathlib.Path(folder),
                                                    camera(native), SIZE, stored)
                    right = (*traced_picture, None)
                of = (material, light, right)
                drawn = []
                for model in ["lambert"] if material["kind"] == "diffuse" else options.models:
                    for exchange in options.exchanges:
                        numbers, found = measure(native, of, model, exchange, options.samples, options.grains,
                                                 not stored)
                        case = {"kind": label, "light": name, "refracts": "eta" in material, **numbers}
                        cases.append(case)
                        drawn.append((f"{model}, {exchange}", found))
                        print(f"{label:<16}{name:<5}{model:<9}{exchange:<9}{case['total']:>7.3f}{case['blocks']:>7.1%}"
                              f"  truth's noise {case['truth_noise']:.1%}" + own_share(case), flush=True)
                pictures.append(heap_light_page.pictures_of(label, name, of[2][0], drawn))
    (options.out / "heap_light.json").write_text(json.dumps(cases, indent=1) + "\n")
    (options.out / "heap_light.html").write_text(heap_light_page.html(
        cases, pictures, spheres=len(numpy.loadtxt(DATA / "spheres.csv", delimiter=",", skiprows=1)), size=SIZE,
        samples=options.samples, paths=options.paths))
    if options.markdown:
        options.markdown.write_text(heap_light_page.markdown(cases))


if __name__ == "__main__":
    main()
