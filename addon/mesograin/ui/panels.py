# What the artist sees in the Properties editor: the grain of a material, the sun, render settings and complaints.
import textwrap

import bpy

from .. import compat, native_module
from ..cycles.wording import in_labels
from ..engine import engine, material_preview, passes, status
from ..scene import budgets, export, plain_materials
from ..schema import models, parameters
from . import conversion, look, named_things, presets
from .widths import CHARACTER_WIDTH, MARGINS, arrange, choose, width

ENGINES = {engine.MesograinRenderEngine.bl_idname}
# What is left for text of one of a popover's units of width, 20 pixels.
POPOVER_UNIT = 17
MEDIUM = ("sigma_s", "sigma_a", "scale", "g", "profile")
REFRACTING = ("dielectric", "lambert_refracted")
SURFACE = {"boundary": (), "reflectance_to_others": parameters.COSINE_LOBES, "eta": REFRACTING,
           "roughness": REFRACTING, "masking": REFRACTING, "specular": ("dielectric",)}
"""A grain's parameters as they are grouped; of the surface's, the boundaries for which they count."""


def draw_sentence(layout, context, sentence, icon="ERROR", units=None):
    """A sentence of any length, with labels for identifiers, wrapped to the region's width, or to a popover's of so
    many units."""
    if units:
        pixels = units * POPOVER_UNIT
    else:
        pixels = width(context) - MARGINS
    columns = max(8, int(pixels / CHARACTER_WIDTH))
    column = layout.column(align=True)
    column.scale_y = 0.8
    for line, text in enumerate(textwrap.wrap(in_labels(sentence), columns)):
        column.label(text=text, icon="BLANK1" if line and icon != "NONE" else icon)


def draw_complaints(layout, context, icon="ERROR", units=None):
    """What is wrong with the last pictures, with buttons that select what is named."""
    for sentence in status.complaints():
        draw_sentence(layout, context, sentence, icon, units)
        named_things.draw(layout, context, sentence)


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
    about = ""  # what of the context there must be

    @classmethod
    def poll(cls, context):
        return (context.engine in cls.COMPAT_ENGINES
                and (not cls.about or getattr(context, cls.about) is not None))


class MESOGRAIN_PT_material(MesograinPanel, bpy.types.Panel):
    bl_label = "Grain"
    bl_context = about = "material"

    def draw_header_preset(self, _context):
        self.layout.menu(conversion.MESOGRAIN_MT_conversion.bl_idname, text="", icon="NODE_MATERIAL")
        self.layout.menu(presets.MESOGRAIN_MT_presets.bl_idname, text="", icon="PRESET")
        self.layout.separator(factor=0.5)  # from the grip

    def draw(self, context):
        layout, grain = self.layout, context.material.mesograin
        arrange(layout, context)
        layout.use_property_decorate = True
        if not draw_native_problem(layout, context):
            self._draw_material_problem(context)
        row = layout.row()  # as wide as the panel: the models' names are long
        row.use_property_split = False
        if plain_materials.is_plain(context.material):
            row.prop_menu_enum(grain, "model", text="Choose a Model")  # by none of which it is drawn
            self._draw_plain(context)
            return
        row.prop(grain, "model", text="")
        if layout.use_property_split:  # where the others have their dot
            row.prop_decorator(grain, "model")
        takes = models.CHOICES[grain.model].parameters
        advised = self._advice(context) if "sigma_s" in takes else None
        if "sigma_s" in takes:
            row = layout.row()
            row.enabled = advised is not None and advised.model != grain.model
            row.operator(look.MESOGRAIN_OT_choose_model.bl_idname)
            self._draw_medium(context, grain)
        for name in takes:
            if name not in (*MEDIUM, *SURFACE):
                layout.prop(grain, name)
        self._draw_surface(grain, takes)
        if "sigma_s" in takes:
            self._draw_thickness(context, advised)

    def _draw_plain(self, context):
        """Ways to a grain."""
        draw_sentence(self.layout, context, "No grain yet: it is drawn as its nodes say. Choose a model, a material or"
                      " what its nodes mean to make it one.", icon="INFO")
        column = self.layout.column(align=True)
        column.menu(presets.MESOGRAIN_MT_presets.bl_idname, icon="PRESET")
        column.operator(conversion.MESOGRAIN_OT_from_cycles.bl_idname, icon="NODE_MATERIAL")

    def _draw_material_problem(self, context):
        native = native_module.get()
        try:
            export.material_values(context.material, context.scene.mesograin.millimetres_per_unit).to_native(native)
        except native.Error as error:
            draw_sentence(self.layout, context, str(error))

    @staticmethod
    def _advice(context):
        """Of models for the object that is selected; None where there is none to give."""
        thing = getattr(context, "object", None)
        if thing is None or native_module.problem():
            return None
        settings = context.scene.mesograin
        return look.advise_as_seen(context.material, thing, settings.millimetres_per_unit, budgets.tolerance(settings))

    def _draw_thickness(self, context, advised):
        """How thick the object is for light, and which model is for it: last, for while a slider is dragged these
        sentences take more lines or fewer, and what is above them stays under the mouse."""
        thing = getattr(context, "object", None)
        if thing is None or native_module.problem():
            return
        said = context.material, thing, context.scene.mesograin.millimetres_per_unit
        size = look.grain_size(*said)
        if size > 0.0:
            material_preview.note_size(context.material.name, size)
        hint = look.hint(*said)
        for sentence in (hint, advised and advised.sentence):
            if sentence:
                draw_sentence(self.layout, context, sentence, icon="LIGHT")

    def _draw_medium(self, context, grain):
        layout, said = self.layout, context.material.mesograin_look
        row = layout.row()
        row.use_property_decorate = False  # how it is said, and no part of it
        row.prop(said, "way", expand=True)
        sigma_t = [(sigma_s + sigma_a) * grain.scale for sigma_s, sigma_a in zip(grain.sigma_s, grain.sigma_a)]
        if said.way == "look":
            look.draw(layout, said)
            units = f"Path in mm; sigma_t {', '.join(f'{value:.3g}' for value in sigma_t)} per mm"
        else:
            look.draw_channels(layout, grain, "sigma_s", "sigma_s")
            look.draw_channels(layout, grain, "sigma_a", "sigma_a")
            layout.prop(grain, "scale")
            paths = ", ".join(f"{1.0 / value:.3g}" if value > 0.0 else "endless" for value in sigma_t)
            units = f"sigma per mm; mean free path {paths} mm"
        column = layout.column()
        column.active = False
        draw_sentence(column, context, units, icon="NONE")
        layout.prop(grain, "g")
        _choose_profile(layout, grain)

    def _draw_surface(self, grain, takes):
        if "eta" in takes:
            self.layout.prop(grain.id_data.mesograin_look, "surroundings")
        for name, boundaries in SURFACE.items():
            if name in takes:
                row = self.layout.row()
                row.active = name == "boundary" or "boundary" not in takes or grain.boundary in boundaries
                if parameters.PARAMETERS[name].kind == "choice":
                    choose(row, grain, name, parameters.PARAMETERS[name].label)
                else:
                    row.prop(grain, name)


class MESOGRAIN_MT_profiles(bpy.types.Menu):
    bl_idname = "MESOGRAIN_MT_profiles"
    bl_label = "Profile"
    bl_description = "The theory that answers for multiple scattering, of those that the model knows"

    def draw(self, context):
        grain = context.material.mesograin
        for profile in parameters.profiles_of(grain.model):
            self.layout.prop_enum(grain, "profile", profile)


def _profile_label(grain):
    choices = parameters.PARAMETERS["profile"].choices
    return next(choice.label for choice in choices if choice.name == grain.profile)


def _choose_profile(layout, grain):
    """As `choose`, of those that the model knows. Not by prop_with_menu: Blender 4.3 dies when it frees what that
    drew."""
    menu = {"menu": MESOGRAIN_MT_profiles.bl_idname, "text": _profile_label(grain)}
    if layout.use_property_split:
        column = layout.column(align=True)
        row = column.row(heading="Profile")
        row.menu(**menu)
        row.prop_decorator(grain, "profile")
        # The dot is of a property's button, and a menu is none: of this one, which takes no room.
        hidden = column.row()
        hidden.use_property_split = hidden.use_property_decorate = False
        hidden.scale_y = 0.001
        hidden.prop(grain, "profile", text="")
        return
    column = layout.column(align=True)
    column.label(text="Profile")
    column.menu(**menu)


class MESOGRAIN_PT_light(MesograinPanel, bpy.types.Panel):
    bl_label = "Light"
    bl_context = "data"
    about = "light"

    def draw(self, context):
        layout, light = self.layout, context.light
        arrange(layout, context)
        layout.use_property_decorate = True
        layout.prop(light, "type")
        if hasattr(light, "use_temperature"):
            row = layout.row(heading="Temperature" if layout.use_property_split else "")
            row.prop(light, "use_temperature", text="")
            number = row.row()
            number.active = light.use_temperature
            number.prop(light, "temperature", text="" if layout.use_property_split else "Temperature")
        layout.prop(light, "color")
        layout.prop(light, "energy", text="Irradiance" if light.type == "SUN" else "Power")
        for name in ("exposure", "normalize"):
            if hasattr(light, name):
                layout.prop(light, name)
        for name, text in LIGHT_PROPERTIES[light.type].items():
            if hasattr(light, name):
                layout.prop(light, name, **({"text": text} if text else {}))
        if light.type == "AREA" and light.shape in ("RECTANGLE", "ELLIPSE"):
            layout.prop(light, "size_y")


LIGHT_PROPERTIES = {
    "SUN": {"angle": ""},
    "POINT": {"shadow_soft_size": "Radius", "use_soft_falloff": ""},
    "SPOT": {"shadow_soft_size": "Radius", "use_soft_falloff": "", "spot_size": "Beam", "spot_blend": "Blend"},
    "AREA": {"shape": "", "size": "", "spread": ""},
}
"""What a light has beside its colour and strength, where this Blender has it, and what it is called if not as there."""


BUDGET = {budgets.SAMPLES: ("samples", "Samples"), budgets.ERROR: ("budget_error", "Error"),
          budgets.TIME: ("budget_seconds", "Time, s")}
"""The property by which each is told, and what it is called."""


class MESOGRAIN_PT_sampling(MesograinPanel, bpy.types.Panel):
    bl_label = "Sampling"
    bl_context = "render"

    def draw(self, context):
        layout, settings = self.layout, context.scene.mesograin
        arrange(layout, context)
        layout.use_property_decorate = True
        if not draw_native_problem(layout, context):
            draw_complaints(layout, context)
        column = layout.column(align=True)
        column.prop(settings, "budget")
        name, text = BUDGET[settings.budget]
        column.prop(settings, name, text=text)
        column.prop(settings, "viewport_samples", text="Viewport")
        layout.prop(settings, "millimetres_per_unit", text="Unit, mm")
        choose(layout, settings, "exchange", "Exchange")
        layout.prop(settings, "denoise")
        layout.column(heading="Film").prop(context.scene.render, "film_transparent", text="Transparent")


class MESOGRAIN_PT_motion_blur(MesograinPanel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        layout, render = self.layout, context.scene.render
        arrange(layout, context)
        layout.active = render.use_motion_blur
        owner = compat.owner_of_motion_blur_position(context.scene)
        if owner is not None:
            choose(layout, owner, "motion_blur_position", "Position")
        layout.prop(render, "motion_blur_shutter", text="Shutter")
        layout.template_curve_mapping(render, "motion_blur_shutter_curve")


class MESOGRAIN_PT_passes(MesograinPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        layout = self.layout
        arrange(layout, context)
        column = layout.column(heading="Data")
        for one in (*passes.SURFACES, *passes.INDICES):
            column.prop(context.view_layer, one.asked_for, text=one.shown)
        cycles = getattr(context.view_layer, "cycles", None)
        if cycles is not None:  # which Cycles keeps, where it is enabled
            column.prop(cycles, passes.SAMPLE_COUNT.asked_for.split(".")[1], text=passes.SAMPLE_COUNT.shown)
            column.prop(cycles, passes.DENOISING_ALBEDO.asked_for.split(".")[1], text="Denoising Data")
        column = layout.column(heading="Light")
        for one in passes.PORTIONS.values():
            *owner, name = one.asked_for.split(".")
            column.prop(context.view_layer.mesograin if owner else context.view_layer, name, text=one.shown)
        column = layout.column(heading="Cryptomatte")
        for matte in passes.MATTES:
            column.prop(context.view_layer, matte.asked_for, text=matte.label)
        layout.prop(context.view_layer, "pass_cryptomatte_depth", text="Levels")


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
                self._draw_picture(context, title, latest)

    def _draw_device(self, context):
        native = native_module.get()
        try:
            info = native.device_info()
        except native.Error as error:
            draw_sentence(self.layout, context, str(error))
            return
        kind = "hardware" if info["hardware"] else "software"
        draw_sentence(self.layout, context, f"{info['renderer']} ({kind}), OpenGL {info['version']}", icon="DESKTOP")

    def _draw_picture(self, context, title, latest):
        column = self.layout.column(align=True)
        samples = "1 sample" if latest.samples == 1 else f"{latest.samples} samples"
        draw_sentence(column, context, f"{title}: {latest.width} x {latest.height}, {samples}", icon="NONE")
        for name, milliseconds in latest.passes:
            column.label(text=f"{name.replace('_', ' ')}: {milliseconds:.2f} ms", icon="BLANK1")
        if latest.budget:
            draw_sentence(column, context, f"{latest.budget}.", icon="BLANK1")
        if latest.exchange:
            for line in latest.exchange.lines():
                draw_sentence(column, context, line, icon="BLANK1")
            draw_sentence(column, context, f"Light between grains: {latest.exchange.stated_error}.", icon="BLANK1")


register, unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_MT_profiles, MESOGRAIN_PT_material, MESOGRAIN_PT_light, MESOGRAIN_PT_sampling, MESOGRAIN_PT_motion_blur,
     MESOGRAIN_PT_passes, MESOGRAIN_PT_statistics))
