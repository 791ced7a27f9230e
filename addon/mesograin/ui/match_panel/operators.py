# What the buttons of the Match to Picture panel do.
import bpy

from ...schema import models
from ..active_material import OnActiveMaterial, active_material
from ..side_task.operators import CancelOperator, ShowPictureOperator, StartOperator
from .session import session

# The pictures of a match: what each is called on its button, and what it shows.
BUTTONS = {
    "model": ("Model", "What was found, by Mesograin"),
    "reference": ("Picture", "What was to be matched, as small as it was compared"),
    "error": ("Error", "What was found less the picture"),
}


class MESOGRAIN_OT_match(StartOperator, bpy.types.Operator):
    bl_idname = "mesograin.match"
    bl_label = "Match to Picture"
    bl_description = ("Find, beside this Blender, the coefficients of this material by which the scene looks most like "
                      "the picture; the material stays as it is until Apply")
    session = session

    @classmethod
    def poll(cls, context):
        material = active_material(context)
        return material is not None and models.CHOICES[material.mesograin.model].translucent and super().poll(context)

    def execute(self, context):
        if bpy.app.background:
            self.report({"ERROR"}, "Without a window, call ./mesograin match.")
            return {"CANCELLED"}
        return super().execute(context)


class MESOGRAIN_OT_cancel_match(CancelOperator, bpy.types.Operator):
    bl_idname = "mesograin.cancel_match"
    bl_label = "Cancel Match"
    bl_description = "End the match at once; what was drawn is remembered, and the next one goes on from there"
    session = session


class MESOGRAIN_OT_show_match(ShowPictureOperator, bpy.types.Operator):
    bl_idname = "mesograin.show_match"
    bl_description = "Show this picture of the search in an Image Editor"
    session = session

    @classmethod
    def description(cls, _context, properties):
        return f"{BUTTONS[properties.picture][1]}; shown in an Image Editor"

    def entry(self):
        return session.entry, session.task.out


class MESOGRAIN_OT_apply_match(OnActiveMaterial, bpy.types.Operator):
    bl_idname = "mesograin.apply_match"
    bl_label = "Apply to Material"
    bl_description = "Give the matched material the coefficients that were found, with a scale of 1"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, _context):
        return session.results is not None and not session.running

    def execute(self, _context):
        found = session.results
        material = bpy.data.materials.get(found["material"])
        if material is None:
            self.report({"ERROR"}, f"There is no material '{found['material']}' any more.")
            return {"CANCELLED"}
        if material.library is not None:  # it would be as it was when the file is opened again
            self.report({"ERROR"}, f"'{material.name}' is linked: make it local, or override it.")
            return {"CANCELLED"}
        grain = material.mesograin
        for name in ("sigma_a", "sigma_s", "g", "scale"):
            setattr(grain, name, found[name])
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_match, MESOGRAIN_OT_cancel_match, MESOGRAIN_OT_show_match, MESOGRAIN_OT_apply_match))
