# What an artist finds where Blender's Python has no NumPy: a sentence in the add-on's preferences that says what to do.
import sys

import bpy

SENTENCE = "Mesograin needs NumPy, which this Blender's Python lacks."
REMEDY = "Install it (in Debian and Ubuntu: python3-numpy) and restart Blender."


class MesograinPreferencesWithoutNumpy(bpy.types.AddonPreferences):
    bl_idname = __package__

    def draw(self, _context):
        self.layout.label(text=SENTENCE, icon="ERROR")
        self.layout.label(text=REMEDY)


_register_classes, unregister = bpy.utils.register_classes_factory((MesograinPreferencesWithoutNumpy,))


def register():
    _register_classes()
    print(SENTENCE, REMEDY, file=sys.stderr)  # who has no window
