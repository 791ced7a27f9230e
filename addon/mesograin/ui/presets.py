# The menu of materials that an artist starts from.
import bpy
from bl_operators.presets import AddPresetBase
from bpy.props import EnumProperty

from ..schema import models
from ..schema.parameters import PARAMETERS
from ..schema.presets import BY_IDENTIFIER, GROUPS
from .active_material import active_material, is_own


def _sentence(group, preset):
    note = f"{preset.note}. " if preset.note else ""
    return (f"{note}sigma_s' {_channels(preset.sigma_s_reduced)}, sigma_a {_channels(preset.sigma_a)} in 1/mm, "
            f"g {preset.g:g}, eta {preset.eta:g}; {group.source}")


def _channels(values):
    return ", ".join(f"{value:.3g}" for value in values)


ITEMS = tuple((preset.identifier, preset.name, _sentence(group, preset), number)
              for number, (group, preset) in enumerate((group, preset) for group in GROUPS for preset in group.presets))


class MESOGRAIN_OT_apply_preset(bpy.types.Operator):
    bl_idname = "mesograin.apply_preset"
    bl_label = "Apply Material"
    bl_description = "Set sigma_s, sigma_a, g, eta, roughness and boundary to those of a known material"
    bl_options = {"REGISTER", "UNDO"}

    preset: EnumProperty(name="Material", items=ITEMS)

    @classmethod
    def description(cls, _context, chosen):
        return next(sentence for identifier, _, sentence, _ in ITEMS if identifier == chosen.preset)

    @classmethod
    def poll(cls, context):
        material = active_material(context)
        return material is not None and is_own(cls, material)

    def execute(self, context):
        material = active_material(context)
        apply(BY_IDENTIFIER[self.preset], material.mesograin)
        return {"FINISHED"}


def apply(preset, grain):
    """Sets the material properties `grain` to a preset, in air, and makes it translucent if it was not."""
    grain.sigma_s = preset.sigma_s
    grain.sigma_a = preset.sigma_a
    grain.g = preset.g
    grain.eta = preset.eta
    grain.roughness = preset.roughness
    grain.boundary = preset.boundary
    grain.scale = 1.0
    if grain.model in models.OPAQUE:
        grain.model = models.AUTO.name
    look = getattr(grain.id_data, "mesograin_look", None)
    if look is not None:
        look.forget_surroundings()


class MESOGRAIN_OT_add_preset(AddPresetBase, bpy.types.Operator):
    bl_idname = "mesograin.add_preset"
    bl_label = "Save Own Material"
    bl_description = "Keep this grain among your own materials, for every file"
    preset_menu = "MESOGRAIN_MT_own_presets"
    preset_subdir = "mesograin/materials"
    preset_defines = []  # which Blender 4.3 no longer finds in the next line where its Python is 3.13 (PEP 667)
    # What is around goes first: it changes eta, which then becomes what it was.
    preset_values = [f"(getattr(bpy.context, 'material', None) or bpy.context.object.active_material).{path}"
                     for path in ("mesograin_look.surroundings", *(f"mesograin.{name}" for name in PARAMETERS))]


class MESOGRAIN_MT_own_presets(bpy.types.Menu):
    bl_label = "Own Materials"
    preset_subdir = "mesograin/materials"
    preset_operator = "script.execute_preset"
    draw = bpy.types.Menu.draw_preset


class MESOGRAIN_MT_presets(bpy.types.Menu):
    bl_idname = "MESOGRAIN_MT_presets"
    bl_label = "Materials"

    def draw(self, _context):
        column = self.layout.column()
        _draw_group(column, GROUPS[0])
        column.separator()
        for menu in MEASURED:
            column.menu(menu.__name__)
        column.separator()
        column.menu(MESOGRAIN_MT_own_presets.__name__)
        column.operator(MESOGRAIN_OT_add_preset.bl_idname)


def _draw_group(layout, group):
    layout.label(text=group.title)
    for preset in group.presets:
        layout.operator(MESOGRAIN_OT_apply_preset.bl_idname, text=preset.name).preset = preset.identifier


def _menu_of(number, group):
    """A menu of its own: with all of them in one, an artist's own materials were below the end of a small screen."""
    return type(f"MESOGRAIN_MT_presets_{number}", (bpy.types.Menu,), {
        "bl_label": group.title, "draw": lambda menu, _context: _draw_group(menu.layout, group)})


MEASURED = tuple(_menu_of(number, group) for number, group in enumerate(GROUPS[1:], 1))

register, unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_apply_preset, MESOGRAIN_OT_add_preset, MESOGRAIN_MT_own_presets, *MEASURED, MESOGRAIN_MT_presets))
