# What a Rendered viewport leaves out or lacks, at its header, each with a button that mends it.
import math

import bpy

from ..engine import status
from ..scene import plain_materials, surroundings
from . import panels, presets
from .active_material import is_own

SUN_ANGLE = math.radians(0.53)  # as seen from the Earth
SUN_STRENGTH = 3.0


def is_lit(scene):
    """Whether a light or the world shines on anything of a scene."""
    lights = any(thing.type == "LIGHT" and not thing.hide_render for thing in scene.objects)
    return lights or surroundings.read(scene)[0].shines


def lacks_grain(thing):
    """Whether an object could be a grain and is none yet."""
    if thing is None or thing.type != "MESH":
        return False
    return thing.active_material is None or plain_materials.is_plain(thing.active_material)


class MESOGRAIN_OT_add_sun(bpy.types.Operator):
    bl_idname = "mesograin.add_sun"
    bl_label = "Add a Sun"
    bl_description = "Light the scene with a sun from the upper left, as wide as the real one"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        light = bpy.data.lights.new("Sun", "SUN")
        light.energy, light.angle = SUN_STRENGTH, SUN_ANGLE
        sun = bpy.data.objects.new("Sun", light)
        sun.rotation_euler = (math.radians(40.0), math.radians(-30.0), 0.0)
        context.scene.collection.objects.link(sun)
        return {"FINISHED"}


class MESOGRAIN_OT_make_grain(bpy.types.Operator):
    bl_idname = "mesograin.make_grain"
    bl_label = "Make It a Grain"
    bl_description = "Give the active object a material of this name, or turn the one that it has into it"
    bl_options = {"REGISTER", "UNDO"}

    preset: bpy.props.EnumProperty(name="Material", items=presets.ITEMS, default="sugar")

    @classmethod
    def poll(cls, context):
        thing = context.object
        return thing is not None and thing.type == "MESH" and is_own(cls, thing.active_material or thing)

    def execute(self, context):
        thing = context.object
        if thing.active_material is None:
            thing.active_material = bpy.data.materials.new(presets.BY_IDENTIFIER[self.preset].name)
        presets.apply(presets.BY_IDENTIFIER[self.preset], thing.active_material.mesograin)
        return {"FINISHED"}


class MESOGRAIN_PT_notes(bpy.types.Panel):
    bl_space_type = "VIEW_3D"
    bl_region_type = "HEADER"
    bl_label = "Mesograin"
    bl_ui_units_x = 20

    def draw(self, context):
        layout, thing = self.layout, context.object
        if panels.draw_native_problem(layout, context):
            return
        panels.draw_complaints(layout, context, icon="INFO", units=self.bl_ui_units_x)
        if not is_lit(context.scene):
            layout.operator(MESOGRAIN_OT_add_sun.bl_idname, icon="LIGHT_SUN")
        if lacks_grain(thing):
            layout.operator_menu_enum(MESOGRAIN_OT_make_grain.bl_idname, "preset",
                                      text=f"Make '{thing.name}' a Grain", icon="MATERIAL")
        if not status.complaints() and is_lit(context.scene) and not lacks_grain(thing):
            panels.draw_sentence(layout, context, "Nothing is left out.", icon="CHECKMARK",
                                 units=self.bl_ui_units_x)


def draw_header(header, context):
    """Of a 3D viewport: how much there is to know, in Rendered shading by Mesograin alone."""
    if context.engine not in panels.ENGINES or context.space_data.shading.type != "RENDERED":
        return
    lacking = not is_lit(context.scene)
    count = len(status.complaints())
    header.layout.popover(MESOGRAIN_PT_notes.__name__, text=str(count) if count else "",
                          icon="ERROR" if lacking or count else "INFO")


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_add_sun, MESOGRAIN_OT_make_grain, MESOGRAIN_PT_notes))


def register():
    _register_classes()
    bpy.types.VIEW3D_HT_header.append(draw_header)


def unregister():
    bpy.types.VIEW3D_HT_header.remove(draw_header)
    _unregister_classes()
