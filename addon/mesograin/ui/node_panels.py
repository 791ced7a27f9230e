# What nodes say of a world, and of a material that is no grain yet: where other engines have it.
import bpy

from .. import compat
from ..scene import plain_materials
from .panels import MesograinPanel


def draw_surface(layout, datablock, without_nodes):
    """The tree behind the surface of a world's or material's output, or the property that stands for it."""
    if compat.has_choice_of_nodes(datablock):
        layout.prop(datablock, "use_nodes", icon="NODETREE")  # split, a button with an icon would lose its name
        layout.separator()
    layout.use_property_split = True
    if not compat.uses_nodes(datablock):
        layout.prop(datablock, without_nodes)
        return
    output = datablock.node_tree.get_output_node("CYCLES")
    if output is None:
        layout.label(text="No output node")
    else:
        layout.template_node_view(datablock.node_tree, output, output.inputs["Surface"])


class MESOGRAIN_PT_world(MesograinPanel, bpy.types.Panel):
    bl_label = "Surface"
    bl_context = about = "world"

    def draw(self, context):
        draw_surface(self.layout, context.world, "color")


class MESOGRAIN_PT_plain_material(MesograinPanel, bpy.types.Panel):
    bl_label = "Surface"
    bl_context = about = "material"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and plain_materials.is_plain(context.material)

    def draw(self, context):
        draw_surface(self.layout, context.material, "diffuse_color")


register, unregister = bpy.utils.register_classes_factory((MESOGRAIN_PT_world, MESOGRAIN_PT_plain_material))
