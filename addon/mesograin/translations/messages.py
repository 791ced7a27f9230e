# What there is to translate, for who begins a language: docs/translating.md says how to print it.
import bpy

KINDS = ("Panel", "Menu", "Operator", "PropertyGroup", "AddonPreferences")


def _classes():
    package = __package__.rpartition(".")[0]
    return [one for kind in KINDS for one in getattr(bpy.types, kind).__subclasses__()
            if one.__module__.startswith(f"{package}.")]


def _properties():
    """Blender's RNA of all that an artist sets, and of what each may be."""
    for one in _classes():
        for name in getattr(one, "__annotations__", ()):
            each = one.bl_rna.properties.get(name)
            if each is not None and not each.is_hidden:
                yield each
                yield from getattr(each, "enum_items_static", ()) if each.type == "ENUM" else ()


def labels():
    """Names of panels, menus, buttons, properties and what these may be, each once."""
    names = [getattr(one, "bl_label", "") for one in _classes()] + [one.name for one in _properties()]
    return [name for name in dict.fromkeys(names) if name]


def tooltips():
    """The sentences that explain them, each once."""
    said = [getattr(one, "bl_description", "") for one in _classes()] + [one.description for one in _properties()]
    return [sentence for sentence in dict.fromkeys(said) if sentence]
