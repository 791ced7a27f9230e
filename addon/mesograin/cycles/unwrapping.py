# What Cycles bakes of one object of a staged scene, instead of what its camera sees.
"""See `Unwrapping`."""

import contextlib
import hashlib
from dataclasses import dataclass

import bpy
import numpy

from .console import Console
from .shot import ReferenceError

SETTINGS = {
    "target": "IMAGE_TEXTURES",
    "save_mode": "INTERNAL",
    "margin": 0,
    "use_clear": False,
    "use_selected_to_active": False,
    "use_cage": False,
    "use_split_materials": False,
    "use_pass_direct": True,
    "use_pass_indirect": True,
    "use_pass_diffuse": True,
    "use_pass_glossy": True,
    "use_pass_transmission": True,
    "use_pass_emit": True,
}


PARTS = 16
"""What Cycles says of a bake under way is nothing at all, so its samples are baked in as many parts: the same samples
of the same sequence, whose mean differs from that of one bake by rounding alone."""


@dataclass(frozen=True)
class Unwrapping:
    """name: of the object to bake, whose first instance counts. view_from: `above_surface` or `active_camera`."""

    name: str
    view_from: str

    def describe(self, stage):
        """What determines the texture besides the staged scene, JSON-able. Raises ReferenceError."""
        placed = self._placed(stage)
        layer = self._layer(placed)
        uvs = numpy.empty(len(layer.data) * 2, numpy.float32)
        layer.data.foreach_get("uv", uvs)
        return {
            "settings": SETTINGS,
            "view_from": self.view_from,
            "matrix": [list(row) for row in placed.matrix_world],
            "uvs": hashlib.sha256(uvs.tobytes()).hexdigest(),
        }

    def render(self, stage, size, on_progress):
        """(h, w, 4) float32 by Cycles: linear radiance; alpha is 1 where a texel was baked; row 0 is v = 1."""
        placed = self._placed(stage)
        scene = stage.scene
        for name, value in SETTINGS.items():
            setattr(scene.render.bake, name, value)
        scene.render.bake.view_from = self.view_from.upper()
        width, height = size
        image = bpy.data.images.new("Mesograin bake", width, height, alpha=True, float_buffer=True, is_data=True)
        try:
            image.generated_color = (0.0, 0.0, 0.0, 0.0)
            for material in placed.data.materials:
                node = material.node_tree.nodes.new("ShaderNodeTexImage")
                node.image = image
                material.node_tree.nodes.active = node
            pixels = self._mean(placed, scene, image, on_progress)
        finally:
            bpy.data.images.remove(image)
        # Blender's rows begin at the bottom.
        return numpy.ascontiguousarray(pixels.reshape(height, width, 4)[::-1])

    def _mean(self, placed, scene, image, on_progress):
        """The image's pixels after all of the scene's samples, (4 w h,) float32."""
        samples = scene.cycles.samples
        total = numpy.zeros(len(image.pixels))
        pixels = numpy.empty(len(image.pixels), numpy.float32)
        for done, part in _parts(samples):
            _take_samples(scene.cycles, done, part)
            self._bake(placed, scene)
            image.pixels.foreach_get(pixels)
            total += part * pixels.astype(numpy.float64)
            on_progress((done + part) / samples)
        return (total / samples).astype(numpy.float32)

    def _bake(self, placed, scene):
        with _shown(scene), Console() as console:
            for other in scene.objects:
                other.select_set(other == placed)
            scene.view_layers[0].objects.active = placed
            scene.view_layers[0].update()
            try:
                outcome = bpy.ops.object.bake(type="COMBINED", uv_layer=self._layer(placed).name)
            except RuntimeError as error:
                raise ReferenceError(f"Cycles could not bake '{self.name}': {' '.join(str(error).split())}") from error
        if "FINISHED" not in outcome:
            reason = next((line for line in reversed(console.lines) if "rror" in line), "Cycles gave no reason")
            raise ReferenceError(f"Cycles could not bake '{self.name}': {reason}.")

    def _placed(self, stage):
        try:
            return stage.placed[self.name]
        except KeyError:
            raise ReferenceError(f"There is no object '{self.name}' to bake with Cycles.") from None

    def _layer(self, placed):
        layer = next((layer for layer in placed.data.uv_layers if layer.active_render), None)
        if layer is None:
            raise ReferenceError(f"Object '{self.name}' has no UVs to bake at: unwrap it (UV > Unwrap in Edit Mode).")
        return layer


def _parts(samples):
    """(samples before it, samples of it) of each part."""
    step = -(-samples // PARTS)
    return [(done, min(step, samples - done)) for done in range(0, samples, step)]


def _take_samples(cycles, done, count):
    """Makes Cycles take `count` samples of its sequence, from the sample `done` on."""
    cycles.samples, cycles.sample_offset = count, done
    if hasattr(cycles, "use_sample_subset"):  # where an offset counts in a subset alone
        cycles.samples = done + count
        cycles.use_sample_subset, cycles.sample_subset_length = True, count


@contextlib.contextmanager
def _shown(scene):
    """While it lasts, the window shows `scene`, which is what an operator without an override works on.

    Not `temp_override`: an operator runs without Python's lock, and Blender before Python 3.12 looks up what Python
    overrides without taking it whenever any other thread of Python's runs, as the console's does; that crashes.
    """
    window = bpy.context.window
    if window is None:
        raise ReferenceError("Cycles bakes what a window shows, and here is none: "
                             "bake from a script or an operator, not from a timer.")
    before, layer = window.scene, window.view_layer
    window.scene = scene
    try:
        yield
    finally:
        window.scene, window.view_layer = before, layer
