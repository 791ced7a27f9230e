# What panels, menus, buttons and tooltips say in other languages: LANGUAGE.json beside this file, by Blender's names of
# them (de_DE), each {English: translated}. What a language lacks stays English.
import json
import pathlib

# Buttons look for what they say among operators, all else elsewhere.
CONTEXTS = ("*", "Operator")


def read(folder=pathlib.Path(__file__).parent):
    """As bpy.app.translations.register takes them."""
    languages = {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.json"))}
    return {language: {(context, english): said for english, said in texts.items() for context in CONTEXTS}
            for language, texts in languages.items()}


def register():
    import bpy

    bpy.app.translations.register(__package__, read())


def unregister():
    import bpy

    bpy.app.translations.unregister(__package__)
