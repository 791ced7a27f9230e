# What the buttons of the Bake panel do.
import bpy

from ...cycles.wording import in_labels
from ..side_task.operators import CancelOperator, ShowPictureOperator, StartOperator
from .session import session


class MESOGRAIN_OT_bake(StartOperator, bpy.types.Operator):
    bl_idname = "mesograin.bake"
    bl_label = "Bake to EXR"
    bl_description = "Shade the active object's surface at its UVs and write it to an EXR file; the file stays as it is"
    session = session

    def execute(self, context):
        outcome = super().execute(context)
        bake = session.task
        if bake is not None and bpy.app.background:  # where no timer runs and nobody waits for a window
            bake.wait()
            session.finish()
            for sentence in bake.sentences:
                self.report({"WARNING"}, in_labels(sentence))
            if bake.error:
                self.report({"ERROR"}, in_labels(bake.error))
                return {"CANCELLED"}
        return outcome


class MESOGRAIN_OT_cancel_bake(CancelOperator, bpy.types.Operator):
    bl_idname = "mesograin.cancel_bake"
    bl_label = "Cancel Bake"
    bl_description = "End the bake; nothing is written"
    session = session


class MESOGRAIN_OT_show_bake(ShowPictureOperator, bpy.types.Operator):
    bl_idname = "mesograin.show_bake"
    bl_description = "Show this picture of the bakes in an Image Editor"
    session = session

    def entry(self):
        return session.task.entry, session.task.path.parent


register, unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_bake, MESOGRAIN_OT_cancel_bake, MESOGRAIN_OT_show_bake))
