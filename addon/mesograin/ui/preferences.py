# The add-on's preferences: whether the native module works here, a button that proves it, diagnostics, and the cache.
import platform
import sys

import bpy
import numpy as np
from bpy.props import IntProperty, StringProperty

from .. import native_module
from ..cycles import reference_cache
from ..cycles.cache import DEFAULT_LIMIT
from ..engine import status
from . import panels


class MESOGRAIN_OT_self_test(bpy.types.Operator):
    bl_idname = "mesograin.self_test"
    bl_label = "Test Renderer"
    bl_description = "Render a small picture with a known answer and compare"

    def execute(self, _context):
        try:
            native = native_module.get()
        except native_module.Unavailable as unavailable:
            self.report({"ERROR"}, str(unavailable))
            return {"CANCELLED"}
        try:
            error = _worst_error(native)
            info = native.device_info()
        except native.Error as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        if not error < 1e-5:
            self.report({"ERROR"}, f"{info['renderer']} renders a lit square wrongly, by {error:.2g}: update the "
                        "graphics driver, or set MESOGRAIN_GL_DEVICE=software to render without it.")
            return {"CANCELLED"}
        self.report({"INFO"}, f"Mesograin renders correctly on {info['renderer']}.")
        return {"FINISHED"}


def _worst_error(native):
    """Relative error of a white Lambertian square that fills the picture, lit from 60 degrees with irradiance pi: its
    radiance is the cosine, 1/2."""
    corners = np.array([(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)], dtype=np.float32)
    mesh = native.Mesh(corners, None, np.array([(0, 1, 2), (0, 2, 3)], dtype=np.uint32))
    material = native.Material(model="lambert", reflectance=(1.0, 1.0, 1.0))
    light = native.DirectionalLight(direction_to_light=(np.sqrt(3.0), 0.0, 1.0), irradiance=(np.pi,) * 3)
    view = native.View(8, 8)
    view.set_scene(native.Scene(instances=[native.Instance(mesh, material, np.eye(4))], lights=[light]))
    view.set_camera(native.Camera.look_at((0.0, 0.0, 2.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 40.0))
    view.render(4)
    return float(np.max(np.abs(view.read()[..., :3] / 0.5 - 1.0)))


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
        lines.append(f"Self-test: relative error {_worst_error(native):.2g}")
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
        row = layout.row()
        row.operator(MESOGRAIN_OT_self_test.bl_idname)
        row.operator(MESOGRAIN_OT_copy_diagnostics.bl_idname, icon="COPYDOWN")
        layout.prop(self, "cache_folder")
        layout.prop(self, "cache_limit")
        reference_cache.draw(layout)

    def _draw_devices(self, context, native):
        try:
            info = native.device_info()
        except native.Error as error:
            panels.draw_sentence(self.layout, context, str(error))
            return
        for attempt in info["tried"]:
            icon = "RADIOBUT_ON" if attempt["device"] == info["chosen"] else "RADIOBUT_OFF"
            self.layout.label(text=f"Device {attempt['device']}: {attempt['result']}", icon=icon)


register, unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_self_test, MESOGRAIN_OT_copy_diagnostics, MesograinPreferences))
