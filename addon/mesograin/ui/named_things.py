# What a complaint names, found and selected: each names objects, lights and materials in quotation marks.
import itertools
import re

import bpy
from bpy.props import StringProperty

MOST = 3  # buttons for one sentence


def find(sentence, context):
    """The objects of the view layer that a sentence names, or that wear the materials it names; at most MOST."""
    names = dict.fromkeys(re.findall(r"'([^']+)'", sentence))
    here = context.view_layer.objects
    materials = {name for name in names if name in bpy.data.materials and name not in here}
    wearing = (thing for thing in here if any(slot.material and slot.material.name in materials
                                              for slot in thing.material_slots))
    named = (here[name] for name in names if name in here)
    return list(itertools.islice(itertools.chain(named, wearing if materials else ()), MOST))


class MESOGRAIN_OT_select_named(bpy.types.Operator):
    bl_idname = "mesograin.select_named"
    bl_label = "Select"
    bl_description = "Select this object alone and make it the active one"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty(name="Object")

    def execute(self, context):
        thing = context.view_layer.objects.get(self.name)
        if thing is None:
            self.report({"ERROR"}, f"There is no object '{self.name}' in this view layer any more.")
            return {"CANCELLED"}
        for other in context.selected_objects:
            other.select_set(False)
        if not thing.visible_get():
            self.report({"WARNING"}, f"'{self.name}' is hidden; it is the active object now.")
        thing.select_set(True)
        context.view_layer.objects.active = thing
        return {"FINISHED"}


def draw(layout, context, sentence):
    """A button for each thing that the sentence names."""
    for thing in find(sentence, context):
        draw_button(layout, thing.name)


def draw_button(layout, name):
    """The button that selects an object."""
    layout.operator(MESOGRAIN_OT_select_named.bl_idname, text=f"Select '{name}'",
                    icon="RESTRICT_SELECT_OFF").name = name


register, unregister = bpy.utils.register_classes_factory((MESOGRAIN_OT_select_named,))
