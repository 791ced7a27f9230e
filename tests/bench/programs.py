"""What compiled programs cost: pictures of a ball by each model, of two media, under two worlds, told in all portions.

    programs.py BUILD_FOLDER

The models with the dearest programs come first, while none is freed yet; then all again, and memory should rest.
It is this process' own, so that on hardware, whose driver keeps programs elsewhere, the figures mean little.
"""
import argparse
import ctypes
import gc
import itertools
import pathlib
import sys
import time

import numpy

SIZE = 32
MEDIA = [{"sigma_s": (2.0, 2.0, 2.0), "sigma_a": (0.1, 0.1, 0.1), "eta": 1.0},
         {"sigma_s": (2.0, 2.5, 3.0), "sigma_a": (0.1, 0.1, 0.1), "eta": 1.3}]
OPAQUE = ("lambert", "conductor")
PORTIONS = (None, "diffuse", "specular", "subsurface", "single_scattering", "transmission", "exchange", "emission",
            "environment", "normal")
SKIES = (0.0, 0.5)
ROUNDS = 3
MORE = "transport"  # waits for seconds for what is told elsewhere


def resident():
    """Bytes of this process in memory."""
    gc.collect()
    ctypes.CDLL("libc.so.6").malloc_trim(0)
    text = pathlib.Path("/proc/self/status").read_text()
    return 1024 * int(text.split("VmRSS:")[1].split()[0])


def ball(native):
    theta = numpy.linspace(0.0, numpy.pi, 13)[:, None]
    phi = numpy.linspace(0.0, 2.0 * numpy.pi, 25)[None, :]
    places = numpy.stack(numpy.broadcast_arrays(numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi),
                                                numpy.cos(theta)), axis=-1).reshape(-1, 3).astype(numpy.float32)
    first = (numpy.arange(12)[:, None] * 25 + numpy.arange(24)[None, :]).ravel()
    halves = [(first, first + 25, first + 26), (first, first + 26, first + 1)]
    triangles = numpy.concatenate([numpy.stack(half, axis=-1) for half in halves]).astype(numpy.uint32)
    return native.Mesh(places, places, triangles)


def pictures(native):
    """Draws them one after the other; yields the model of each and the seconds of the processor that it took."""
    mesh = ball(native)
    view = native.View(SIZE, SIZE)
    view.set_camera(native.Camera.look_at((0.0, 0.4, 5.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0))
    models = [entry["name"] for entry in reversed(native.schema()["models"]) if entry["name"] != MORE]
    for model, medium, portion, sky in itertools.product(models, MEDIA, PORTIONS, SKIES):
        if model in OPAQUE and medium is not MEDIA[0]:
            continue
        material = native.Material(model=model, **({} if model in OPAQUE else medium))
        view.set_scene(native.Scene(instances=[native.Instance(mesh, material, numpy.eye(4))],
                                    lights=[native.DirectionalLight((0.5, 1.0, 0.7), (3.0, 2.5, 2.0))],
                                    world=native.World(radiance=(sky,) * 3, seen=True)))
        view.set_portions([portion] if portion else [])
        started = time.process_time()
        view.render(1)
        yield model, time.process_time() - started


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build")
    options = parser.parse_args()
    sys.path.insert(0, options.build)
    import mesograin_native as native

    def programs():
        sent = native.sent()
        return sent["programs"], sent["programs"] - sent["programs_freed"]

    print(f"{'model':<12}{'compiled':>9}{'there':>7}{'MB':>8}{'s a program':>13}{'MB a program':>14}")
    for _ in range(ROUNDS):
        for model, pictures_of_it in itertools.groupby(pictures(native), key=lambda picture: picture[0]):
            compiled = programs()[0]
            memory = resident()
            seconds = sum(seconds for _, seconds in pictures_of_it)
            more = programs()[0] - compiled
            print(f"{model:<12}{more:>9}{programs()[1]:>7}{resident() / 1e6:>8.0f}{seconds / max(more, 1):>13.3f}"
                  f"{(resident() - memory) / max(more, 1) / 1e6:>14.2f}")


if __name__ == "__main__":
    main()
