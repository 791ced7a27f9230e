# What the buttons of the Bake panel do.
import bpy

from ..side_task.operators import CancelOperator, StartOperator
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
            for warning in bake.surface.warnings:
                self.report({"WARNING"}, warning)
            if bake.error:
                self.report({"ERROR"}, bake.error)
                return {"CANCELLED"}
        return outcome


class MESOGRAIN_OT_cancel_bake(CancelOperator, bpy.types.Operator):
    bl_idname = "mesograin.cancel_bake"
    bl_description = "End the bake; nothing is written"
    session = session


register, unregister = bpy.utils.register_classes_factory((MESOGRAIN_OT_bake, MESOGRAIN_OT_cancel_bake))
