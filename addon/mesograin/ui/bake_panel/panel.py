# The Bake panel, among the render properties.
import bpy

from ...cycles import reference_cache
from .. import panels
from ..side_task import panel as side_task
from ..side_task import results
from ..widths import arrange, choose
from . import operators
from .session import session


def draw_settings(layout, context):
    asked = context.scene.mesograin_bake
    arrange(layout, context)
    layout.use_property_decorate = False
    column = layout.column(align=True)
    column.prop(asked, "width", text="Texels X")
    column.prop(asked, "height", text="Y")
    layout.prop(asked, "relightable")
    if asked.relightable:
        layout.prop(asked, "components")
        layout.prop(asked, "direction_samples", text="Samples")
    else:
        layout.prop(asked, "samples")
        choose(layout, asked, "view_from", "View from")
    layout.prop(asked, "margin")
    layout.prop(asked, "half")
    layout.prop(asked, "out")
    if asked.relightable:
        return
    layout.column(heading="Cycles").prop(asked, "compare", text="Compare")
    if asked.compare:
        column = layout.column(align=True)
        choose(column, asked, "reference", "Reference")
        column.prop(asked, "reference_samples", text="Samples")
        reference_cache.draw(layout)


def draw_bake(layout, context):
    """The button, or how far the bake is; then what came of the last one."""
    bake = session.task
    active = context.view_layer.objects.active
    asked = context.scene.mesograin_bake
    compare = asked.compare and not asked.relightable
    what = f"{active.name} to EXR" if active is not None else "to EXR"
    label = f"Bake {what} and with Cycles" if compare else f"Bake {what}"
    side_task.draw_task(layout, context, session, operators.MESOGRAIN_OT_bake, operators.MESOGRAIN_OT_cancel_bake,
                        bake.before_first_step if bake else "", bake.detail if bake else "",
                        text=label, icon="RENDER_STILL")
    if bake is None:
        return
    if bake.error:
        panels.draw_sentence(layout, context, bake.error)
    elif bake.cancelled:
        layout.label(text="Cancelled; nothing was written.", icon="INFO")
    elif bake.finished and not bake.running:
        panels.draw_sentence(layout, context, bake.summary, icon="CHECKMARK")
    for sentence in bake.sentences:
        panels.draw_sentence(layout, context, sentence)
    if bake.results is not None:
        ours = "Mesograin", results.seconds(bake.results["our_seconds"])
        results.draw(layout.box(), context, bake.entry, ours, operators.MESOGRAIN_OT_show_bake)


class MESOGRAIN_PT_bake(panels.MesograinPanel, bpy.types.Panel):
    bl_label = "Bake to EXR"
    bl_context = "render"

    def draw(self, context):
        side_task.draw_settings(self.layout, context, session, draw_settings)
        draw_bake(self.layout, context)


register, unregister = bpy.utils.register_classes_factory((MESOGRAIN_PT_bake,))
