"""Reads thousands of files that were damaged at random, in a process of its own whose memory is limited: a crash ends
nothing else. Prints a line for each file whose reading ended otherwise than it may, then how many were read and how
many were refused."""
import io
import json
import pathlib
import resource
import sys
import tempfile

import numpy as np

MEMORY = 4 << 30  # bytes of address space: a damaged header may announce any size
SEED = 20240229
TORUS = [[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]
FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def scene(geometry):
    """A scene that says everything a scene may say."""
    return {
        "geometry": geometry,
        "camera": {"position": [0, -4, 1], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov_degrees": 40},
        "resolution": [16, 16],
        "lights": [{"type": "distant", "direction_to_light": [1, -1, 1], "irradiance_linear_rgb": [3, 2, 1],
                    "angle": 0.01}],
        "material": {"kind": "subsurface", "sigma_s": [1, 2, 3], "sigma_a": 0.1, "g": 0.3, "eta": 1.3, "scale": 2,
                     "roughness": 0.2, "boundary": "dielectric", "masking": "separable", "profile": "better_dipole"},
    }


def heap(instances):
    """A scene of two objects, one of them a heap."""
    whole = scene({"shape": "sphere", "radius": 1})
    grain = {"geometry": whole.pop("geometry"), "material": "sand", "instances": instances}
    materials = {"sand": whole.pop("material")}
    return {**whole, "materials": materials, "objects": [
        grain, {"geometry": {"shape": "sphere", "centre": [0, 0, -9], "radius": 8},
                "material": {"kind": "diffuse", "reflectance": 0.5}}]}


def npy():
    data = io.BytesIO()
    np.save(data, np.random.default_rng(SEED).random((7, 3, 4)) + 4.0 * np.eye(3, 4))
    return data.getvalue()


def obj():
    corners = "".join(f"v {x} {y} {z}\nvn {x - .5} {y - .5} {z - .5}\nvt {x} {y}\n" for x, y, z in TORUS)
    return ("# a cube\no grain\n" + corners + "".join(
        "f " + " ".join(f"{i + 1}/{i + 1}/{i + 1}" for i in face) + "\n" for face in FACES)).encode()


def ply_header(form):
    return (f"ply\nformat {form} 1.0\ncomment a cube\nelement vertex 8\nproperty float x\nproperty float y\n"
            "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n").encode()


def ascii_ply():
    rows = [" ".join(map(str, corner)) for corner in TORUS] + ["4 " + " ".join(map(str, face)) for face in FACES]
    return ply_header("ascii") + "\n".join(rows).encode() + b"\n"


def binary_ply():
    faces = b"".join(b"\4" + np.array(face, "<i4").tobytes() for face in FACES)
    return ply_header("binary_little_endian") + np.array(TORUS, "<f4").tobytes() + faces


def damage(data, random):
    """`data` with a few bytes changed, cut out, repeated or cut off."""
    data = bytearray(data)
    for _ in range(random.integers(1, 5)):
        if not data:
            break
        place = int(random.integers(len(data)))
        length = int(random.integers(1, 9))
        match random.integers(5):
            case 0:
                data[place] = random.integers(256)
            case 1:
                data[place] ^= 1 << int(random.integers(8))
            case 2:
                del data[place:place + length]
            case 3:
                data[place:place] = data[place:place + length] * int(random.integers(1, 4))
            case 4:
                data = data[:place] if random.random() < 0.3 else data[:place] + random.bytes(length) + data[place:]
    return bytes(data)


def sources(native, folder):
    """(ending, bytes of a whole file, how often it is damaged, what reads such a file)."""
    def read_mesh(path):
        native.load_scene(scene({"shape": "mesh", "file": str(path)}))

    def read_places(path):
        native.load_scene(heap({"file": str(path)}))

    pixels = np.random.default_rng(SEED).random((9, 7, 4), np.float32)
    native.write_exr(folder / "whole.exr", pixels, attributes={"mesograin:seed": "7"})
    native.write_exr(folder / "half.exr", pixels, channels=["depth.Z", "A", "B", "R"], half=True)
    sphere = json.dumps(scene({"shape": "sphere", "centre": [0, 0, 0], "radius": 1})).encode()
    inline = json.dumps(heap({"positions": [[1, 2, 3], [4, 5, 6]], "scales": [1, 2]})).encode()
    return [(".json", sphere, 1000, native.load_scene), (".json", inline, 500, native.load_scene),
            (".npy", npy(), 400, read_places), (".ply", ascii_ply(), 200, read_places),
            (".obj", obj(), 600, read_mesh),
            (".ply", ascii_ply(), 400, read_mesh), (".ply", binary_ply(), 400, read_mesh),
            (".exr", (folder / "whole.exr").read_bytes(), 300, native.read_exr),
            (".exr", (folder / "half.exr").read_bytes(), 300, native.read_exr)]


def complaint(native, read, path):
    """(whether the file was read, what was wrong with how it ended or None)."""
    try:
        read(path)
    except native.Error as error:
        sentence = str(error)
        well = sentence.endswith(".") and len(sentence) > 20 and sentence.isprintable()
        return False, None if well else f"the sentence {sentence!r}"
    except Exception as error:  # whatever it is, it is none that a user can be told
        return False, f"{type(error).__name__}: {error}"
    return True, None


def main():
    sys.path.insert(0, sys.argv[1])
    import mesograin_native as native

    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    random = np.random.default_rng(SEED)
    outcomes = {True: 0, False: 0}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for ending, whole, count, read in sources(native, folder):
            path = folder / f"damaged{ending}"
            path.write_bytes(whole)
            read(path)
            for number in range(count):
                data = damage(whole, random)
                path.write_bytes(data)
                was_read, wrong = complaint(native, read, path)
                outcomes[was_read] += 1
                if wrong:
                    print(f"{ending} {number}: {wrong}; the file was {data[:2000]!r}")
    print(f"{outcomes[True]} read, {outcomes[False]} refused")


if __name__ == "__main__":
    main()
