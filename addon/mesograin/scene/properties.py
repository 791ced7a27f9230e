# What a file remembers: the grain of each material and the render settings of each scene.
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, PointerProperty

from .. import compat
from ..schema import models, parameters
from . import budgets

MATERIAL_PARAMETERS = tuple(parameters.PARAMETERS)


OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}
"""What a library override may change: Blender drops what is changed of any other property when it opens the file."""
AUTO_NUMBER = 1000
"""Of the model in a file: beyond those of all models that may come."""


def choices(name):
    """The items of a choice. Numbered as the schema has them, so that files keep their meaning when one is added."""
    known = (parameters.PARAMETERS | parameters.SCENE)[name].choices
    return tuple((choice.name, choice.label, choice.sentence,
                  AUTO_NUMBER if (name, choice.name) == ("model", models.AUTO.name) else number)
                 for number, choice in enumerate(known))


# Blender tags nothing when a script sets a value of ours; an update function does, and redraws follow.
def _tag(properties, _context):
    datablock = properties.id_data
    datablock.update_tag()
    if isinstance(datablock, bpy.types.Material):
        compat.redraw_preview(datablock)


def _property(parameter):
    """The Blender property of a parameter of the schema."""
    common = {"name": parameter.label, "default": parameter.default, "description": parameter.describe("mm"),
              "update": _tag, "override": OVERRIDABLE}
    if parameter.kind == "switch":
        return BoolProperty(**common)
    if parameter.kind == "choice":
        return EnumProperty(items=choices(parameter.name), **common)
    limits = {"min": parameter.least, "max": parameter.most, "precision": parameter.precision}
    for name, value in (("soft_min", parameter.soft_least), ("soft_max", parameter.soft_most)):
        if value is not None:
            limits[name] = value
    if parameter.kind == "rgb":
        # What is a share of the light is a colour; coefficients have no end.
        return FloatVectorProperty(size=3, subtype="NONE" if parameter.unit else "COLOR", **limits, **common)
    return FloatProperty(**limits, **common)


class MaterialProperties(bpy.types.PropertyGroup):
    """`material.mesograin`: one grain material, in the units and names of the native module but for 1/mm."""

    __annotations__ = {name: _property(parameter) for name, parameter in parameters.PARAMETERS.items()}


class SceneProperties(bpy.types.PropertyGroup):
    """`scene.mesograin`: how finely to render, until when, and how long a Blender unit is."""

    samples: IntProperty(name="Render samples", default=64, min=1, max=1 << 20, soft_max=4096, update=_tag,
                         description="Samples of each pixel in a final render")
    budget: EnumProperty(name="Until", items=budgets.CHOICES, default=budgets.SAMPLES, update=_tag,
                         description="When a final render ends")
    budget_error: FloatProperty(
        name="Error", subtype="PERCENTAGE", default=3.0, min=0.01, max=100.0, soft_min=0.5, soft_max=20.0, precision=2,
        update=_tag,
        description="What a pixel may be off by noise on average, and models and light between grains where that was "
                    "measured, of its light")
    budget_seconds: FloatProperty(
        name="Time, s", default=10.0, min=0.1, max=1e6, soft_max=3600.0, precision=1, update=_tag,
        description="From the start of a final render; one sample is always drawn")
    viewport_samples: IntProperty(name="Viewport samples", default=64, min=1, max=1 << 20, soft_max=4096, update=_tag,
                                  description="Samples of each pixel after which the viewport rests")
    millimetres_per_unit: FloatProperty(
        name="Millimetres per unit", default=1.0, min=1e-6, max=1e9, soft_min=0.001, soft_max=1000.0, precision=4,
        update=_tag, description="Length of one Blender unit in mm; coefficients in 1/mm are multiplied by it")
    exchange: _property(parameters.SCENE["exchange"])
    denoise: _property(parameters.SCENE["denoise"])


PORTIONS = {
    "diffuse": "What lights do on surfaces that are no grains, once",
    "specular": "What surfaces of facets mirror of lights and the world: highlights, coats and metal",
    "subsurface": "What lights do in grains, scattered many times; all orders where a model does not tell them apart",
    "single_scattering": "What lights do in grains, scattered once, where a model tells it apart",
    "transmission": "The world seen through clear grains",
    "exchange": "What grains and walls send each other",
}
"""Of a picture's light, that Blender has no pass of its own for; as the native module names them."""


def _portion(name, sentence):
    return BoolProperty(name=name.replace("_", " ").title(), default=False, update=_tag,
                        description=f"Deliver a pass of its own: {sentence[0].lower()}{sentence[1:]}")


class ViewLayerProperties(bpy.types.PropertyGroup):
    """`view_layer.mesograin`: which portions of a picture's light are passes of a final render."""

    # A view layer is no datablock: it is the scene that changes.
    __annotations__ = {f"use_pass_{name}": _portion(name, sentence) for name, sentence in PORTIONS.items()}


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (MaterialProperties, SceneProperties, ViewLayerProperties))


def register():
    _register_classes()
    bpy.types.Material.mesograin = PointerProperty(type=MaterialProperties, override=OVERRIDABLE)
    bpy.types.Scene.mesograin = PointerProperty(type=SceneProperties)
    bpy.types.ViewLayer.mesograin = PointerProperty(type=ViewLayerProperties)


def unregister():
    del bpy.types.ViewLayer.mesograin
    del bpy.types.Scene.mesograin
    del bpy.types.Material.mesograin
    _unregister_classes()
