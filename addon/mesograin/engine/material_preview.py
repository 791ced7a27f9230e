# The picture of a material in its slot, its tab and the asset browser: our grain on the stage that Blender sets for it.
import dataclasses
import math
import time

import bpy

from ..scene import automatic, plain_materials
from . import writing

SIZE = 1.0
"""mm, of the grain on the stage where nobody has said how large those of its material are."""
CALM_SECONDS = 1.0
"""So long nothing must have changed before a picture is drawn: an artist who drags waits for the viewport."""
LOOK_SECONDS = 0.01
"""How often it is looked whether that is so: Blender's own thread waits for a preview that it ends."""
ROUNDS = (2, 14, 48)
"""Samples that come one after the other, each with a picture."""
ICON_SIDE, ICON_ROUNDS = 256, (16,)
"""Pixels of the largest icon; what is seen of it is small."""
MOST_ICONS = 64
STAND_IN = "model_3"
"""For a model that has to be computed for each shape and medium."""
COMPUTED = "transport"

_sizes = {}  # {name of a material: mm}
_icons = {}  # {(name of a material, width, height): its last picture}
_owed = set()  # names of materials whose icons are as they were
_changed = 0.0  # when something changed, or a viewport waited for what it is to show, as time.monotonic() has it


def note_size(material, millimetres):
    """Notes how large a grain of the material is, that has this name."""
    _sizes[material] = millimetres


def note_sizes(values):
    """Notes how large a grain of each material of an export.SceneValues is."""
    grains = {drawn.material.name: drawn for drawn in (*values.instances, *values.heaps)
              if drawn.material.finish is None}
    for name, drawn in grains.items():
        volume = automatic.shape(drawn.mesh, drawn.typical())[0]
        if volume > 0.0:
            note_size(name, values.millimetres_per_unit * math.cbrt(6.0 / math.pi * volume))


# While an artist drags

def note_change():
    """Something is to be shown that was not before. On the main thread."""
    global _changed
    _changed = time.monotonic()
    if not bpy.app.timers.is_registered(_pay):
        bpy.app.timers.register(_pay, first_interval=CALM_SECONDS, persistent=True)


def changed_since(then):
    return _changed > then


def is_calm():
    return time.monotonic() - _changed >= CALM_SECONDS


def wait_for_calm(cancelled):
    """Whether it is, which is waited for unless cancelled(), whether the picture is not wanted any more."""
    while not cancelled():
        if is_calm():
            return True
        time.sleep(LOOK_SECONDS)
    return False


def _pay():
    """The timer: once it is calm has icons drawn that were given as they had been, and Blender let Python write, which
    takes too long while an artist drags."""
    if not is_calm():
        return CALM_SECONDS
    writing.note_render()
    while _owed:
        material = bpy.data.materials.get(_owed.pop())
        if material is not None and material.preview is not None:
            material.preview.reload()  # no more than a mark: it is drawn when it is seen
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()
    # One may have been about to begin.
    return CALM_SECONDS if time.monotonic() - _changed < 3.0 * CALM_SECONDS else None


def forget():
    """Another file's materials are others, whatever their names."""
    for known in (_sizes, _icons, _owed):
        known.clear()


def stop():
    """The add-on ends."""
    forget()
    if bpy.app.timers.is_registered(_pay):
        bpy.app.timers.unregister(_pay)


def is_icon(width, height):
    return max(width, height) <= ICON_SIDE


def keep_icon(material, pixels):
    if len(_icons) >= MOST_ICONS:
        _icons.clear()
    _icons[material, pixels.shape[1], pixels.shape[0]] = pixels


def owe_icon(material, width, height):
    """The last picture of a material of this name, or None: it is drawn anew once it is calm."""
    _owed.add(material)
    return _icons.get((material, width, height))


# The stage

def rounds(width, height):
    return ICON_ROUNDS if is_icon(width, height) else ROUNDS


def grain_on(depsgraph):
    """The name of the grain's material that the stage shows; empty where it shows something else."""
    worn = (thing.active_material for thing in depsgraph.objects if thing.type != "LIGHT")
    return next((material.name for material in worn if material and not plain_materials.is_plain(material)), "")


def staged(values, depsgraph):
    """export.SceneValues of Blender's stage as it is drawn: the grain as thick for light as those of its material are,
    by a model that is there at once, and without the floor where that is there for shadows alone."""
    across = {thing.active_material.name: max(thing.dimensions) for thing in depsgraph.objects if thing.active_material}

    def change(material):
        if material.finish is not None:
            return material
        said = dict(material.values)
        longer = _sizes.get(material.name, SIZE) / across[material.name]  # Blender's stage has a unit of 1 mm
        for name in ("sigma_s", "sigma_a"):
            said[name] = tuple(channel * longer for channel in said[name])
        if automatic.asked(material) or said["model"] == COMPUTED:
            said["model"] = STAND_IN
        return dataclasses.replace(material, values=tuple(said.items()))

    shown = tuple(drawn for drawn in values.instances if not drawn.material.name.startswith("FloorHidden"))
    return dataclasses.replace(values, instances=shown, exchange="off").with_materials(change)
