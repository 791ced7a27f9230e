# The file as it is in memory, saved beside for a background Blender, without a trace in the artist's session.
"""See `save` and `load`."""

from pathlib import Path

import bpy
import numpy as np


def save(folder):
    """Saves a copy into `folder` and returns what `load` needs, as plain values. The open file keeps its path, its undo
    history and whether it is changed. Raises OSError or RuntimeError if the copy cannot be written."""
    name = Path(bpy.data.filepath).name or "unsaved.blend"
    path = Path(folder) / name
    images = [_save_pixels(image, Path(folder) / f"image_{number}.npy")
              for number, image in enumerate(bpy.data.images) if _is_only_in_memory(image)]
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, relative_remap=True, check_existing=False)
    return {
        "blend": str(path),
        "scene": bpy.context.scene.name,
        "view_layer": bpy.context.view_layer.name,
        "use_scripts": bpy.context.preferences.filepaths.use_scripts_auto_execute,
        "images": images,
    }


def load(saved):
    """Opens what `save` saved, in another Blender. Raises RuntimeError if it cannot be opened."""
    bpy.ops.wm.open_mainfile(filepath=saved["blend"], load_ui=False, use_scripts=saved["use_scripts"])
    scene = bpy.data.scenes[saved["scene"]]
    window = bpy.context.window_manager.windows[0]
    window.scene = scene
    window.view_layer = scene.view_layers[saved["view_layer"]]
    for image in saved["images"]:
        _load_pixels(image)


def _is_only_in_memory(image):
    """Painted or made by a script since it was last saved: a .blend file does not hold such pixels."""
    return image.is_dirty and image.has_data and image.source in ("GENERATED", "FILE") and image.library is None


def _save_pixels(image, path):
    pixels = np.empty(image.size[0] * image.size[1] * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    np.save(path, pixels)
    return {"name": image.name, "size": list(image.size), "is_float": image.is_float, "pixels": str(path)}


def _load_pixels(saved):
    image = bpy.data.images[saved["name"]]
    image.source = "GENERATED"
    image.generated_width, image.generated_height = saved["size"]
    image.use_generated_float = saved["is_float"]
    pixels = np.load(saved["pixels"])
    if len(image.pixels) == pixels.size:
        image.pixels.foreach_set(pixels)
    else:  # a picture without alpha has become one with it
        opaque = np.ones((pixels.size // 3, 4), np.float32)
        opaque[:, :3] = pixels.reshape(-1, 3)
        image.pixels.foreach_set(opaque.ravel())
    image.update()
