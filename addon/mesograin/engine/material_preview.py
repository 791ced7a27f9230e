# The picture of a material in its slot, its tab and the asset browser: our grain on the stage that Blender sets for it.
import contextlib
import dataclasses
import math
import time

import bpy
from bpy.props import EnumProperty

from .. import compat, native_module
from ..scene import automatic, export, meshes, plain_materials
from ..scene.properties import OVERRIDABLE
from . import own_grain, status, writing

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
OWN = "grain"
"""Of a material's preview: in the shape of the artist's own."""
FLOOR, HIDDEN_FLOOR = "Floor", "FloorHidden"
"""Materials of Blender's stage; the other one of the two is there for shadows alone."""
RADIUS = 0.15
"""Of the ball that holds it, which is Blender's on its stage."""
OWN_NUMBER = 1 << 20
"""Of its parts as one object: no object of the stage has it."""

_sizes = {}  # {name of a material: mm}
_icons = {}  # {(name of a material, width, height): its last picture}
_owed = set()  # names of materials whose icons are as they were
_changed = 0.0  # when something changed, or a viewport waited for what it is to show, as time.monotonic() has it


def note_size(material, millimetres):
    """Notes how large a grain of the material is, that has this name."""
    _sizes[material] = millimetres


def note_grains(values):
    """Notes of what shape and how large a grain of each material of an export.SceneValues is."""
    for name in own_grain.keep_all(values):
        _owe_own(name)
    grains = {drawn.material.name: drawn for drawn in (*values.instances, *values.heaps)
              if drawn.material.finish is None}
    for name, drawn in grains.items():
        volume = automatic.shape(drawn.mesh, drawn.typical())[0]
        if volume > 0.0:
            note_size(name, values.millimetres_per_unit * math.cbrt(6.0 / math.pi * volume))


_last_read = None  # (key, native.Meshes) of the object that was noted last: panels are drawn often


def note_object(material, thing, depsgraph):
    """Notes that a bpy.types.Material is worn by an object, as it is evaluated. What is wrong with one is said where it
    is to be drawn."""
    global _last_read
    if native_module.problem():
        return
    evaluated = thing.evaluated_get(depsgraph)
    if not meshes.is_shape(evaluated) or not meshes.has_extent(thing.matrix_world):
        return
    key = (thing.name_full, evaluated.data.as_pointer(), material.name)
    if _last_read is None or _last_read[0] != key:
        slots, parts = [slot.material for slot in thing.material_slots], ()
        with contextlib.suppress(native_module.get().Error):
            parts = meshes.MeshCache().parts(evaluated)
        worn = slots and any(slots[min(part.slot, len(slots) - 1)] == material for part in parts)
        _last_read = key, own_grain.of_parts(parts) if worn else []
    to_world = tuple(number for row in thing.matrix_world for number in row)
    per_unit = depsgraph.scene.mesograin.millimetres_per_unit
    if _last_read[1] and own_grain.keep(material.name, _last_read[1], to_world, per_unit):
        _owe_own(material.name)


def shows_own():
    """Whether a material's tab shows, or has shown, an object that may be changed: it is looked at again once it is
    calm."""
    return _last_read is not None


def _owe_own(name):
    """The grain of the material of this name is another: its picture is drawn anew once it is calm, if it shows it."""
    material = bpy.data.materials.get(name)
    if material is not None and material.mesograin_preview == OWN:
        _owed.add(name)
        note_change()


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
        if material is not None and material.mesograin_preview == OWN:
            compat.redraw_preview(material)
    status.redraw_panels()
    # One may have been about to begin.
    return CALM_SECONDS if time.monotonic() - _changed < 3.0 * CALM_SECONDS else None


def forget():
    """Another file's materials are others, whatever their names."""
    global _last_read
    _last_read = None
    for known in (_sizes, _icons, _owed):
        known.clear()


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
    return next((material.name for material in _worn(depsgraph)), "")


def staged(values, depsgraph):
    """export.SceneValues of Blender's stage as it is drawn: the grain as thick for light as those of its material are,
    by a model that is there at once, in the shape of the artist's own where that is asked for or the stage has none,
    and without the floor where that is there for shadows alone."""
    shown = [drawn for drawn in values.instances if not drawn.material.name.startswith(HIDDEN_FLOOR)]
    for material, things in _worn(depsgraph).items():
        worn = [drawn for drawn in shown if drawn.material.name == material.name_full]
        own = _own(material) if material.mesograin_preview == OWN or not worn else []
        longer = _sizes.get(material.name_full, SIZE) / max(max(thing.dimensions) for thing in things)
        if own:
            shown = [drawn for drawn in shown if drawn.material.name.startswith(FLOOR)] + own
        shown = [dataclasses.replace(drawn, material=_thicker(drawn.material, longer)) if drawn in worn else drawn
                 for drawn in shown]
    return dataclasses.replace(values, instances=tuple(shown), exchange="off")


def _own(material):
    """export.InstanceValues of the artist's own grain on the stage; none where it is not known."""
    grain = own_grain.of(material.name_full)
    placed = grain and own_grain.standing(grain, RADIUS)
    if not placed:
        return []
    to_world, longer = placed
    thicker = _thicker(export.material_values(material, 1.0), longer)
    return [export.InstanceValues(material.name_full, mesh, thicker, to_world, object=OWN_NUMBER)
            for mesh in grain.meshes]


def _worn(depsgraph):
    """{bpy.types.Material: the objects that wear it} of grains."""
    worn = {}
    for thing in depsgraph.objects:
        material = thing.type != "LIGHT" and thing.active_material
        if material and not plain_materials.is_plain(material):
            worn.setdefault(material, []).append(thing)
    return worn


def _thicker(material, factor):
    """An export.MaterialValues whose light goes so many times less far, for a model that is there at once. Blender's
    stage has a unit of 1 mm."""
    said = dict(material.values)
    for name in ("sigma_s", "sigma_a"):
        said[name] = tuple(channel * factor for channel in said[name])
    if automatic.asked(material) or said["model"] == COMPUTED:
        said["model"] = STAND_IN
    return dataclasses.replace(material, values=tuple(said.items()))


# The choice

def _redraw(material, _context):
    compat.redraw_preview(material)


CHOICE = EnumProperty(
    name="Preview On", default="stage", override=OVERRIDABLE, update=_redraw,
    description="What the preview and the icons of the material show", items=(
        ("stage", "Blender's Shape", "The shape that is chosen beside the preview, as thick as the grain", 0),
        (OWN, "Own Grain", "The object that wears the material: the active one, or one that a viewport has drawn", 1)))


def register():
    bpy.types.Material.mesograin_preview = CHOICE


def unregister():
    forget()
    if bpy.app.timers.is_registered(_pay):
        bpy.app.timers.unregister(_pay)
    del bpy.types.Material.mesograin_preview
