# One image of one seed, rendered with Cycles or found in the cache.
"""See `take`."""

import json
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy

from .. import native_module
from ..scene import export
from . import beside, fingerprint, nodes, passes, recipes, settings
from .console import Console
from .grain_values import GrainValues
from .stage import Stage

PROVENANCE = "mesograin:provenance"
"""The string attribute of an EXR file that holds where it comes from, as JSON."""


class ReferenceError(Exception):
    """No reference can be rendered; one sentence."""


@dataclass(frozen=True)
class Shot:
    """pixels: (h, w, 4) float32, linear, row 0 at the top. provenance: JSON-able. cached: whether it was found."""

    pixels: numpy.ndarray
    provenance: dict
    cached: bool


def _parameters(depsgraph, material):
    return dict(export.material_values(material, depsgraph.scene.mesograin.millimetres_per_unit).values)


def grain_values(depsgraph, overrides, material):
    """GrainValues of a bpy.types.Material, or of the default grain for faces that have none (None)."""
    return GrainValues.from_parameters({**_parameters(depsgraph, material), **overrides})


def _recipe(depsgraph, kind, overrides, material, staying):
    name = kind.recipe
    if material is not None and material.name_full in staying:
        name, overrides = beside.recipe_name(kind, _parameters(depsgraph, material)["model"]), {}
    return recipes.recipe(name, grain_values(depsgraph, overrides, material), nodes.features())


def take(
    depsgraph, kind, size, samples, seed, cache=None, overrides=None, on_progress=None, unwrapping=None,
    staying=frozenset()
):
    """One image of one seed, from the cache or rendered into it: a Shot.

    kind: kinds.Kind. unwrapping: `unwrapping.Unwrapping` for a baked texture instead of a picture. staying: of
    `beside.stays`. The rest as in `reference.Sampling`. Raises ReferenceError, StageError or native.Error.
    """
    on_progress = on_progress or (lambda fraction: None)
    native = native_module.get()
    source = depsgraph.scene.render
    description = settings.settings(kind, samples, seed, size, (source.pixel_aspect_x, source.pixel_aspect_y))
    used = {}

    def build(material):
        recipe = _recipe(depsgraph, kind, overrides or {}, material, staying)
        made = nodes.build("Mesograin reference", recipe)
        used[made.name] = recipe
        return made

    with Stage(depsgraph, description, build, kind.least_sun, unwrapping and unwrapping.name) as stage:
        determined_by = fingerprint.describe(stage, used, description)
        if unwrapping:
            determined_by["unwrapping"] = unwrapping.describe(stage)
        if kind.light != "all":
            determined_by["light"] = kind.light
        key = fingerprint.key(determined_by)
        found = read_cached(native, cache, key, size)
        if found:
            on_progress(1.0)
            return found
        started = time.monotonic()
        if unwrapping:
            pixels = unwrapping.render(stage, size, on_progress)
        else:
            pixels = render_stage(native, stage.scene, on_progress, kind.light)
        seconds = time.monotonic() - started
    provenance = {
        "made_by": f"Mesograin {native.__version__}",
        "blender": f"{determined_by['blender']} ({determined_by['build']})",
        "reference": kind.name,
        "light": kind.light,
        "samples": samples,
        "seed": seed,
        "bounces": kind.longest_path,
        "pixel_filter": "box, one pixel",
        "colour_space": "linear, scene-referred; alpha is premultiplied",
        "seconds": round(seconds, 3),
        "materials": list(used.values()),
        "key": key,
    }
    if unwrapping:
        provenance.update(object=unwrapping.name, view_from=unwrapping.view_from)
    # As it will come back from a file.
    provenance = json.loads(json.dumps(provenance))
    return keep(native, cache, key, Shot(pixels, provenance, cached=False))


def keep(native, cache, key, shot):
    """Puts a Shot into the cache, if there is one and it can be written; returns it."""
    if cache:
        try:
            cache.store(
                key,
                lambda path: native.write_exr(
                    path, shot.pixels, attributes={PROVENANCE: json.dumps(shot.provenance)}
                ),
            )
        except (OSError, native.Error) as error:
            reason = f"{cache.folder}: {error.strerror}." if isinstance(error, OSError) else error
            print(f"The reference is not kept: {reason}")
    return shot


def read_cached(native, cache, key, size):
    """The Shot of (width, height) pixels under this key, or None; a file that holds anything else is removed."""
    path = cache.find(key) if cache else None
    if not path:
        return None
    try:
        pixels, _, attributes = native.read_exr(path)
        provenance = json.loads(attributes[PROVENANCE])
        if pixels.shape == (size[1], size[0], 4) and provenance["key"] == key:
            return Shot(pixels, provenance, cached=True)
    except (native.Error, KeyError, ValueError, TypeError):
        pass
    cache.forget(key)
    return None


def render_stage(native, scene, on_progress, light="all"):
    """What Cycles renders of a staged scene, (h, w, 4) float32. light: of `kinds.Kind`."""
    if light != "all":
        passes.ask_for(scene)
    with tempfile.TemporaryDirectory(prefix="mesograin-") as folder:
        scene.render.filepath = str(Path(folder) / "reference")
        with Console(on_progress) as console:
            try:
                outcome = bpy.ops.render.render(scene=scene.name, write_still=True)
            except RuntimeError as error:
                raise ReferenceError(
                    f"Cycles could not render the reference: {' '.join(str(error).split())}"
                ) from error
        files = list(Path(folder).glob("*.exr"))
        if "FINISHED" not in outcome or not files:
            reason = next((line for line in reversed(console.lines) if "rror" in line), "Cycles gave no reason")
            raise ReferenceError(f"Cycles could not render the reference: {reason}.")
        pixels, channels, _ = native.read_exr(files[0])
    if light != "all":
        return passes.read(pixels, channels, light)
    order = [channels.index(name) for name in "RGBA"]
    return numpy.ascontiguousarray(pixels[..., order])
