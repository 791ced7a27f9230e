# What the buttons of the Compare panel do.
import bpy
from bpy.props import StringProperty

from ..side_task.operators import CancelOperator, ShowPictureOperator, StartOperator
from .session import session


class MESOGRAIN_OT_compare(StartOperator, bpy.types.Operator):
    bl_idname = "mesograin.compare"
    bl_label = "Compare with Cycles"
    bl_description = ("Render every chosen model and the Cycles materials that mean the same, beside this Blender, and "
                      "measure the difference")
    session = session

    def execute(self, context):
        if bpy.app.background:
            self.report({"ERROR"}, "Without a window, call mesograin.compare() from the script.")
            return {"CANCELLED"}
        return super().execute(context)


class MESOGRAIN_OT_cancel_compare(CancelOperator, bpy.types.Operator):
    bl_idname = "mesograin.cancel_compare"
    bl_label = "Cancel Comparison"
    bl_description = "End the comparison at once; references that are rendered stay in the cache"
    session = session


class MESOGRAIN_OT_open_report(bpy.types.Operator):
    bl_idname = "mesograin.open_report"
    bl_label = "Open Report"
    bl_description = "Show report.html in the web browser"

    @classmethod
    def poll(cls, _context):
        return session.results is not None and (session.task.out / "report.html").is_file()

    def execute(self, _context):
        return bpy.ops.wm.url_open(url=(session.task.out / "report.html").as_uri())


class MESOGRAIN_OT_show_picture(ShowPictureOperator, bpy.types.Operator):
    bl_idname = "mesograin.show_picture"
    bl_description = "Show this picture of the comparison in an Image Editor"
    session = session

    case: StringProperty(name="Case", description="MODEL.REFERENCE")

    def entry(self):
        for entry in session.results["cases"]:
            if entry["name"] == self.case and entry["status"] == "done":
                return entry, session.task.out
        raise LookupError(f"The last comparison has no pictures of a case '{self.case}'.")


register, unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_compare, MESOGRAIN_OT_cancel_compare, MESOGRAIN_OT_open_report, MESOGRAIN_OT_show_picture))
