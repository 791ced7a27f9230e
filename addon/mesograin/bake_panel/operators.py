# What the buttons of the Bake panel do.
import bpy

from .. import native_module
from ..baking import surface
from . import session


class MESOGRAIN_OT_bake(bpy.types.Operator):
    bl_idname = "mesograin.bake"
    bl_label = "Bake to EXR"
    bl_description = "Shade the active object's surface at its UVs and write it to an EXR file; the file stays as it is"

    @classmethod
    def poll(cls, _context):
        return native_module.problem() is None and not session.running()

    def execute(self, context):
        try:
            session.start(context)
        except (surface.BakeError, surface.OutputError, native_module.get().Error) as error:
            session.bake, session.error = None, str(error)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if bpy.app.background:  # where no timer runs and nobody waits for a window
            session.bake.wait()
            for warning in session.bake.surface.warnings:
                self.report({"WARNING"}, warning)
            if session.bake.error:
                self.report({"ERROR"}, session.bake.error)
                return {"CANCELLED"}
        return {"FINISHED"}


class MESOGRAIN_OT_cancel_bake(bpy.types.Operator):
    bl_idname = "mesograin.cancel_bake"
    bl_label = "Cancel"
    bl_description = "End the bake; nothing is written"

    @classmethod
    def poll(cls, _context):
        return session.running()

    def execute(self, _context):
        session.cancel()
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((MESOGRAIN_OT_bake, MESOGRAIN_OT_cancel_bake))
