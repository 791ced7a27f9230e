# What the artist sees in the Properties editor: the grain of a material, the sun, render settings and complaints.
import textwrap

import bpy

from . import engine, export, native_module, presets, status

ENGINES = {engine.MesograinRenderEngine.bl_idname}
# At a UI scale of 1, in pixels: the average width of a character, and what margins and an icon take of a panel's width.
CHARACTER_WIDTH = 6.5
MARGINS = 95


def draw_sentence(layout, context, sentence, icon="ERROR"):
    """A sentence of any length, wrapped to the region's width."""
    pixels = context.region.width if context.region else 300
    columns = max(8, int((pixels / context.preferences.system.ui_scale - MARGINS) / CHARACTER_WIDTH))
    column = layout.column(align=True)
    column.scale_y = 0.8
    for line, text in enumerate(textwrap.wrap(sentence, columns)):
        column.label(text=text, icon="BLANK1" if line and icon != "NONE" else icon)


def draw_native_problem(layout, context):
    """The native module's problem, if it has one; tells whether it has."""
    problem = native_module.problem()
    if problem:
        draw_sentence(layout, context, problem)
    return problem is not None


class MesograinPanel:
    """Shown in the Properties editor while Mesograin is the scene's render engine."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = ENGINES

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES


class MESOGRAIN_PT_material(MesograinPanel, bpy.types.Panel):
    bl_label = "Grain"
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        return context.material is not None and super().poll(context)

    def draw_header_preset(self, _context):
        self.layout.menu(presets.MESOGRAIN_MT_presets.bl_idname, text="", icon="PRESET")

    def draw(self, context):
        layout, grain = self.layout, context.material.mesograin
        layout.use_property_split = True
        layout.use_property_decorate = False
        if not draw_native_problem(layout, context):
            self._draw_material_problem(context)
        layout.prop(grain, "model")
        if grain.model in presets.OPAQUE_MODELS:
            layout.prop(grain, "reflectance")
        else:
            self._draw_medium(context, grain)
        if grain.model != "lambert":
            self._draw_surface(grain)

    def _draw_material_problem(self, context):
        native = native_module.get()
        try:
            export.material_values(context.material, context.scene.mesograin.millimetres_per_unit).to_native(native)
        except native.Error as error:
            draw_sentence(self.layout, context, str(error))

    def _draw_medium(self, context, grain):
        layout = self.layout
        layout.prop(grain, "sigma_s", text="sigma_s (1/mm)")
        layout.prop(grain, "sigma_a", text="sigma_a (1/mm)")
        layout.prop(grain, "scale")
        layout.prop(grain, "g")
        layout.prop(grain, "profile")
        column = layout.column()
        column.active = False
        sigma_t = [(sigma_s + sigma_a) * grain.scale for sigma_s, sigma_a in zip(grain.sigma_s, grain.sigma_a)]
        paths = ", ".join(f"{1.0 / value:.3g}" if value > 0.0 else "endless" for value in sigma_t)
        draw_sentence(column, context, f"Mean free path of R, G, B: {paths} mm", icon="NONE")

    def _draw_surface(self, grain):
        layout = self.layout
        if grain.model not in presets.OPAQUE_MODELS:
            layout.prop(grain, "boundary")
            row = layout.row()
            row.active = grain.boundary in ("dielectric", "lambert_refracted")
            row.prop(grain, "eta")
        column = layout.column()
        column.active = grain.model == "conductor" or grain.boundary in ("dielectric", "lambert_refracted")
        column.prop(grain, "roughness")
        column.prop(grain, "masking")
        if grain.model not in presets.OPAQUE_MODELS:
            row = layout.row()
            row.active = grain.boundary == "dielectric"
            row.prop(grain, "specular")


class MESOGRAIN_PT_light(MesograinPanel, bpy.types.Panel):
    bl_label = "Sun"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.light is not None and super().poll(context)

    def draw(self, context):
        layout, light = self.layout, context.light
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(light, "type")
        if light.type != "SUN":
            draw_sentence(layout, context, "Mesograin renders sun lights only; this light is left out.")
            return
        layout.prop(light, "color")
        layout.prop(light, "energy", text="Irradiance")
        layout.prop(light, "angle")


class MESOGRAIN_PT_sampling(MesograinPanel, bpy.types.Panel):
    bl_label = "Sampling"
    bl_context = "render"

    def draw(self, context):
        layout, settings = self.layout, context.scene.mesograin
        layout.use_property_split = True
        layout.use_property_decorate = False
        if not draw_native_problem(layout, context):
            for sentence in status.complaints():
                draw_sentence(layout, context, sentence)
        layout.prop(settings, "samples")
        layout.prop(settings, "viewport_samples")
        layout.prop(settings, "millimetres_per_unit")
        layout.prop(context.scene.render, "film_transparent", text="Transparent Film")


class MESOGRAIN_PT_statistics(MesograinPanel, bpy.types.Panel):
    bl_label = "Device and Timings"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        if draw_native_problem(self.layout, context):
            return
        self._draw_device(context)
        for kind, title in ((status.RENDER, "Last render"), (status.VIEWPORT, "Viewport")):
            latest = status.get(kind)
            if latest is not None and latest.samples:
                self._draw_picture(title, latest)

    def _draw_device(self, context):
        native = native_module.get()
        try:
            info = native.device_info()
        except native.Error as error:
            draw_sentence(self.layout, context, str(error))
            return
        kind = "hardware" if info["hardware"] else "software"
        draw_sentence(self.layout, context, f"{info['renderer']} ({kind}), OpenGL {info['version']}", icon="DESKTOP")

    def _draw_picture(self, title, latest):
        column = self.layout.column(align=True)
        column.label(text=f"{title}: {latest.width} x {latest.height}, {latest.samples} samples")
        for name, milliseconds in latest.passes:
            column.label(text=f"{name}: {milliseconds:.2f} ms", icon="BLANK1")


register, unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_PT_material, MESOGRAIN_PT_light, MESOGRAIN_PT_sampling, MESOGRAIN_PT_statistics))
