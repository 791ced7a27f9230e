# Whether the renderer works on this machine: a known answer, every model's shader against a kept picture, read-back.
import time

import numpy as np

from .. import native_module
from ..grains import kinds
from ..schema import models

EXACT = 1e-5
"""What the square, of which the answer is known, may be off."""
KEPT = {
    "lambert": (0.2689, 0.1681, 0.06723),
    "conductor": (0.1782, 0.1114, 0.04456),
    "model_1": (0.09445, 0.06925, 0.0512),
    "model_2": (0.1153, 0.0868, 0.06572),
    "model_3": (0.1147, 0.08616, 0.065),
}
"""Linear RGB of a bead's picture by models that draw at once, on average; held by tests/blender/test_self_test.py."""
ALIKE = 0.03
"""By which share of it drivers may differ: a shader that is drawn wrongly differs by more."""
SAMPLES = 16
READ = (1920, 1080)


def run():
    """Sentences on what works. Raises native.Error or native_module.Unavailable, with a sentence."""
    native = native_module.get()
    info = native.device_info()
    where = f"{info['renderer']}, OpenGL {info['version']}"
    off = square_error(native)
    if not off < EXACT:
        raise native.Error(f"{where} renders a lit square wrongly, by {off:.2g}: {_remedy()}")
    worst = 0.0
    for name in KEPT:
        off = bead_error(native, name)
        worst = max(worst, off)
        if not off < ALIKE:
            raise native.Error(f"{where} renders a bead of {models.MODELS[name].label} wrongly, by {off:.0%}: "
                               f"{_remedy()}")
    width, height = READ
    return [f"Mesograin renders correctly on {where}.",
            f"A bead by each of {len(KEPT)} models is what it should be, within {max(worst, 0.001):.1%}.",
            f"Reading {width} x {height} pixels back takes {1000.0 * read_back(native):.1f} ms."]


def _remedy():
    return "update the graphics driver, or choose Software in Mesograin's preferences."


def square_error(native):
    """Relative error of a white Lambertian square that fills the picture, lit from 60 degrees with irradiance pi: its
    radiance is the cosine, 1/2."""
    corners = np.array([(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)], dtype=np.float32)
    mesh = native.Mesh(corners, None, np.array([(0, 1, 2), (0, 2, 3)], dtype=np.uint32))
    material = native.Material(model="lambert", reflectance=(1.0, 1.0, 1.0))
    light = native.DirectionalLight(direction_to_light=(np.sqrt(3.0), 0.0, 1.0), irradiance=(np.pi,) * 3)
    view = _view(native, mesh, material, light, (8, 8), 2.0)
    view.render(4)
    return float(np.max(np.abs(view.read()[..., :3] / 0.5 - 1.0)))


def bead(native, model):
    """Linear RGB of the picture of a bead of radius 1, 6 mean free paths of red, lit from the side; on average."""
    made = kinds.make("bead", segments=8)
    triangles = made.faces[:, (0, 1, 2, 0, 2, 3)].reshape(-1, 3)
    mesh = native.Mesh(made.vertices.astype(np.float32), None, triangles.astype(np.uint32))
    material = native.Material(model=model, reflectance=(0.8, 0.5, 0.2), roughness=0.4, eta=1.4,
                               sigma_s=(5.4, 4.0, 3.0), sigma_a=(0.6, 0.8, 1.0))
    light = native.DirectionalLight(direction_to_light=(1.0, 0.5, 0.7), irradiance=(np.pi,) * 3)
    view = _view(native, mesh, material, light, (24, 24), 3.0)
    view.render(SAMPLES)
    return view.read()[..., :3].mean(axis=(0, 1))


def bead_error(native, model):
    """By which share of its brightest channel `bead` differs from what is kept."""
    kept = np.array(KEPT[model])
    return float(np.abs(bead(native, model) - kept).max() / kept.max())


def read_back(native):
    """Seconds to read a picture of READ back, the best of three times."""
    view = native.View(*READ)
    view.set_scene(native.Scene(instances=[]))
    view.set_camera(native.Camera.look_at((0.0, 0.0, 2.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 40.0))
    view.render(1)
    taken = []
    for _ in range(3):
        started = time.perf_counter()
        view.read()
        taken.append(time.perf_counter() - started)
    return min(taken)


def _view(native, mesh, material, light, size, distance):
    view = native.View(*size)
    view.set_scene(native.Scene(instances=[native.Instance(mesh, material, np.eye(4))], lights=[light]))
    view.set_camera(native.Camera.look_at((0.0, 0.0, distance), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 40.0))
    return view
