# Keeps what library overrides change of a grain: Blender 5 drops, of a group of properties that neither the library's
# file nor the open one holds yet, all that is changed; it holds what was read once.
import bpy


@bpy.app.handlers.persistent
def read_before_saving(*_arguments):
    """Reads the groups of all overridden materials, and of what they override."""
    for material in bpy.data.materials:
        if material.override_library is not None:
            for each in (material, material.override_library.reference):
                _read_groups(each)


def _read_groups(material):
    for name, declared in material.bl_rna.properties.items():
        if name.startswith("mesograin") and declared.type == "POINTER":
            group = getattr(material, name)
            for each in group.bl_rna.properties.keys():
                getattr(group, each)


def register():
    bpy.app.handlers.save_pre.append(read_before_saving)


def unregister():
    bpy.app.handlers.save_pre.remove(read_before_saving)
