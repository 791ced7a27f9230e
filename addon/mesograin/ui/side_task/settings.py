# What a scene remembers of how a long task is to be done: a property group of its own on every scene.
import bpy
from bpy.props import PointerProperty


def remembered_by_scenes(name, group):
    """(register, unregister) of the property group class `group`, which is then `scene.<name>`."""

    def register():
        bpy.utils.register_class(group)
        setattr(bpy.types.Scene, name, PointerProperty(type=group))

    def unregister():
        delattr(bpy.types.Scene, name)
        bpy.utils.unregister_class(group)

    return register, unregister
