# Below Blender's preview of a material: whether it shows one of Blender's shapes or the artist's own grain.
import bpy

from ..engine import engine, material_preview
from ..scene import plain_materials


def _draw(panel, context):
    material, thing = context.material, context.object
    if context.engine != engine.MesograinRenderEngine.bl_idname or plain_materials.is_plain(material):
        return
    panel.layout.row().prop(material, "mesograin_preview", expand=True)
    if thing is not None and material.mesograin_preview == material_preview.OWN:
        material_preview.note_object(material, thing, context.evaluated_depsgraph_get())


def register():
    bpy.types.MATERIAL_PT_preview.append(_draw)


def unregister():
    bpy.types.MATERIAL_PT_preview.remove(_draw)
