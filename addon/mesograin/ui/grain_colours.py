# Material > Grain > Vary Grains: colours of the grains of a heap.
import bpy

from .. import native_module
from ..schema import models
from .panels import MesograinPanel


class MESOGRAIN_PT_colours(MesograinPanel, bpy.types.Panel):
    bl_label = "Vary Grains"
    bl_context = "material"
    bl_parent_id = "MESOGRAIN_PT_material"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return context.material is not None and native_module.problem() is None and super().poll(context)

    def draw_header(self, context):
        self.layout.prop(context.material.mesograin_colours, "vary", text="")

    def draw(self, context):
        layout, settings = self.layout, context.material.mesograin_colours
        layout.use_property_split = True
        layout.active = settings.vary
        takes = models.CHOICES[context.material.mesograin.model].parameters
        colour = "Absorption" if "sigma_a" in takes else "Reflectance"
        layout.prop(settings, "source")
        if settings.source == "NODES":
            return
        column = layout.column(align=True)
        column.prop(settings, "colour_from", text=f"{colour} From")
        column.prop(settings, "colour_to", text="To")
        if "sigma_s" in takes:
            column = layout.column(align=True)
            column.prop(settings, "scattering_from", text="Scattering From")
            column.prop(settings, "scattering_to", text="To")


register, unregister = bpy.utils.register_classes_factory((MESOGRAIN_PT_colours,))
