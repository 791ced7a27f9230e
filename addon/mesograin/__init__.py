# The Mesograin add-on: single grains of sand, salt, sugar and snow, rendered in real time and compared with Cycles.
# SPDX-License-Identifier: GPL-3.0-or-later
bl_info = {
    "name": "Mesograin",
    "author": "The Mesograin authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render Properties > Render Engine > Mesograin",
    "description": "Real-time translucent grains, compared like for like with Cycles",
    "category": "Render",
}
__version__ = ".".join(str(number) for number in bl_info["version"])

# In the order of their imports: each room knows only those before it.
ROOMS = ("compat", "smooth_normals", "native_module", "properties", "presets", "status", "meshes", "heaps", "lights",
         "surroundings", "plain_materials", "export", "viewport", "viewport_text", "engine", "panels",
         "reference_cache", "preferences", "side_task.settings", "side_task.session",
         "side_task.pictures", "side_task.operators", "side_task.panel", "side_task.results",
         "compare_panel.properties", "compare_panel.session", "compare_panel.operators", "compare_panel.panel",
         "bake_panel.properties", "bake_panel.compared", "bake_panel.session", "bake_panel.operators",
         "bake_panel.panel")
# What scripts use, from the room `scripting`.
SCRIPTED = ("compare", "Comparison", "ComparisonError")
_rooms = []


def __getattr__(name):
    # Not at import, as below.
    if name not in SCRIPTED:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import importlib

    return getattr(importlib.import_module(f"{__package__}.scripting"), name)


def _load_rooms():
    """The rooms' modules; read again from disk if they were loaded before, which is what Reload Scripts asks for."""
    import importlib
    import sys

    for room in ROOMS:
        name = f"{__package__}.{room}"
        yield importlib.reload(sys.modules[name]) if name in sys.modules else importlib.import_module(name)


def register():
    # Not at import: the rooms need bpy, and what runs outside Blender imports its own room of this package alone.
    _rooms[:] = _load_rooms()
    for room in _rooms:
        if hasattr(room, "register"):
            room.register()


def unregister():
    for room in reversed(_rooms):
        if hasattr(room, "unregister"):
            room.unregister()
