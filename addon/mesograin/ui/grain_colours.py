# Material > Grain > Vary Grains: colours of the grains of a heap, and what makes attributes of instances known.
import bpy

from .. import native_module
from ..scene import instance_attributes
from ..schema import models
from .panels import MesograinPanel
from .widths import arrange, choose


class MESOGRAIN_OT_add_attribute_reader(bpy.types.Operator):
    bl_idname = "mesograin.add_attribute_reader"
    bl_label = "Add Attribute Reader"
    bl_description = ("Let materials know the attributes that geometry nodes gave instances: adds, for each object "
                      "that makes such, one that no render shows")
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        depsgraph = context.evaluated_depsgraph_get()
        instancers = {each.parent.original: None for each in depsgraph.object_instances if each.is_instance}
        instancers = [each for each in instancers if any(modifier.type == "NODES" for modifier in each.modifiers)]
        known = {instance_attributes.instancer_of(thing) for thing in context.view_layer.objects}
        lacking = [each for each in instancers if each not in known]
        if not lacking:
            self.report({"INFO"}, "All instances' attributes are known." if instancers else
                        "No geometry nodes of this scene make instances.")
            return {"CANCELLED"}
        for each in lacking:
            context.scene.collection.objects.link(instance_attributes.add_reader(each))
        return {"FINISHED"}


class MESOGRAIN_PT_colours(MesograinPanel, bpy.types.Panel):
    bl_label = "Vary Grains"
    bl_context = about = "material"
    bl_parent_id = "MESOGRAIN_PT_material"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return native_module.problem() is None and super().poll(context)

    def draw_header(self, context):
        self.layout.prop(context.material.mesograin_colours, "vary", text="")

    def draw(self, context):
        layout, settings = self.layout, context.material.mesograin_colours
        arrange(layout, context)
        layout.active = settings.vary
        takes = models.CHOICES[context.material.mesograin.model].parameters
        colour = "Absorption" if "sigma_a" in takes else "Reflectance"
        choose(layout, settings, "source", "Source")
        if settings.source != "RANGE":
            if settings.source == "ATTRIBUTE":
                layout.prop(settings, "colour_attribute", text=colour)
                if "sigma_s" in takes:
                    layout.prop(settings, "scattering_attribute")
            layout.operator(MESOGRAIN_OT_add_attribute_reader.bl_idname, icon="POINTCLOUD_DATA")
            return
        column = layout.column(align=True)
        column.prop(settings, "colour_from", text=colour)
        column.prop(settings, "colour_to", text="To")
        if "sigma_s" in takes:
            column = layout.column(align=True)
            column.prop(settings, "scattering_from", text="Scattering")
            column.prop(settings, "scattering_to", text="To")


register, unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_add_attribute_reader, MESOGRAIN_PT_colours))
