# The asset library that comes along: how Blender is told of it, and Add > Grain > Scatter, which takes what it needs.
from pathlib import Path

import bpy
from bpy.props import EnumProperty, IntProperty

from .. import compat
from . import grain_tools

FOLDER = Path(__file__).resolve().parents[1] / "assets"
FILE = FOLDER / "mesograin.blend"
NAME = "Mesograin"
SCATTER = "Scatter Grains"
KEY = "mesograin_asset"
"""The custom property that has the name of an asset, whatever it is called where it was taken to."""


def shapes_name(kind):
    """The collection of shapes of a kind."""
    return f"Many {kind.replace('_', ' ').title()}"


def registered(context):
    """Whether Blender's preferences have the library."""
    return any(Path(bpy.path.abspath(library.path)).resolve() == FOLDER
               for library in context.preferences.filepaths.asset_libraries if library.path)


def take(kind, name):
    """A datablock of the library: what this file has of it, or else a copy. kind: of bpy.data, such as 'collections'.
    Raises LookupError or OSError with a sentence."""
    for known in getattr(bpy.data, kind):
        if known.get(KEY) == name and known.library is None:
            return known
    with bpy.data.libraries.load(str(FILE), link=False) as (there, taken):
        if name not in getattr(there, kind):
            raise LookupError(f"The asset library {FILE} has no '{name}': install the add-on anew.")
        setattr(taken, kind, [name])
    [made] = getattr(taken, kind)
    made.asset_clear()  # it is the library's, not this file's
    made.use_fake_user = False
    return made


def show_materials(surface, shapes):
    """Gives a mesh object slots of a collection's grains' materials, and shows the first: nobody would look for them
    in the collection. Its faces keep what they have, if it is nothing."""
    slots = surface.data.materials
    if surface.data.library is not None:
        return
    if not slots:
        slots.append(None)
    grains = dict.fromkeys(material for shape in shapes.objects for material in shape.data.materials)
    for material in grains:
        if material.name not in slots:
            slots.append(material)
    surface.active_material_index = min(slots.find(material.name) for material in grains)


class MESOGRAIN_OT_add_asset_library(bpy.types.Operator):
    bl_idname = "mesograin.add_asset_library"
    bl_label = "Add Asset Library"
    bl_description = "Show grains, their materials and Scatter Grains in the Asset Browser, as the library Mesograin"

    @classmethod
    def poll(cls, context):
        return not registered(context)

    def execute(self, context):
        bpy.ops.preferences.asset_library_add(directory=str(FOLDER))
        library = context.preferences.filepaths.asset_libraries[-1]
        library.name = NAME
        compat.import_by_appending(library)
        context.preferences.is_dirty = True
        self.report({"INFO"}, f"The Asset Browser has the library {NAME}.")
        return {"FINISHED"}


class MESOGRAIN_OT_scatter(bpy.types.Operator):
    bl_idname = "mesograin.scatter"
    bl_label = "Scatter Grains"
    bl_description = "Strew grains over the active mesh, each turned, sized and coloured by a seed: a modifier"
    bl_options = {"REGISTER", "UNDO"}

    kind: EnumProperty(name="Kind", items=grain_tools.KIND_ITEMS, description="What the grains are")
    seed: IntProperty(name="Seed", min=0, description="Another seed strews them otherwise")

    @classmethod
    def poll(cls, context):
        return context.active_object is not None and context.active_object.type == "MESH"

    def execute(self, context):
        try:
            nodes, shapes = take("node_groups", SCATTER), take("collections", shapes_name(self.kind))
        except (LookupError, OSError) as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        surface = context.active_object
        modifier = surface.modifiers.new(SCATTER, "NODES")
        modifier.node_group = nodes
        for name, value in (("Grains", shapes), ("Seed", self.seed)):
            compat.set_modifier_input(modifier, name, value)
        show_materials(surface, shapes)
        surface.update_tag()
        return {"FINISHED"}


def _draw_menu(self, _context):
    self.layout.operator(MESOGRAIN_OT_scatter.bl_idname, text="Scatter", icon="STICKY_UVS_DISABLE")


_register, _unregister = bpy.utils.register_classes_factory((MESOGRAIN_OT_add_asset_library, MESOGRAIN_OT_scatter))


def register():
    _register()
    grain_tools.MESOGRAIN_MT_add.append(_draw_menu)


def unregister():
    grain_tools.MESOGRAIN_MT_add.remove(_draw_menu)
    _unregister()
