# The add-on's preferences: whether the native module works here, a button that proves it, diagnostics, and the cache.
import os
import platform
import sys

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from .. import native_module
from ..cycles import reference_cache
from ..cycles.cache import DEFAULT_LIMIT
from ..engine import status
from . import asset_library, panels, self_test


DEVICE = "MESOGRAIN_GL_DEVICE"  # in the environment, of which the renderer takes it once a process
_given = os.environ.get(DEVICE)  # by who started Blender, who goes before what is preferred
_begun_with = "any"  # what was preferred when the add-on was enabled
_told = []  # sentences of the last self-test, for the panel


def use_device(preferred):
    """Has the renderer of this process, and of those that it starts, take hardware, software or either."""
    if _given is None:
        os.environ.pop(DEVICE, None)
        if preferred != "any":
            os.environ[DEVICE] = preferred


class MESOGRAIN_OT_self_test(bpy.types.Operator):
    bl_idname = "mesograin.self_test"
    bl_label = "Test Renderer"
    bl_description = ("Render a square whose light is known and a bead by each model, compare with what they should be,"
                      " and time how fast pictures are read back; takes seconds")

    def execute(self, _context):
        _told.clear()
        try:
            _told.extend(self_test.run())
        except native_module.Unavailable as unavailable:
            self.report({"ERROR"}, str(unavailable))
            return {"CANCELLED"}
        except native_module.get().Error as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        self.report({"INFO"}, _told[0])
        return {"FINISHED"}


def diagnostics():
    """What a maintainer asks for, as text: versions, devices, the self-test, the last complaints."""
    lines = [f"Blender {bpy.app.version_string} ({bpy.app.build_hash.decode(errors='replace')}), "
             f"Python {sys.version.split()[0]}, {platform.platform()}"]
    problem = native_module.problem()
    if problem:
        return "\n".join([*lines, problem])
    native = native_module.get()
    lines.append(f"Mesograin {native.__version__}: {native.__file__}")
    try:
        info = native.device_info()
        lines.append(f"Device {info['chosen']}: {info['renderer']}, OpenGL {info['version']}")
        lines += [f"  tried {attempt['device']}: {attempt['result']}" for attempt in info["tried"]]
        lines += [f"Self-test: {sentence}" for sentence in self_test.run()]
    except native.Error as error:
        lines.append(str(error))
    for kind in (status.RENDER, status.VIEWPORT):
        latest = status.get(kind)
        if latest is not None:
            passes = ", ".join(f"{name} {milliseconds:.2f} ms" for name, milliseconds in latest.passes)
            lines.append(f"Last {kind}: {latest.width} x {latest.height}, {latest.samples} samples; {passes}")
    return "\n".join([*lines, *status.complaints()])


class MESOGRAIN_OT_copy_diagnostics(bpy.types.Operator):
    bl_idname = "mesograin.copy_diagnostics"
    bl_label = "Copy Diagnostics"
    bl_description = "Copy versions, devices, the self-test's result and the last complaints, for a report"

    def execute(self, context):
        context.window_manager.clipboard = diagnostics()
        self.report({"INFO"}, "Diagnostics are in the clipboard.")
        return {"FINISHED"}


class MesograinPreferences(bpy.types.AddonPreferences):
    bl_idname = reference_cache.ADDON

    device: EnumProperty(
        name="Device", default="any", update=lambda chosen, _context: use_device(chosen.device),
        description=f"What renders. {DEVICE} in Blender's environment goes before it", items=(
            ("any", "Any", "The first that works, hardware before software", 0),
            ("hardware", "Hardware", "A graphics card, or nothing", 1),
            ("software", "Software", "The processor, by Mesa: slower, and right where a driver is not", 2)))
    cache_folder: StringProperty(
        name="Reference cache", subtype="DIR_PATH",
        description="Where rendered references are kept; empty is mesograin/references in your cache folder")
    cache_limit: IntProperty(
        name="Limit (MiB)", default=DEFAULT_LIMIT // 1024**2, min=1, max=1 << 30, soft_max=1 << 16,
        description="What all references together may take; the longest unused go first")

    def draw(self, context):
        layout = self.layout
        if not panels.draw_native_problem(layout, context):
            native = native_module.get()
            layout.label(text=f"Native module {native.__version__}: {native.__file__}", icon="CHECKMARK")
            self._draw_devices(context, native)
        layout.use_property_split = True
        layout.use_property_decorate = False
        self._draw_choice(context)
        row = layout.row()
        row.operator(MESOGRAIN_OT_self_test.bl_idname)
        row.operator(MESOGRAIN_OT_copy_diagnostics.bl_idname, icon="COPYDOWN")
        for sentence in _told:
            panels.draw_sentence(layout, context, sentence, icon="CHECKMARK")
        if not asset_library.registered(context):
            layout.operator(asset_library.MESOGRAIN_OT_add_asset_library.bl_idname, icon="ASSET_MANAGER")
        layout.prop(self, "cache_folder")
        layout.prop(self, "cache_limit")
        reference_cache.draw(layout)

    def _draw_choice(self, context):
        row = self.layout.row()
        row.enabled = _given is None
        row.prop(self, "device", expand=True)
        if _given is not None:
            panels.draw_sentence(self.layout, context, f"{DEVICE}={_given} in the environment decides.", icon="INFO")
        elif self.device != _begun_with:
            panels.draw_sentence(self.layout, context, "Blender takes it when it starts the next time.", icon="INFO")

    def _draw_devices(self, context, native):
        try:
            info = native.device_info()
        except native.Error as error:
            panels.draw_sentence(self.layout, context, str(error))
            return
        for attempt in info["tried"]:
            icon = "RADIOBUT_ON" if attempt["device"] == info["chosen"] else "RADIOBUT_OFF"
            self.layout.label(text=f"Device {attempt['device']}: {attempt['result']}", icon=icon)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_self_test, MESOGRAIN_OT_copy_diagnostics, MesograinPreferences))


def register():
    global _begun_with
    _register_classes()
    addon = bpy.context.preferences.addons.get(reference_cache.ADDON)
    _begun_with = addon.preferences.device if addon and addon.preferences else "any"
    use_device(_begun_with)


def unregister():
    use_device("any")  # lest the next registration takes it for what was given
    _unregister_classes()
