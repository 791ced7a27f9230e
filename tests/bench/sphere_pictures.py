"""Makes a folder for shapes.py: the referee's pictures of spheres, by radius, index, light and albedo.

    sphere_pictures.py REFEREE FOLDER [--paths N] [--size N]

REFEREE is the program mesograin-referee. What FOLDER holds already is not traced again.
"""
import argparse
import itertools
import json
import pathlib
import subprocess

RADIUS = 2.4
CAMERA = {"position": [0, 0, 6.5], "look_at": [0, 0, 0], "up": [0, 1, 0], "fov_degrees": 45}
LIGHTS = {"front": [0.5, 0.5, 0.70710678], "side": [0.8, 0.6, 0], "back": [-0.3, 0.4, -0.8660254]}
ALBEDOS = (0.5, 0.9, 0.999)  # each in a channel of its own
OPTICAL_RADII = (1, 3, 10)
INDICES = (1.0, 1.3, 1.5)


def scene(optical_radius, eta, light, size):
    sigma_t = optical_radius / RADIUS
    return {"geometry": {"shape": "sphere", "radius": RADIUS}, "camera": CAMERA, "resolution": [size, size],
            "lights": [{"type": "distant", "direction_to_light": LIGHTS[light], "irradiance_linear_rgb": 1}],
            "material": {"kind": "medium", "sigma_s": [sigma_t * albedo for albedo in ALBEDOS],
                         "sigma_a": [sigma_t * (1.0 - albedo) for albedo in ALBEDOS], "eta": eta, "specular": False,
                         "boundary": "index_matched" if eta == 1.0 else "dielectric"}}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("referee", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--paths", type=int, default=256, help="for a pixel (default: 256)")
    parser.add_argument("--size", type=int, default=96, help="pixels on a side (default: 96)")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    images = []
    for optical_radius, eta, light in itertools.product(OPTICAL_RADII, INDICES, LIGHTS):
        name = f"sphere_e{eta}_R{optical_radius}_{light}"
        picture = options.folder / f"{name}.exr"
        if not picture.exists():
            described = options.folder / f"{name}.json"
            described.write_text(json.dumps(scene(optical_radius, eta, light, options.size)))
            subprocess.run([options.referee, "render", described, "-o", picture, "-n", str(options.paths)], check=True)
        for channel, albedo in zip("RGB", ALBEDOS):
            sigma_t = optical_radius / RADIUS
            images.append({"file": picture.name, "channel": channel, "mesh": "sphere", "radius": RADIUS, "eta": eta,
                           "sigma_s": sigma_t * albedo, "sigma_a": sigma_t * (1.0 - albedo), "g": 0, "irradiance": 1,
                           "radius_in_mean_free_paths": optical_radius, "direction_to_light": LIGHTS[light],
                           "resolution": [options.size, options.size]})
    (options.folder / "manifest.json").write_text(json.dumps({"camera": CAMERA, "images": images}, indent=1) + "\n")


if __name__ == "__main__":
    main()
