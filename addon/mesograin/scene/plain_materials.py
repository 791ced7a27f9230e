# Materials that are no grains: what their nodes say, as far as a diffuse surface, a coat, a rough conductor, clear
# glass and worn pictures can.
import dataclasses

from .. import compat
from ..schema import models, parameters
from . import node_colours, textures

PLAIN, METAL, GLASS = "lambert", "conductor", models.AUTO.name


@dataclasses.dataclass(frozen=True)
class FinishValues:
    """What a surface has beside its model's parameters. values: (name, number) pairs and maps: (name,
    textures.MapValues) pairs, as native.Finish has them."""

    values: tuple = ()
    maps: tuple = ()

    @property
    def radiance(self):
        """Linear RGB that it sends out, on average over its picture, or None."""
        own = dict(self.values).get("radiance")
        picture = dict(self.maps).get("emission")
        if own is None or picture is None:
            return own
        return tuple(channel * share for channel, share in zip(own, picture.mean))

    def to_native(self, native):
        return native.Finish(**dict(self.values), **{name: each.to_native(native) for name, each in self.maps})


class Reading:
    """What is found of one material. values: {parameter: value}; finish: FinishValues or None; sentences: about what is
    left out."""

    def __init__(self, material, box, own, side, mesh):
        self._material, self._box, self._own, self._side, self._mesh = material, box, own, side, mesh
        self.by_instance = None  # the input that says the reflectance of each of many instances; here it is 1
        self.tint = None  # linear RGB, of what crosses glass once
        self._numbers, self._maps, self._left_out = {}, {}, []
        self.values = {}

    @property
    def finish(self):
        if not self._numbers and not self._maps:
            return None
        return FinishValues(tuple(self._numbers.items()), tuple(self._maps.items()))

    @property
    def sentences(self):
        if not self._left_out:
            return ()
        return (f"Material '{self._material.name}' is no grain and is drawn as {self._what()}; left out: "
                f"{', '.join(dict.fromkeys(self._left_out))}.",)

    def _what(self):
        if self.values["model"] == METAL:
            return "a rough conductor"
        if self.values["model"] == GLASS:
            return "clear glass"
        return "a diffuse surface under a coat" if "coat" in self._numbers else "a Lambertian surface"

    def leave_out(self, what):
        self._left_out.append(what)

    def be_lambert(self, colour):
        self.values = {"model": PLAIN, "reflectance": _reflectance(colour)}

    def be_conductor(self, colour, roughness):
        # Cycles' roughness is the square root of the GGX alpha.
        self.values = {"model": METAL, "reflectance": _reflectance(colour), "masking": compat.facets_masking(),
                       "roughness": min(max(roughness, 0.0), 1.0) ** 2}

    def be_glass(self, eta, roughness, mirrors):
        """Which no light scatters in. mirrors: whether its surface also reflects what shines on it."""
        bounds = parameters.PARAMETERS["eta"]
        nothing = (0.0, 0.0, 0.0)
        self.values = {"model": GLASS, "boundary": "dielectric", "sigma_s": nothing, "sigma_a": nothing,
                       "eta": min(max(eta, bounds.least), bounds.most), "masking": compat.facets_masking(),
                       "roughness": min(max(roughness, 0.0), 1.0) ** 2, "specular": mirrors}

    def set(self, **numbers):
        self._numbers.update(numbers)

    def colour(self, socket, of="reflectance"):
        """Linear RGB of an input, the mean of its picture if it has one."""
        if not socket.is_linked:
            return socket.default_value
        found = self._map(socket, of, numbers=False)
        return self._material.diffuse_color if found is None else found

    def number(self, socket, of=None):
        """An input's number, the mean of its picture if the quantity `of` may have one."""
        if not socket.is_linked:
            return socket.default_value
        source = socket.links[0]
        if source.from_node.type == "VALUE":
            return source.from_socket.default_value
        found = self._map(socket, of, numbers=True) if of else None
        if found is not None:
            return found[0]
        if not of:
            self.leave_out(f"the texture of its {socket.name.lower()}")
        return socket.default_value

    def _map(self, socket, of, numbers):
        """The mean of an input's picture, which the quantity `of` gets, or None."""
        source = node_colours.feeding(socket)
        if source is None or source.from_node.type == "RGB":
            return source.from_socket.default_value if source else socket.default_value
        if node_colours.by_instance(socket):
            if self._own is not None:
                places = node_colours.Places(node_colours.complete(self._own, socket))
                found = node_colours.number(socket, places) if numbers else node_colours.colour(socket, places)[0]
                return found.tolist()
            if of == "reflectance":
                self.by_instance = socket
                return (1.0, 1.0, 1.0)
        try:
            found = textures.read(socket, self._box, numbers, self._side, self._mesh)
        except node_colours.Unknown as unknown:
            stands = "" if numbers else ", for which its viewport colour stands"
            self.leave_out(f"the texture of its {socket.name.lower()}{stands} ({unknown.reason})")
            return None
        self._maps[of] = found
        return found.mean

    def normal(self, node):
        """What bends a shader's normal."""
        socket = node.inputs.get("Normal")
        if socket is None or not socket.is_linked:
            return
        bending = node_colours.feeding(socket).from_node
        if bending.type != "NORMAL_MAP" or bending.space != "TANGENT":
            self.leave_out(f"the node '{bending.name}' at its normal")
            return
        told = self._map(bending.inputs["Color"], "normal", numbers=False)
        if "normal" not in self._maps and told is not None and not _is_straight(told):
            self._maps["normal"] = textures.constant(told)
        if "normal" in self._maps:
            self.set(normal_strength=self.number(bending.inputs["Strength"]), **compat.bumps())


def of_no_material():
    """({parameter: value}, FinishValues or None): what Cycles gives to what wears none."""
    values = {"model": PLAIN, "reflectance": (0.8, 0.8, 0.8)}
    if not compat.has_principled_default():
        return values, None
    # Of the node when it is new: an IOR of 1.5, seen straight on.
    finish = {"coat": 0.04, "coat_roughness": 0.5, "facets_keep_energy": True, **compat.principled_layers()}
    return {**values, "masking": compat.facets_masking()}, FinishValues(tuple(finish.items()))


def is_plain(material):
    """Whether nothing of Mesograin was ever chosen for a bpy.types.Material."""
    return not any(material.mesograin.is_property_set(name) for name in type(material.mesograin).__annotations__)


AVERAGE = node_colours.of_object(0.5, (1.0, 1.0, 1.0))
"""What an object has of its own where none is known."""


def read(material, box=textures.Box(), own=AVERAGE, side=textures.SIDE, mesh=None):
    """Reading of a material for which `is_plain` holds. box: textures.Box of what wears it; own: what that has of its
    own, as node_colours.of_object has it, or None if that are many instances; side: of what is painted, in texels;
    mesh: native.Mesh of what wears it."""
    found = Reading(material, box, own, side, mesh)
    if not compat.uses_nodes(material):
        found.be_lambert(material.diffuse_color)
        return found
    output = material.node_tree.get_output_node("CYCLES")
    _read_what_feeds(found, material, output and output.inputs["Surface"])
    if output and output.inputs["Displacement"].is_linked:
        found.leave_out("its displacement")
    if output and output.inputs["Volume"].is_linked:
        found.leave_out("its volume")
    return found


def without_surface(material):
    """What a plain material is where it has no surface that could be drawn, as a noun; None where it has one."""
    output = material.node_tree.get_output_node("CYCLES") if compat.uses_nodes(material) else None
    if output is None:
        return None
    link = node_colours.feeding(output.inputs["Surface"])
    if link is None:
        return "a volume without a surface" if output.inputs["Volume"].is_linked else None
    alpha = link.from_node.inputs.get("Alpha") if link.from_node.type == "BSDF_PRINCIPLED" else None
    unseen = alpha is not None and not alpha.is_linked and alpha.default_value == 0.0
    return "transparent" if unseen or link.from_node.type == "BSDF_TRANSPARENT" else None


def depends_on_place(material):
    """Whether what wears a plain material matters: its pictures may lie by place."""
    return compat.uses_nodes(material) and any(node.type.startswith("TEX_") for node in material.node_tree.nodes)


def depends_on_object(material):
    """Whether objects that wear a plain material may differ."""
    return compat.uses_nodes(material) and any(node.type in ("OBJECT_INFO", "ATTRIBUTE")
                                               for node in material.node_tree.nodes)


def attributes(material):
    """node_colours.attributes of all nodes of a plain material."""
    return node_colours.attributes_of(material.node_tree.nodes) if compat.uses_nodes(material) else frozenset()


def _reflectance(colour):
    return tuple(min(max(channel, 0.0), 1.0) for channel in colour[:3])


def _is_straight(told):
    """Whether a normal map's colour leaves the normal as it is, to within eight bits of it."""
    return all(abs(channel - 0.5) < 0.5 / 255.0 for channel in told[:2]) and told[2] > 0.5


def _read_node(found, material, node):
    if node.mute:
        _read_what_feeds(found, material, next((link.from_socket for link in node.internal_links), None))
        return
    if node.type in _READERS:
        _READERS[node.type](found, material, node)
        return
    found.be_lambert(material.diffuse_color)
    found.leave_out(f"the node '{node.name}', for which its viewport colour stands")


def _read_what_feeds(found, material, socket):
    """Of an input that shows a shader; without any it is black."""
    link = socket and node_colours.feeding(socket)
    if link is None:
        found.be_lambert((0.0, 0.0, 0.0))
    else:
        _read_node(found, material, link.from_node)


def _read_diffuse(found, _material, node):
    found.be_lambert(found.colour(node.inputs["Color"]))
    found.normal(node)
    roughness = min(max(found.number(node.inputs["Roughness"]), 0.0), 1.0)
    if roughness > 0.0:
        found.set(diffuse_roughness=roughness)
        if compat.rough_diffuse_keeps_energy():
            found.leave_out("what its roughness sends on after a second bounce")


def _read_glossy(found, _material, node):
    colour = found.colour(node.inputs["Color"])
    sharp = getattr(node, "distribution", "") == "SHARP"  # which has no roughness, whatever that socket says
    found.be_conductor(colour, 0.0 if sharp else found.number(node.inputs["Roughness"], "roughness"))
    if getattr(node, "distribution", "") in _OTHER_FACETS:
        found.leave_out(f"its distribution of facets {_OTHER_FACETS[node.distribution]}, for which GGX stands")
    found.set(**compat.facets(node))
    found.normal(node)


def _read_glass(found, _material, node):
    sharp = getattr(node, "distribution", "") == "SHARP"
    roughness = 0.0 if sharp else found.number(node.inputs["Roughness"])
    _be_clear(found, node, node.inputs["Color"], 2.0, roughness, mirrors=node.type == "BSDF_GLASS")


def _be_clear(found, node, colour, power, roughness, mirrors=True):
    """power: of the colour that is left of light which goes in and out."""
    found.be_glass(found.number(node.inputs["IOR"]), roughness, mirrors)
    if colour.is_linked:
        found.leave_out("the texture of its glass")
    elif min(colour.default_value[:3]) < 1.0:
        found.tint = tuple(min(max(channel, 0.0), 1.0) ** power for channel in colour.default_value[:3])
    if node.inputs["Normal"].is_linked:
        found.leave_out("what bends its normal")


_OTHER_FACETS = {"BECKMANN": "Beckmann", "ASHIKHMIN_SHIRLEY": "Ashikhmin-Shirley"}


def _read_emission(found, _material, node):
    found.be_lambert((0.0, 0.0, 0.0))
    _read_radiance(found, node.inputs["Color"], node.inputs["Strength"])


def _read_radiance(found, colour, strength):
    """What a surface sends out."""
    factor = found.number(strength)
    textured = node_colours.feeding(colour) is not None and node_colours.feeding(colour).from_node.type != "RGB"
    own = found.colour(colour, "emission")
    radiance = tuple(max(factor, 0.0) * (1.0 if textured else max(channel, 0.0)) for channel in own[:3])
    if any(radiance):
        found.set(radiance=radiance)


def _read_principled(found, _material, node):
    def socket(*names):
        """Of the first name that this Blender knows."""
        return next((node.inputs[name] for name in names if name in node.inputs), None)

    clear = _clear_share(socket)
    if clear > 0.5:
        _be_clear(found, node, node.inputs["Base Color"], compat.principled_tint_power(node),
                  found.number(node.inputs["Roughness"]))
        if clear < 1.0:
            found.leave_out("what of it is no glass")
        if _emission(socket) is not None:
            found.leave_out("its emission")
        unknown = _TRANSMISSION_ROUGHNESS, _THIN_WALL, *_LAYERS
    else:
        _read_opaque_principled(found, node, socket)
        unknown = _TRANSMISSION, _SUBSURFACE, *_LAYERS
    for names, what, none in unknown:
        each = socket(*names)
        if each is not None and (each.is_linked or each.default_value != none):
            found.leave_out(what)


_TRANSMISSION = (("Transmission Weight", "Transmission"), "its transmission", 0.0)
_TRANSMISSION_ROUGHNESS = (("Transmission Roughness",), "the roughness of its transmission", 0.0)
_THIN_WALL = (("Thin Wall",), "that its wall is thin", False)
_SUBSURFACE = (("Subsurface Weight", "Subsurface"), "its subsurface scattering", 0.0)
_LAYERS = ((("Coat Weight", "Clearcoat"), "its clear coat", 0.0), (("Sheen Weight", "Sheen"), "its sheen", 0.0),
           (("Alpha",), "its transparency", 1.0))


def _clear_share(socket):
    """Of the surface that is glass, as far as no texture says so."""
    transmission, metallic = socket(*_TRANSMISSION[0]), socket("Metallic")
    if transmission is None or transmission.is_linked or metallic.is_linked:
        return 0.0
    return transmission.default_value * (1.0 - metallic.default_value)


def _emission(socket):
    """The inputs of its colour and strength; None where it is none."""
    colour, strength = socket("Emission Color", "Emission"), socket("Emission Strength")
    if strength is None or not (strength.is_linked or strength.default_value > 0.0):
        return None
    return (colour, strength) if colour.is_linked or max(colour.default_value[:3]) > 0.0 else None


def _read_opaque_principled(found, node, socket):
    colour = found.colour(node.inputs["Base Color"])
    metallic = found.number(node.inputs["Metallic"], "metallic")
    roughness = found.number(node.inputs["Roughness"], "roughness")
    if metallic >= 1.0 and not node.inputs["Metallic"].is_linked:
        found.be_conductor(colour, roughness)
    else:
        found.be_lambert(colour)
        found.set(metallicity=metallic)
    coat = _straight_reflectance(found, socket)
    if coat > 0.0:
        found.set(coat=coat)
    found.set(coat_roughness=roughness, **compat.principled_layers(), **compat.facets(node))
    found.values["masking"] = compat.facets_masking()
    found.normal(node)
    if (emission := _emission(socket)) is not None:
        _read_radiance(found, *emission)


def _straight_reflectance(found, socket):
    """Of the surface over what is not metallic, seen straight on."""
    level = min(max(found.number(socket("Specular IOR Level", "Specular")), 0.0), 1.0)
    if socket("Specular IOR Level") is None:
        return 0.08 * level
    eta = found.number(socket("IOR"))
    return min(2.0 * level * ((eta - 1.0) / (eta + 1.0)) ** 2, 1.0)


def _read_mix(found, material, node):
    share = found.number(node.inputs[0])
    chosen = node.inputs[2 if share > 0.5 else 1]
    found.leave_out("the lesser part of its mix")
    link = node_colours.feeding(chosen)
    if link is None:
        found.be_lambert(material.diffuse_color)
    else:
        _read_node(found, material, link.from_node)


_READERS = {
    "BSDF_DIFFUSE": _read_diffuse, "BSDF_PRINCIPLED": _read_principled, "BSDF_GLOSSY": _read_glossy,
    "BSDF_ANISOTROPIC": _read_glossy, "BSDF_GLASS": _read_glass, "BSDF_REFRACTION": _read_glass,
    "EMISSION": _read_emission, "MIX_SHADER": _read_mix,
}
