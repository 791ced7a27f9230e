# Object > Grain, and Mesograin's part of the Render and Help menus: what panels offer, for keys and for Blender's menu
# search.
import bpy

from ..engine import status
from . import named_things, panels
from .bake_panel.operators import MESOGRAIN_OT_bake, MESOGRAIN_OT_cancel_bake
from .compare_panel.operators import MESOGRAIN_OT_cancel_compare, MESOGRAIN_OT_compare, MESOGRAIN_OT_open_report
from .conversion import MESOGRAIN_OT_from_cycles, MESOGRAIN_OT_to_cycles
from .copy_grain import MESOGRAIN_OT_copy_grain, MESOGRAIN_OT_paste_grain
from .grain_colours import MESOGRAIN_OT_add_attribute_reader
from .look import MESOGRAIN_OT_choose_model
from .match_panel.operators import MESOGRAIN_OT_apply_match, MESOGRAIN_OT_cancel_match, MESOGRAIN_OT_match
from .notes import MESOGRAIN_OT_add_sun, MESOGRAIN_OT_make_grain
from .preferences import MESOGRAIN_OT_copy_diagnostics, MESOGRAIN_OT_self_test
from .presets import MESOGRAIN_MT_presets


class MESOGRAIN_MT_left_out(bpy.types.Menu):
    bl_idname = "MESOGRAIN_MT_left_out"
    bl_label = "Select What Is Left Out"

    def draw(self, context):
        named = [thing.name for sentence in status.complaints() for thing in named_things.find(sentence, context)]
        if not named:
            self.layout.label(text="Nothing is left out.")
        for name in dict.fromkeys(named):
            named_things.draw_button(self.layout, name)


class MESOGRAIN_MT_grain(bpy.types.Menu):
    bl_idname = "MESOGRAIN_MT_grain"
    bl_label = "Grain"

    def draw(self, _context):
        layout = self.layout
        layout.operator_menu_enum(MESOGRAIN_OT_make_grain.bl_idname, "preset", icon="MATERIAL")
        layout.menu(MESOGRAIN_MT_presets.bl_idname, icon="PRESET")
        layout.operator(MESOGRAIN_OT_choose_model.bl_idname)
        layout.separator()
        layout.operator(MESOGRAIN_OT_from_cycles.bl_idname, icon="NODE_MATERIAL")
        layout.operator(MESOGRAIN_OT_to_cycles.bl_idname)
        layout.separator()
        layout.operator(MESOGRAIN_OT_copy_grain.bl_idname, icon="COPYDOWN")
        layout.operator(MESOGRAIN_OT_paste_grain.bl_idname, icon="PASTEDOWN")
        layout.separator()
        layout.operator(MESOGRAIN_OT_add_attribute_reader.bl_idname, icon="POINTCLOUD_DATA")
        layout.operator(MESOGRAIN_OT_add_sun.bl_idname, icon="LIGHT_SUN")
        layout.separator()
        layout.menu(MESOGRAIN_MT_left_out.bl_idname, icon="INFO")


class MESOGRAIN_MT_help(bpy.types.Menu):
    bl_idname = "MESOGRAIN_MT_help"
    bl_label = "Mesograin"

    def draw(self, _context):
        self.layout.operator(MESOGRAIN_OT_self_test.bl_idname)
        self.layout.operator(MESOGRAIN_OT_copy_diagnostics.bl_idname, icon="COPYDOWN")


def _draw_in_object(menu, context):
    if context.engine in panels.ENGINES:
        menu.layout.separator()
        menu.layout.menu(MESOGRAIN_MT_grain.bl_idname, icon="META_BALL")


def _draw_in_render(menu, context):
    if context.engine not in panels.ENGINES:
        return
    layout = menu.layout
    layout.separator()
    for start, cancel, icon in ((MESOGRAIN_OT_compare, MESOGRAIN_OT_cancel_compare, "RENDER_STILL"),
                                (MESOGRAIN_OT_bake, MESOGRAIN_OT_cancel_bake, "RENDER_STILL"),
                                (MESOGRAIN_OT_match, MESOGRAIN_OT_cancel_match, "EYEDROPPER")):
        if start.session.running:
            layout.operator(cancel.bl_idname, icon="CANCEL")
        else:
            layout.operator(start.bl_idname, icon=icon)
    if MESOGRAIN_OT_open_report.poll(context):
        layout.operator(MESOGRAIN_OT_open_report.bl_idname, icon="URL")
    if MESOGRAIN_OT_apply_match.poll(context):
        layout.operator(MESOGRAIN_OT_apply_match.bl_idname)


def _draw_in_help(menu, _context):
    menu.layout.separator()
    menu.layout.menu(MESOGRAIN_MT_help.bl_idname)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (MESOGRAIN_MT_left_out, MESOGRAIN_MT_grain, MESOGRAIN_MT_help))


def register():
    _register_classes()
    bpy.types.VIEW3D_MT_object.append(_draw_in_object)
    bpy.types.TOPBAR_MT_render.append(_draw_in_render)
    bpy.types.TOPBAR_MT_help.append(_draw_in_help)


def unregister():
    bpy.types.TOPBAR_MT_help.remove(_draw_in_help)
    bpy.types.TOPBAR_MT_render.remove(_draw_in_render)
    bpy.types.VIEW3D_MT_object.remove(_draw_in_object)
    _unregister_classes()
