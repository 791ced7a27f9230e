# The Compare panel, among the render properties and beside the pictures in the Image Editor.
import bpy

from ...cycles import reference_cache
from .. import panels
from ..side_task import panel as side_task
from ..side_task import results
from . import operators, properties
from .session import session


def draw_settings(layout, context):
    scene, settings = context.scene, context.scene.mesograin_compare
    column = layout.column(align=True)
    column.label(text="Models")
    column.prop(settings, "models")
    layout.row().prop(settings, "quality", expand=True)
    width, height = properties.size(scene)
    row = layout.row()
    row.prop(settings, "size_percent")
    row.label(text=f"{width} x {height} px")
    layout.prop(settings, "out", text="")
    if settings.out.startswith("//") and not bpy.data.filepath:
        panels.draw_sentence(layout, context, "The file is not saved: results last until Blender quits.", icon="INFO")


def draw_job(layout, context):
    side_task.draw_job(layout, context, session, operators.MESOGRAIN_OT_compare, operators.MESOGRAIN_OT_cancel_compare,
                       "rendered references are kept.", icon="RESTRICT_RENDER_OFF")


def draw_results(layout, context):
    if session.results is None:
        return
    for entry in session.results["cases"]:
        _draw_case(layout.box(), context, entry)
    layout.operator(operators.MESOGRAIN_OT_open_report.bl_idname, icon="URL")


def _draw_case(box, context, entry):
    if entry["status"] != "done":
        results.draw_title(box, context, entry)
        panels.draw_sentence(box, context, entry["error"])
        return
    results.draw(box, context, entry, ("Mesograin", f"{entry['frame_ms']:.2f} ms"),
                 operators.MESOGRAIN_OT_show_picture, case=entry["name"])


class MESOGRAIN_PT_compare(panels.MesograinPanel, bpy.types.Panel):
    bl_label = "Compare with Cycles"
    bl_context = "render"

    def draw(self, context):
        side_task.draw_settings(self.layout, context, session, draw_settings)
        draw_job(self.layout, context)
        draw_results(self.layout, context)


class MESOGRAIN_PT_compare_references(panels.MesograinPanel, bpy.types.Panel):
    bl_label = "References"
    bl_context = "render"
    bl_parent_id = "MESOGRAIN_PT_compare"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings = context.scene.mesograin_compare
        column = self.layout.column(align=True)
        column.enabled = not session.running
        column.prop(settings, "references")
        if not settings.references:
            panels.draw_sentence(self.layout, context, "None: each model's usual one", icon="INFO")
        reference_cache.draw(self.layout)


class MESOGRAIN_PT_compare_pictures(bpy.types.Panel):
    bl_label = "Compare with Cycles"
    bl_space_type = "IMAGE_EDITOR"
    bl_region_type = "UI"
    bl_category = "Mesograin"

    @classmethod
    def poll(cls, context):
        return context.scene.render.engine in panels.ENGINES

    def draw(self, context):
        draw_job(self.layout, context)
        draw_results(self.layout, context)


register, unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_PT_compare, MESOGRAIN_PT_compare_references, MESOGRAIN_PT_compare_pictures))
