# The grain that a Cycles material is: its medium and boundary, read from volume, Subsurface or Principled nodes.
"""The other way from `recipes`: what those write is read back as it was, and of what artists build, as much as a grain
can be. See `read`."""

import math

import bpy

from .. import compat
from ..scene import node_colours
from ..schema import models
from . import inversion, nodes

GLASSY = ("BSDF_GLASS", "BSDF_REFRACTION")
WEIGHTS = ("Subsurface Weight", "Subsurface")
TRANSMISSION = ("Transmission Weight", "Transmission")
UNREAD = ((("Coat Weight", "Clearcoat"), 0.0, "coat"), (("Sheen Weight", "Sheen"), 0.0, "sheen"),
          (("Alpha",), 1.0, "transparency"), (TRANSMISSION, 0.0, "transmission"),
          (("Specular IOR Level", "Specular"), 0.5, "specular level"))
"""Of a Principled node over a walk: (names of a socket, the number that changes nothing, what it is)."""


class NoGrain(Exception):
    """Why a material is none; one sentence."""


def read(material):
    """({parameter: value} with coefficients per scene unit, [what is lost]) of a bpy.types.Material. Raises NoGrain."""
    if not compat.uses_nodes(material):
        raise NoGrain(f"Material '{material.name}' has no nodes: choose a preset instead.")
    output = material.node_tree.get_output_node("CYCLES")
    surface, volume = (_linked(output.inputs[name]) if output else None for name in ("Surface", "Volume"))
    lost = []
    if volume is not None:
        values = _medium(volume, lost)
        values.update(_boundary(surface and _of_mix(surface, _lets_in, lost), lost))
    else:
        walk = surface and _of_mix(surface, _walks, lost)
        if walk is None or not _walks(walk):
            raise NoGrain(f"Material '{material.name}' lets no light through: a grain needs a volume, a Subsurface "
                          "Scattering node or a Principled one with a subsurface weight.")
        values = (_subsurface if walk.type == "SUBSURFACE_SCATTERING" else _principled)(walk, lost)
    if output.inputs["Displacement"].is_linked:
        lost.append("its displacement")
    values.update(model=models.AUTO.name, scale=1.0)
    return values, list(dict.fromkeys(lost))


def _linked(socket):
    link = node_colours.feeding(socket)
    return link.from_node if link else None


def _parts(node, share, lost):
    """[(share, node)] of what a shader is mixed and added of, at the ends of the tree; what has no share is none."""
    if node.type not in ("MIX_SHADER", "ADD_SHADER"):
        return [(share, node)] if share > 0.0 else []
    shares = (share, share)
    if node.type == "MIX_SHADER":
        second = min(max(_value(node, node.inputs[0].name, lost), 0.0), 1.0)
        shares = (share * (1.0 - second), share * second)
    fed = zip(shares, map(_linked, node.inputs[-2:]))
    return [part for each, source in fed if source is not None for part in _parts(source, each, lost)]


def _of_mix(surface, serves, lost):
    """Of what a surface is mixed of, the node with the greatest share of those that serve: what is beside it is lost.
    The surface itself where none does."""
    parts = _parts(surface, 1.0, lost)
    found = max((part for part in parts if serves(part[1])), key=lambda part: part[0], default=None)
    if found is None:
        return surface
    lost += [f"'{node.name}' beside it" if share == 1.0 else f"the {share:.0%} of '{node.name}' beside it"
             for share, node in parts if node != found[1]]
    return found[1]


def _walks(node):
    """Whether Cycles walks below the surface of it."""
    return node.type == "SUBSURFACE_SCATTERING" or (node.type == "BSDF_PRINCIPLED" and _weight(node, WEIGHTS, []) > 0.0)


def _lets_in(node):
    """Whether light goes through it into a volume."""
    return node.type in GLASSY or (node.type == "BSDF_PRINCIPLED" and _weight(node, TRANSMISSION, []) > 0.0)


def _value(node, name, lost):
    """A socket's number or its three numbers; what is linked is lost but for plain values."""
    # Blender 5 finds no socket by name that the node does not show, such as the IOR of Christensen and Burley's.
    socket = next(each for each in node.inputs if each.name == name)
    source = _linked(socket)
    if source is not None and source.type in ("RGB", "VALUE"):
        socket = source.outputs[0]
    elif source is not None:
        lost.append(f"what is linked to {name} of '{node.name}'")
    value = socket.default_value
    return tuple(value[:3]) if hasattr(value, "__len__") else float(value)


def _weight(node, names, lost):
    return next((_value(node, name, lost) for name in names if name in node.inputs), 0.0)


def _medium(node, lost):
    """sigma_a, sigma_s and g of volume shaders and their sums; g is the mean by scattering."""
    sigma_a, sigma_s, turned = _volume(node, lost)
    total = sum(sigma_s)
    return {"sigma_a": sigma_a, "sigma_s": sigma_s, "g": turned / total if total > 0.0 else 0.0}


def _volume(node, lost):
    """(sigma_a, sigma_s, sum over the channels of g sigma_s)."""
    if node.type in ("MIX_SHADER", "ADD_SHADER"):  # media are there together, each as thin as its share
        parts = [(share, *_volume(part, lost)) for share, part in _parts(node, 1.0, lost)]
        absorbed, scattered = (tuple(math.fsum(part[0] * part[side][channel] for part in parts) for channel in range(3))
                               for side in (1, 2))
        return absorbed, scattered, math.fsum(part[0] * part[3] for part in parts)
    if node.type == "VOLUME_COEFFICIENTS":
        return _coefficients(node, lost)
    if node.type not in ("VOLUME_SCATTER", "VOLUME_ABSORPTION", "PRINCIPLED_VOLUME"):
        raise NoGrain(f"The node '{node.name}' is no medium that a grain can have: use Volume Scatter and Volume"
                      " Absorption.")
    colour, density = _value(node, "Color", lost), _value(node, "Density", lost)
    scattered = tuple(density * channel for channel in colour)
    rest = tuple(density * max(1.0 - channel, 0.0) for channel in colour)
    if node.type == "VOLUME_ABSORPTION":
        return rest, (0.0, 0.0, 0.0), 0.0
    g = _phase(node, lost)
    if node.type == "VOLUME_SCATTER":
        return (0.0, 0.0, 0.0), scattered, g * sum(scattered)
    # Cycles' Principled Volume absorbs (1 - colour) (1 - sqrt(absorption colour)) of its density.
    absorbed = tuple(channel * max(1.0 - math.sqrt(max(tint, 0.0)), 0.0)
                     for channel, tint in zip(rest, _value(node, "Absorption Color", lost)))
    if _value(node, "Emission Strength", lost) > 0.0 or _value(node, "Blackbody Intensity", lost) > 0.0:
        lost.append(f"the emission of '{node.name}'")
    return absorbed, scattered, g * sum(scattered)


def _coefficients(node, lost):
    """As _volume, of the node that says them as they are."""
    absorbed, scattered, emitted = (tuple(max(channel, 0.0) for channel in _value(node, f"{name} Coefficients", lost))
                                    for name in ("Absorption", "Scatter", "Emission"))
    if any(emitted):
        lost.append(f"the emission of '{node.name}'")
    return absorbed, scattered, _phase(node, lost) * sum(scattered)


def _phase(node, lost):
    """g."""
    if getattr(node, "phase", "HENYEY_GREENSTEIN") != "HENYEY_GREENSTEIN":
        lost.append(f"the phase function of '{node.name}', for which Henyey and Greenstein's stands")
    return _value(node, "Anisotropy", lost)


def _boundary(surface, lost):
    """What light meets before it is in a volume."""
    if surface is None:
        return {"boundary": "index_matched"}
    if not _lets_in(surface):
        raise NoGrain(f"The node '{surface.name}' lets no light into the volume: use Glass, or no surface at all.")
    if surface.type == "BSDF_REFRACTION":
        lost.append(f"that '{surface.name}' reflects nothing")
    if min(_value(surface, "Color" if surface.type in GLASSY else "Base Color", lost)) < 1.0:
        lost.append(f"the colour of '{surface.name}'")
    return {"boundary": "dielectric", "eta": _value(surface, "IOR", lost),
            "roughness": _value(surface, "Roughness", lost) ** 2}  # GGX's alpha


def _subsurface(node, lost):
    g = _value(node, "Anisotropy", lost) if node.falloff != "BURLEY" else 0.0
    eta = _value(node, "IOR", lost)
    values = _walk(_value(node, "Color", lost), _radii(node, "Radius", "Scale", lost), node.falloff, g, eta)
    refracts = nodes.features().subsurface_refracts and node.falloff != "BURLEY"
    values.update(boundary="lambert_refracted" if refracts else "lambert_lambert", eta=eta)
    # GGX's alpha itself, unlike the other nodes' roughness.
    values["roughness"] = _value(node, "Roughness", lost) if refracts else 0.0
    return values


def _principled(node, lost):
    weight = _weight(node, WEIGHTS, lost)
    if weight < 1.0:
        lost.append(f"the {1.0 - weight:.0%} of '{node.name}' that is not subsurface scattering")
    own = "Subsurface Color" in node.inputs  # up to Blender 3, where the radius has no scale but the weight
    colour = _value(node, "Subsurface Color" if own else "Base Color", lost)
    if own:
        radii = tuple(weight * radius for radius in _value(node, "Subsurface Radius", lost))
    else:
        radii = _radii(node, "Subsurface Radius", "Subsurface Scale", lost)
    if _value(node, "Metallic", lost) > 0.0:
        lost.append(f"the metal of '{node.name}'")
    _lose_rest(node, lost)
    g = _value(node, "Subsurface Anisotropy", lost)
    method = node.subsurface_method
    eta = _value(node, "IOR", lost)
    values = _walk(colour, radii, method, 0.0 if method == "BURLEY" else g, eta)
    values.update(boundary="dielectric", eta=eta, roughness=_value(node, "Roughness", lost) ** 2)
    return values


def _lose_rest(node, lost):
    """What a Principled node does beside the walk."""
    lost += [f"the {what} of '{node.name}'" for names, none, what in UNREAD
             for socket in node.inputs if socket.name in names and (socket.is_linked or socket.default_value != none)]
    colour = next(socket for socket in node.inputs if socket.name in ("Emission Color", "Emission"))
    strength = node.inputs["Emission Strength"]
    shines = colour.is_linked or max(tuple(colour.default_value)[:3]) > 0.0
    if shines and (strength.is_linked or strength.default_value > 0.0):
        lost.append(f"the emission of '{node.name}'")
    if node.inputs["Normal"].is_linked:
        lost.append(f"the bumps of '{node.name}'")


def _radii(node, radius, scale, lost):
    factor = _value(node, scale, lost)
    return tuple(factor * channel for channel in _value(node, radius, lost))


def _walk(colour, radii, method, g, eta):
    """The medium that Cycles walks in for a colour and radii: `inversion`, backwards."""
    g = min(max(g, 0.0), inversion.ANISOTROPY_LIMIT)
    albedos = [inversion.single_scattering_albedo(min(max(channel, 0.0), 1.0), g) for channel in colour]
    rescales = method == "RANDOM_WALK_SKIN" or (method == "RANDOM_WALK" and "RANDOM_WALK_FIXED_RADIUS" in _methods())
    factors = [inversion.skin_radius_factor(channel, eta) if rescales else inversion.FIXED_RADIUS_FACTOR
               for channel in colour]
    extinctions = [factor / (max(radius, 1e-9) * (1.0 - g)) for factor, radius in zip(factors, radii)]
    return {"sigma_a": tuple((1.0 - albedo) * t for albedo, t in zip(albedos, extinctions)),
            "sigma_s": tuple(albedo * t for albedo, t in zip(albedos, extinctions)), "g": g}


def _methods():
    declared = bpy.types.ShaderNodeSubsurfaceScattering.bl_rna.properties["falloff"].enum_items
    return {item.identifier for item in declared}
