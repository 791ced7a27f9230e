# Grains of many colours: what of a material differs from one instance to the next.
import dataclasses

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, PointerProperty

from .. import compat
from . import node_colours


@dataclasses.dataclass(frozen=True)
class Variation:
    """ranges: (parameter, factors at one end, factors at the other end), 3 numbers each."""

    ranges: tuple

    def factors(self, randoms):
        """(parameter, bytes of (n, 3) float32) pairs for (n,) numbers from 0 to 1."""
        along = randoms[:, None]
        return tuple((name, ((1.0 - along) * np.float32(low) + along * np.float32(high)).astype(np.float32).tobytes())
                     for name, low, high in self.ranges)


@dataclasses.dataclass(frozen=True)
class NodeVariation:
    """What nodes make of each instance. parameter: which is multiplied; socket: a linked colour input, which outlives
    no reading; own_colour: of the object that is instanced."""

    parameter: str
    socket: object
    own_colour: tuple

    def factors(self, randoms):
        """As Variation's."""
        places = node_colours.Places(node_colours.of_instances(randoms, self.own_colour))
        found = np.clip(node_colours.colour(self.socket, places), 0.0, 100.0).astype(np.float32)
        return ((self.parameter, found.tobytes()),)


def _colour_of_surface(material):
    """The colour input of a material's surface that differs between instances, or None."""
    output = material.node_tree.get_output_node("CYCLES") if compat.uses_nodes(material) else None
    link = output and node_colours.feeding(output.inputs["Surface"])
    for name in ("Base Color", "Color"):
        socket = link and link.from_node.inputs.get(name)
        if socket is not None and socket.is_linked and node_colours.by_instance(socket):
            return socket
    return None


def read(material, parameters, own_colour):
    """Variation or NodeVariation of a bpy.types.Material whose model takes these parameters, or None if it has none.
    own_colour: of the object that wears it."""
    settings = material.mesograin_colours
    if not settings.vary:
        return None
    colour = "sigma_a" if "sigma_a" in parameters else "reflectance"
    if settings.source == "NODES":
        socket = _colour_of_surface(material)
        return None if socket is None else NodeVariation(colour, socket, own_colour)
    ranges = [(colour, tuple(settings.colour_from), tuple(settings.colour_to))]
    if "sigma_s" in parameters:
        ranges.append(("sigma_s", (settings.scattering_from,) * 3, (settings.scattering_to,) * 3))
    ranges = tuple(each for each in ranges if each[1:] != ((1.0,) * 3,) * 2)
    return Variation(ranges) if ranges else None


def _tag(properties, _context):
    properties.id_data.update_tag()


_COLOUR = {"size": 3, "min": 0.0, "max": 100.0, "soft_max": 3.0, "update": _tag}
_SCATTERING = {"min": 0.0, "max": 100.0, "soft_max": 3.0, "update": _tag}


class ColourProperties(bpy.types.PropertyGroup):
    """`material.mesograin_colours`: the range in which instances of a heap lie, evenly and at random."""

    vary: BoolProperty(name="Vary Grains", default=False, update=_tag,
                       description="Give each of many instances a colour of its own; sand is never of one colour")
    source: EnumProperty(name="Source", default="RANGE", update=_tag, items=(
        ("RANGE", "Range", "Evenly and at random between two ends"),
        ("NODES", "Nodes", "What the colour of the material's Cycles surface is for each: Object Info's Random along a "
                           "Color Ramp, or its Color"),
    ), description="What absorption, or an opaque grain's reflectance, is multiplied by")
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
    bpy.types.Material.mesograin_colours = PointerProperty(type=ColourProperties)


def unregister():
    del bpy.types.Material.mesograin_colours
    bpy.utils.unregister_class(ColourProperties)
