# Grains of many colours: what of a material differs from one instance to the next.
#
# What is known of n instances comes as {name: numbers}: "random", (n,) from 0 to 1, where a variation is at_random, and
# by its key each attribute of instancers that was asked for, (n, 4).
import dataclasses

import bpy
import numpy as np
from bpy.props import (BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, PointerProperty,
                       StringProperty)

from .. import compat
from . import instance_attributes, node_colours
from .properties import OVERRIDABLE


@dataclasses.dataclass(frozen=True)
class Variation:
    """ranges: (parameter, factors at one end, factors at the other end), 3 numbers each."""

    ranges: tuple
    at_random = True
    of_bodies = True  # each grain of an object of many has its own; what nodes and attributes tell is the object's
    attributes = frozenset()

    def factors(self, each):
        """(parameter, bytes of (n, 3) float32) pairs of n instances."""
        along = each["random"][:, None]
        return tuple((name, ((1.0 - along) * np.float32(low) + along * np.float32(high)).astype(np.float32).tobytes())
                     for name, low, high in self.ranges)


@dataclasses.dataclass(frozen=True)
class NodeVariation:
    """What nodes make of each instance. parameter: which is multiplied; socket: a linked colour input, which outlives
    no reading; own: node_colours.of_object's of what is instanced."""

    parameter: str
    socket: object
    own: dict
    at_random = True
    of_bodies = False

    @property
    def attributes(self):
        """Names of the attributes of instancers that it asks for."""
        return frozenset(name for kind, name in node_colours.attributes(self.socket) if kind == "INSTANCER")

    def factors(self, each):
        """As Variation's."""
        places = node_colours.Places(node_colours.of_instances(each, self.own))
        found = np.clip(node_colours.colour(self.socket, places), 0.0, 100.0).astype(np.float32)
        return ((self.parameter, found.tobytes()),)


@dataclasses.dataclass(frozen=True)
class AttributeVariation:
    """Attributes of instancers. names: (parameter, name) pairs."""

    names: tuple
    at_random = False
    of_bodies = False

    @property
    def attributes(self):
        """As NodeVariation's."""
        return frozenset(name for _, name in self.names)

    def factors(self, each):
        """As Variation's."""
        found = ((parameter, each[instance_attributes.key("INSTANCER", name)]) for parameter, name in self.names)
        return tuple((parameter, np.clip(values[:, :3], 0.0, 100.0).astype(np.float32).tobytes())
                     for parameter, values in found)


def _colour_of_surface(material):
    """The colour input of a material's surface that differs between instances, or None."""
    output = material.node_tree.get_output_node("CYCLES") if compat.uses_nodes(material) else None
    link = output and node_colours.feeding(output.inputs["Surface"])
    for name in ("Base Color", "Color"):
        socket = link and link.from_node.inputs.get(name)
        if socket is not None and socket.is_linked and node_colours.by_instance(socket):
            return socket
    return None


def read(material, parameters, own):
    """What varies of a bpy.types.Material whose model takes these parameters, or None. own: node_colours.of_object's of
    what wears it."""
    settings = material.mesograin_colours
    if not settings.vary:
        return None
    colour = "sigma_a" if "sigma_a" in parameters else "reflectance"
    if settings.source == "NODES":
        socket = _colour_of_surface(material)
        return None if socket is None else NodeVariation(colour, socket, node_colours.complete(own, socket))
    if settings.source == "ATTRIBUTE":
        names = ((colour, settings.colour_attribute), ("sigma_s", settings.scattering_attribute))
        names = tuple((parameter, name) for parameter, name in names if name and parameter in parameters)
        return AttributeVariation(names) if names else None
    ranges = [(colour, tuple(settings.colour_from), tuple(settings.colour_to))]
    if "sigma_s" in parameters:
        ranges.append(("sigma_s", (settings.scattering_from,) * 3, (settings.scattering_to,) * 3))
    ranges = tuple(each for each in ranges if each[1:] != ((1.0,) * 3,) * 2)
    return Variation(ranges) if ranges else None


def _tag(properties, _context):
    properties.id_data.update_tag()


_COMMON = {"update": _tag, "override": OVERRIDABLE}
_COLOUR = {"size": 3, "min": 0.0, "max": 100.0, "soft_max": 3.0, **_COMMON}
_SCATTERING = {"min": 0.0, "max": 100.0, "soft_max": 3.0, **_COMMON}


class ColourProperties(bpy.types.PropertyGroup):
    """`material.mesograin_colours`: the range in which instances of a heap lie, evenly and at random."""

    vary: BoolProperty(name="Vary Grains", default=False, **_COMMON,
                       description="Give each of many instances, or of the grains of one object, a colour of its own; "
                                   "sand is never of one colour")
    source: EnumProperty(name="Source", default="RANGE", **_COMMON, items=(
        ("RANGE", "Range", "Evenly and at random between two ends"),
        ("NODES", "Nodes", "What the colour of the material's Cycles surface is for each: Object Info's Random along a "
                           "Color Ramp, or its Color, or an Attribute of its instancer"),
        ("ATTRIBUTE", "Attribute", "What geometry nodes stored by a name on each instance, or a property of that name "
                                   "of the instancer"),
    ), description="What absorption, or an opaque grain's reflectance, is multiplied by")
    colour_attribute: StringProperty(name="Absorption", default="", **_COMMON,
                                     description="The attribute of an instance, a number or a colour, by which "
                                                 "sigma_a, or an opaque grain's reflectance, is multiplied")
    scattering_attribute: StringProperty(name="Scattering", default="", **_COMMON,
                                         description="The attribute of an instance by which sigma_s is "
                                                     "multiplied")
    colour_from: FloatVectorProperty(name="Absorption From", default=(0.5, 0.5, 0.5), **_COLOUR,
                                     description="By what sigma_a, or an opaque grain's reflectance, is multiplied at "
                                                 "one end of the range: below 1 a translucent grain is clearer")
    colour_to: FloatVectorProperty(name="Absorption To", default=(1.5, 1.5, 1.5), **_COLOUR,
                                   description="By what it is multiplied at the other end")
    scattering_from: FloatProperty(name="Scattering From", default=1.0, **_SCATTERING,
                                   description="By what sigma_s is multiplied at one end of the range")
    scattering_to: FloatProperty(name="Scattering To", default=1.0, **_SCATTERING,
                                 description="By what it is multiplied at the other end")


def register():
    bpy.utils.register_class(ColourProperties)
    bpy.types.Material.mesograin_colours = PointerProperty(type=ColourProperties, override=OVERRIDABLE)


def unregister():
    del bpy.types.Material.mesograin_colours
    bpy.utils.unregister_class(ColourProperties)
