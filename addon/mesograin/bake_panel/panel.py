# The Bake panel, among the render properties.
import bpy

from .. import compat, panels
from ..comparison.progress import duration
from . import operators, session


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
    bake = session.bake
    if session.running():
        left = bake.seconds_left
        text = f"about {duration(left)} left" if left is not None else "the first sample"
        column = layout.column(align=True)
        compat.draw_progress(column, context.window_manager, "mesograin_bake_progress", text)
        layout.operator(operators.MESOGRAIN_OT_cancel_bake.bl_idname, icon="CANCEL")
    else:
        row = layout.row()
        row.scale_y = 1.4
        active = context.view_layer.objects.active
        label = f"Bake {active.name} to EXR" if active is not None else operators.MESOGRAIN_OT_bake.bl_label
        row.operator(operators.MESOGRAIN_OT_bake.bl_idname, text=label, icon="RENDER_STILL")
    if session.error:
        panels.draw_sentence(layout, context, session.error)
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
        layout = self.layout
        if not panels.draw_native_problem(layout, context):
            column = layout.column()
            column.enabled = not session.running()
            draw_settings(column, context)
        draw_bake(layout, context)


register, unregister = bpy.utils.register_classes_factory((MESOGRAIN_PT_bake,))
