# Renders a reference with Cycles, or finds it in the cache.
"""See `render`."""

import json
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy

from .. import export, native_module
from . import fingerprint, kinds, nodes, recipes, settings
from .console import Console
from .grain_values import GrainValues
from .limits import limits
from .stage import Stage

SEEDS = (1, 2)
"""Two independent references: their difference is the noise, their mean the reference."""

PROVENANCE = "mesograin:provenance"
"""The string attribute of an EXR file that holds where it comes from, as JSON."""


class ReferenceError(Exception):
    """No reference can be rendered; one sentence."""


@dataclass(frozen=True)
class Reference:
    """images: one (h, w, 4) float32 array for each seed, linear, premultiplied, row 0 at the top; alpha: coverage.
    seconds: what rendering them took, now or when they were put into the cache. cached: whether nothing was rendered.
    provenance: one dict for each seed. notes: sentences about what Cycles could not express exactly."""

    images: tuple
    seconds: float
    cached: bool
    provenance: tuple
    notes: tuple

    @property
    def mean(self):
        """The reference itself, (h, w, 4) float32."""
        return numpy.mean(self.images, axis=0, dtype=numpy.float64).astype(numpy.float32)


def render(depsgraph, kind, size, samples=None, seeds=SEEDS, cache=None, overrides=None, on_progress=None):
    """Renders what `depsgraph` shows with the Cycles materials of a kind of reference; the user's scene stays as it is.

    depsgraph: evaluated, of the scene with its `mesograin` properties. kind: a name in `kinds.KINDS`.
    size: (width, height) in pixels. samples: per pixel and seed; the kind's default if None.
    cache: a `Cache`, or None for none. overrides: {parameter: value} for every material, coefficients per scene unit.
    on_progress: called with the fraction done, from any thread.
    Raises ReferenceError, StageError or native.Error with one sentence.
    """
    kind = kinds.KINDS[kind]
    samples = samples or kind.samples
    overrides = overrides or {}
    notes = _check(depsgraph, kind, overrides)
    steps = len(seeds) + kind.coverage_pass
    tell = on_progress or (lambda fraction: None)

    def shoot(step, kind, samples, seed):
        def on_shot(done):
            tell((step + done) / steps)

        return _shot(depsgraph, kind, size, samples, seed, cache, overrides, on_shot)

    shots = [shoot(step, kind, samples, seed) for step, seed in enumerate(seeds)]
    images = [shot.pixels for shot in shots]
    if kind.coverage_pass:
        covering = shoot(len(seeds), kinds.COVERAGE, kinds.COVERAGE.samples, 0)
        for image in images:
            image[..., 3] = covering.pixels[..., 3]
    return Reference(
        images=tuple(images),
        seconds=sum(shot.provenance["seconds"] for shot in shots),
        cached=all(shot.cached for shot in shots),
        provenance=tuple(shot.provenance for shot in shots),
        notes=notes,
    )


@dataclass(frozen=True)
class _Shot:
    pixels: numpy.ndarray
    provenance: dict
    cached: bool


def _values(depsgraph, overrides, material):
    """GrainValues of a bpy.types.Material, or of the default grain for faces that have none (None)."""
    parameters = dict(export.material_values(material, depsgraph.scene.mesograin.millimetres_per_unit).values)
    return GrainValues.from_parameters({**parameters, **overrides})


def _check(depsgraph, kind, overrides):
    """Raises ReferenceError for the first material that Cycles cannot render; returns what it can only approximate."""
    materials = {}
    for instance in depsgraph.object_instances:
        for slot in instance.object.material_slots if instance.show_self else ():
            if slot.material:
                materials[slot.material.name] = slot.material.original
    notes = []
    for name, material in sorted(materials.items()):
        for limit in limits(_values(depsgraph, overrides, material), kind.name):
            sentence = f"Material '{name}': {limit.sentence}"
            if limit.fatal:
                raise ReferenceError(sentence)
            notes.append(sentence)
    return tuple(notes)


def _shot(depsgraph, kind, size, samples, seed, cache, overrides, on_progress):
    """One image of one seed, from the cache or rendered into it."""
    native = native_module.get()
    source = depsgraph.scene.render
    description = settings.settings(kind, samples, seed, size, (source.pixel_aspect_x, source.pixel_aspect_y))
    used = {}

    def build(material):
        recipe = recipes.recipe(kind.name, _values(depsgraph, overrides, material), nodes.features())
        made = nodes.build("Mesograin reference", recipe)
        used[made.name] = recipe
        return made

    with Stage(depsgraph, description, build) as stage:
        determined_by = fingerprint.describe(stage.scene, used, description)
        key = fingerprint.key(determined_by)
        found = _read_cached(native, cache, key)
        if found:
            on_progress(1.0)
            return found
        started = time.monotonic()
        pixels = _render_stage(native, stage.scene, on_progress)
        seconds = time.monotonic() - started
    provenance = {
        "made_by": f"Mesograin {native.__version__}",
        "blender": f"{determined_by['blender']} ({determined_by['build']})",
        "reference": kind.name,
        "samples": samples,
        "seed": seed,
        "bounces": kind.bounces,
        "pixel_filter": "box, one pixel",
        "colour_space": "linear, scene-referred; alpha is premultiplied",
        "seconds": round(seconds, 3),
        "materials": list(used.values()),
        "key": key,
    }
    # As it will come back from a file.
    provenance = json.loads(json.dumps(provenance))
    if cache:
        try:
            cache.store(
                key, lambda path: native.write_exr(path, pixels, attributes={PROVENANCE: json.dumps(provenance)})
            )
        except (OSError, native.Error) as error:
            print(f"The reference is not kept: {error}")
    return _Shot(pixels, provenance, cached=False)


def _read_cached(native, cache, key):
    path = cache.find(key) if cache else None
    if not path:
        return None
    try:
        pixels, _, attributes = native.read_exr(path)
        return _Shot(pixels, json.loads(attributes[PROVENANCE]), cached=True)
    except (native.Error, KeyError, ValueError):
        cache.forget(key)
        return None


def _render_stage(native, scene, on_progress):
    """What Cycles renders of a staged scene, (h, w, 4) float32."""
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
    order = [channels.index(name) for name in "RGBA"]
    return numpy.ascontiguousarray(pixels[..., order])
