# What Cycles bakes of one object of a staged scene, instead of what its camera sees.
"""See `Unwrapping`."""

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
        view_layer = scene.view_layers[0]
        view_layer.update()
        chosen = {"active_object": placed, "object": placed, "selected_objects": [placed],
                  "selected_editable_objects": [placed]}
        with Console(on_progress) as console, \
                bpy.context.temp_override(scene=scene, view_layer=view_layer, **chosen):
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
