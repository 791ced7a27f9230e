# The cache of references as Blender shows it: its size, its limit in the preferences, a button that empties it.
import time

import bpy

from .. import __name__ as ADDON
from .cache import Cache

# Looking at every file takes too long for every redraw.
LOOK_SECONDS = 5.0

_seen = {"at": -LOOK_SECONDS, "bytes": 0}


def preferences():
    """The add-on's preferences; None where it runs without being enabled, as in a background Blender."""
    addon = bpy.context.preferences.addons.get(ADDON)
    return addon and addon.preferences


def cache():
    """The cache that the preferences choose. Raises ValueError with a sentence, as `Cache`."""
    chosen = preferences()
    if chosen is None:
        return Cache()
    folder = bpy.path.abspath(chosen.cache_folder) or None
    return Cache(folder, chosen.cache_limit * 1024**2 if chosen.is_property_set("cache_limit") else None)


def look_again():
    """Has the next drawing count the files anew."""
    _seen["at"] = -LOOK_SECONDS


def draw(layout):
    """One row: what the references take, and the button."""
    try:
        chosen = cache()
    except ValueError as error:
        layout.label(text=str(error), icon="ERROR")
        return
    if time.monotonic() - _seen["at"] > LOOK_SECONDS:
        _seen.update(at=time.monotonic(), bytes=chosen.size())
    row = layout.row(align=True)
    row.label(text=f"{_readable(_seen['bytes'])} of {_readable(chosen.limit)}", icon="DISK_DRIVE")
    row.operator(MESOGRAIN_OT_clear_references.bl_idname, text="", icon="TRASH")


def _readable(size):
    """Bytes as '12.3 MiB'."""
    for unit in ("KiB", "MiB"):
        size /= 1024.0
        if size < 1024.0:
            return f"{size:.1f} {unit}"
    return f"{size / 1024.0:.1f} GiB"


class MESOGRAIN_OT_clear_references(bpy.types.Operator):
    bl_idname = "mesograin.clear_references"
    bl_label = "Clear References"
    bl_description = "Remove all rendered references; the next comparison renders its own again"

    def invoke(self, context, event):
        return context.window_manager.invoke_confirm(self, event)

    def execute(self, _context):
        try:
            count, size = cache().clear()
        except (ValueError, OSError) as error:
            self.report({"ERROR"}, f"The reference cache cannot be emptied: {error}")
            return {"CANCELLED"}
        look_again()
        self.report({"INFO"}, f"{count} references removed, {_readable(size)}.")
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((MESOGRAIN_OT_clear_references,))
