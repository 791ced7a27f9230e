# Object > Grain, and Mesograin's part of the Render menu: what panels offer, for keys and for Blender's menu search.
import bpy

from . import panels
from .bake_panel.operators import MESOGRAIN_OT_bake
from .compare_panel.operators import MESOGRAIN_OT_compare
from .conversion import MESOGRAIN_OT_from_cycles, MESOGRAIN_OT_to_cycles
from .copy_grain import MESOGRAIN_OT_copy_grain, MESOGRAIN_OT_paste_grain
from .grain_colours import MESOGRAIN_OT_add_attribute_reader
from .look import MESOGRAIN_OT_choose_model
from .notes import MESOGRAIN_OT_add_sun, MESOGRAIN_OT_make_grain


class MESOGRAIN_MT_grain(bpy.types.Menu):
    bl_idname = "MESOGRAIN_MT_grain"
    bl_label = "Grain"

    def draw(self, _context):
        layout = self.layout
        layout.operator_menu_enum(MESOGRAIN_OT_make_grain.bl_idname, "preset", icon="MATERIAL")
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


def _draw_in_object(menu, context):
    if context.engine in panels.ENGINES:
        menu.layout.separator()
        menu.layout.menu(MESOGRAIN_MT_grain.bl_idname, icon="META_BALL")


def _draw_in_render(menu, context):
    if context.engine in panels.ENGINES:
        menu.layout.separator()
        menu.layout.operator(MESOGRAIN_OT_compare.bl_idname, icon="RENDER_STILL")
        menu.layout.operator(MESOGRAIN_OT_bake.bl_idname, icon="RENDER_STILL")


def register():
    bpy.utils.register_class(MESOGRAIN_MT_grain)
    bpy.types.VIEW3D_MT_object.append(_draw_in_object)
    bpy.types.TOPBAR_MT_render.append(_draw_in_render)


def unregister():
    bpy.types.TOPBAR_MT_render.remove(_draw_in_render)
    bpy.types.VIEW3D_MT_object.remove(_draw_in_object)
    bpy.utils.unregister_class(MESOGRAIN_MT_grain)
