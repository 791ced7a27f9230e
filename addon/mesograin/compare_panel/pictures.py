# The pictures of a comparison as images in Blender, brought up to date by the next comparison and never doubled.
"""Each is found again by what it shows, not by a pointer or name: undo removes datablocks, and artists rename them."""

from pathlib import Path

import bpy

from .. import compat

KEY = "mesograin_picture"

# Which file of a case is shown under which word. The EXR files are linear float, the false colours PNGs.
FILES = {"model": "model", "reference": "reference", "error": "error", "error colours": "error_png",
         "z-map": "z_map_png"}


def show(entry, picture, folder):
    """The image of one picture of a case of results.json, made or brought up to date. Raises RuntimeError if its file
    cannot be read."""
    path = folder / entry["files"][FILES[picture]]
    key = f"{entry['name']} {picture}"
    image = next((image for image in bpy.data.images if image.get(KEY) == key), None)
    if image is None:
        image = bpy.data.images.load(str(path))
        image.name = f"Mesograin {key}"
        image[KEY] = key
    image.filepath = _relative(path)
    image.reload()
    if path.suffix == ".exr":
        compat.set_linear(image)
    return image


def _relative(path):
    """Relative to the .blend file if it lies beside, so that both can move together."""
    home = Path(bpy.data.filepath).parent
    return bpy.path.relpath(str(path)) if bpy.data.filepath and path.is_relative_to(home) else str(path)


def pictures_of(entry):
    """The words for the pictures that a case has; with one seed of the reference there is no z-map."""
    return [picture for picture, file in FILES.items() if file in entry["files"]]


def show_all(results, folder):
    """Brings every picture of every case that succeeded up to date."""
    for entry in results["cases"]:
        if entry["status"] == "done":
            for picture in pictures_of(entry):
                show(entry, picture, folder)
