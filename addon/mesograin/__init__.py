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

# What there is to register, in the order of its imports: each room knows only those before it.
ROOMS = ("compat", "translations", "native_module", "grains.shape", "grains.kinds", "grains.pile", "grains.objects",
         "scene.smooth_normals", "scene.properties", "scene.meshes", "scene.heaps", "scene.lens", "scene.lights",
         "scene.mesh_lights", "scene.images", "scene.node_colours", "scene.node_patterns", "scene.node_skies",
         "scene.unwrapped", "scene.colours", "scene.overrides", "scene.surroundings",
         "scene.textures", "scene.plain_materials", "scene.thick_layer", "scene.coloured_glass", "scene.export",
         "engine.status", "engine.writing", "engine.motion", "engine.identities", "engine.passes", "engine.viewport",
         "engine.viewport_text", "engine.own_grain", "engine.material_preview", "engine.engine",
         "cycles.reference_cache", "ui.presets", "ui.look", "ui.conversion", "ui.copy_grain", "ui.named_things",
         "ui.panels", "ui.preview", "ui.node_panels", "ui.notes",
         "ui.grain_tools", "ui.grain_colours", "ui.asset_library", "ui.self_test", "ui.preferences",
         *(f"ui.side_task.{name}"
           for name in ("settings", "session", "job_session", "pictures", "operators", "panel", "results")),
         *(f"ui.compare_panel.{name}" for name in ("properties", "session", "operators", "panel")),
         *(f"ui.bake_panel.{name}" for name in ("properties", "compared", "session", "operators", "panel")),
         *(f"ui.match_panel.{name}" for name in ("properties", "session", "operators", "panel")), "ui.menus")
# What there is instead where Blender's Python has no NumPy, as Debian's may be installed.
ROOMS_WITHOUT_NUMPY = ("without_numpy",)
# What scripts use, from `studies.scripting`.
SCRIPTED = ("compare", "Comparison", "ComparisonError")
_rooms = []


def __getattr__(name):
    # Not at import, as below.
    if name not in SCRIPTED:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import importlib

    return getattr(importlib.import_module(f"{__package__}.studies.scripting"), name)


def _has_numpy():
    try:
        import numpy  # noqa: F401
    except ImportError:
        return False
    return True


def _load_rooms():
    """The rooms' modules; read again from disk if they were loaded before, which is what Reload Scripts asks for."""
    import importlib
    import sys

    for room in ROOMS if _has_numpy() else ROOMS_WITHOUT_NUMPY:
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
