# The pictures of a result as images in Blender, brought up to date by the next one and never doubled.
"""Each is found again by what it shows, not by a pointer or name: undo removes datablocks, and artists rename them."""

from pathlib import Path

import bpy

from ... import compat

KEY = "mesograin_picture"

# Which file of a result is shown under which word. The EXR files are linear float, the false colours PNGs.
FILES = {"model": "model", "reference": "reference", "error": "error", "error colours": "error_png",
         "significance": "z_map_png"}
# What each is called on its button, and what it shows.
BUTTONS = {
    "model": ("Model", "Our picture, linear"),
    "reference": ("Cycles", "The reference: the mean of Cycles' seeds, linear"),
    "error": ("Error", "Our picture less the reference, linear; negative where ours is too dark"),
    "error colours": ("Colours", "The relative error in false colours"),
    "significance": ("Significance", "In colour where the two differ by more than their noise explains"),
}


def show(entry, picture, folder):
    """The image of one picture of a result, made or brought up to date. entry: its `name` and its `files` in `folder`,
    as a case of results.json has them. Raises RuntimeError if its file cannot be read."""
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
    """The words for the pictures that a result has; with one seed of the reference there is no test."""
    return [picture for picture, file in FILES.items() if file in entry["files"]]


def show_all(entry, folder):
    """Brings every picture of a result up to date. Raises as `show`."""
    for picture in pictures_of(entry):
        show(entry, picture, folder)
