# The Bake panel, among the render properties.
import bpy

from .. import panels
from ..comparison.progress import duration
from ..side_task import panel as side_task
from . import operators
from .session import session


def draw_settings(layout, context):
    asked = context.scene.mesograin_bake
    layout.use_property_split = True
    layout.use_property_decorate = False
    column = layout.column(align=True)
    column.prop(asked, "width", text="Texels X")
    column.prop(asked, "height", text="Y")
    layout.prop(asked, "samples")
    layout.prop(asked, "view_from")
    layout.prop(asked, "margin")
    layout.prop(asked, "half")
    layout.prop(asked, "out")


def draw_bake(layout, context):
    """The button, or how far the bake is; then what came of the last one."""
    bake = session.task
    active = context.view_layer.objects.active
    label = f"Bake {active.name} to EXR" if active is not None else operators.MESOGRAIN_OT_bake.bl_label
    side_task.draw_task(layout, context, session, operators.MESOGRAIN_OT_bake, operators.MESOGRAIN_OT_cancel_bake,
                        "the first sample", text=label, icon="RENDER_STILL")
    if bake is None:
        return
    if bake.error:
        panels.draw_sentence(layout, context, bake.error)
    elif bake.finished and not bake.running:
        width, height = bake.surface.size
        panels.draw_sentence(layout, context, f"{bake.path.name}: {bake.surface.name}, {width} x {height} texels in "
                             f"{duration(bake.seconds)}", icon="CHECKMARK")
    elif not bake.running:
        layout.label(text="Cancelled; nothing was written.", icon="INFO")
    for sentence in bake.surface.warnings:
        panels.draw_sentence(layout, context, sentence)


class MESOGRAIN_PT_bake(panels.MesograinPanel, bpy.types.Panel):
    bl_label = "Bake to EXR"
    bl_context = "render"

    def draw(self, context):
        side_task.draw_settings(self.layout, context, session, draw_settings)
        draw_bake(self.layout, context)


register, unregister = bpy.utils.register_classes_factory((MESOGRAIN_PT_bake,))
