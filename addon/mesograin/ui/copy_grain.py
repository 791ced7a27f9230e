# Copy Grain and Paste Grain, beside Blender's own for materials, which copy nodes and viewport settings alone.
import bpy

from .. import compat
from ..engine import engine
from ..scene import plain_materials
from .active_material import active_material, is_own

# The coefficients go last: set to the last digit, whatever colours, free paths and what is around made of them.
GROUPS = ("mesograin_look", "mesograin_colours", "mesograin")
PREVIEW = "mesograin_preview"
_kept = {}
"""What was copied: {group: {property: value}} of what was ever set, for as long as Blender runs."""


def _names(group):
    return [one.identifier for one in group.bl_rna.properties if not one.is_readonly and one.identifier != "name"]


def _plain(value):
    return tuple(value) if hasattr(value, "__len__") and not isinstance(value, str) else value


def copy(material):
    """Keeps all of a material that is Mesograin's, as plain values: files come and go."""
    _kept.clear()
    for name in GROUPS:
        group = getattr(material, name)
        _kept[name] = {each: _plain(getattr(group, each)) for each in _names(group) if group.is_property_set(each)}
    _kept[PREVIEW] = getattr(material, PREVIEW)


def paste(material):
    """Makes all of a material that is Mesograin's what was copied; what was not set there is not set here."""
    for name in GROUPS:
        group = getattr(material, name)
        for each in _names(group):
            if each in _kept[name]:
                setattr(group, each, _kept[name][each])
            else:
                group.property_unset(each)
    setattr(material, PREVIEW, _kept[PREVIEW])
    material.update_tag()  # of what was unset nobody is told
    compat.redraw_preview(material)


class MESOGRAIN_OT_copy_grain(bpy.types.Operator):
    bl_idname = "mesograin.copy_grain"
    bl_label = "Copy Grain"
    bl_description = "Keep this material's grain, with how it varies and is previewed, to be pasted on another material"

    @classmethod
    def poll(cls, context):
        material = active_material(context)
        if material is None:
            return False
        if plain_materials.is_plain(material):
            cls.poll_message_set(f"'{material.name}' is no grain yet")
            return False
        return True

    def execute(self, context):
        material = active_material(context)
        copy(material)
        self.report({"INFO"}, f"The grain of '{material.name}' is copied.")
        return {"FINISHED"}


class MESOGRAIN_OT_paste_grain(bpy.types.Operator):
    bl_idname = "mesograin.paste_grain"
    bl_label = "Paste Grain"
    bl_description = "Make this material the grain that was copied; its Cycles nodes stay"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        material = active_material(context)
        if material is None or not is_own(cls, material):
            return False
        if not _kept:
            cls.poll_message_set("No grain was copied yet")
        return bool(_kept)

    def execute(self, context):
        paste(active_material(context))
        return {"FINISHED"}


def _draw(menu, context):
    if context.engine != engine.MesograinRenderEngine.bl_idname:
        return
    menu.layout.separator()
    menu.layout.operator(MESOGRAIN_OT_copy_grain.bl_idname, icon="COPYDOWN")
    menu.layout.operator(MESOGRAIN_OT_paste_grain.bl_idname, icon="PASTEDOWN")


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_copy_grain, MESOGRAIN_OT_paste_grain))


def register():
    _register_classes()
    bpy.types.MATERIAL_MT_context_menu.append(_draw)


def unregister():
    bpy.types.MATERIAL_MT_context_menu.remove(_draw)
    _unregister_classes()
