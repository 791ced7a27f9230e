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
            self._bake(placed, scene, on_progress)
            pixels = numpy.empty(width * height * 4, numpy.float32)
            image.pixels.foreach_get(pixels)
        finally:
            bpy.data.images.remove(image)
        # Blender's rows begin at the bottom.
        return numpy.ascontiguousarray(pixels.reshape(height, width, 4)[::-1])

    def _bake(self, placed, scene, on_progress):
        with _shown(scene), Console(on_progress) as console:
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
