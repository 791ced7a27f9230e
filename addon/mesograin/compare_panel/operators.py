# What the buttons of the Compare panel do.
import bpy
from bpy.props import EnumProperty, StringProperty

from ..side_task.operators import CancelOperator, StartOperator
from . import pictures
from .session import session


# What each of pictures.FILES is called on its button, and what it shows.
PICTURES = {
    "model": ("Model", "Our picture, linear"),
    "reference": ("Reference", "The mean of Cycles' seeds, linear"),
    "error": ("Error", "Our picture less the reference, linear; negative where ours is too dark"),
    "error colours": ("Colours", "The relative error in false colours"),
    "z-map": ("Z-map", "In colour where the two differ by more than their noise explains"),
}


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


class MESOGRAIN_OT_show_picture(bpy.types.Operator):
    bl_idname = "mesograin.show_picture"
    bl_label = "Show Picture"
    bl_description = "Show this picture of the comparison in an Image Editor"

    case: StringProperty(name="Case", description="MODEL.REFERENCE")
    picture: EnumProperty(name="Picture", items=tuple(
        (name, *PICTURES[name], number) for number, name in enumerate(pictures.FILES)))

    @classmethod
    def description(cls, _context, properties):
        return f"{PICTURES[properties.picture][1]}; shown in an Image Editor"

    @classmethod
    def poll(cls, _context):
        return session.results is not None

    def execute(self, context):
        entry = next((entry for entry in session.results["cases"]
                      if entry["name"] == self.case and entry["status"] == "done"), None)
        if entry is None:
            self.report({"ERROR"}, f"The last comparison has no pictures of a case '{self.case}'.")
            return {"CANCELLED"}
        try:
            image = pictures.show(entry, self.picture, session.task.out)
        except RuntimeError as error:
            self.report({"ERROR"}, f"The picture cannot be shown: {' '.join(str(error).split())}")
            return {"CANCELLED"}
        area = _image_editor(context)
        area.spaces.active.image = image
        return {"FINISHED"}


def _image_editor(context):
    """The Image Editor that is used, or else the largest, or else one in a window of its own."""
    if context.area and context.area.type == "IMAGE_EDITOR":
        return context.area
    editors = [area for window in context.window_manager.windows for area in window.screen.areas
               if area.type == "IMAGE_EDITOR"]
    if not editors:
        before = set(context.window_manager.windows)
        bpy.ops.wm.window_new()
        [window] = set(context.window_manager.windows) - before
        editors = [window.screen.areas[0]]
        editors[0].ui_type = "IMAGE_EDITOR"
    return max(editors, key=lambda area: area.width * area.height)


register, unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_compare, MESOGRAIN_OT_cancel_compare, MESOGRAIN_OT_open_report, MESOGRAIN_OT_show_picture))
