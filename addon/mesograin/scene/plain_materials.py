# Materials that are no grains: what their nodes say, as far as a Lambertian surface or a rough conductor can.
from .. import compat

PLAIN, METAL = "lambert", "conductor"


def is_plain(material):
    """Whether nothing of Mesograin was ever chosen for a bpy.types.Material."""
    return not any(material.mesograin.is_property_set(name) for name in type(material.mesograin).__annotations__)


def read(material):
    """({parameter: value}, sentences about what is left out) of a material for which `is_plain` holds."""
    if not compat.uses_nodes(material):
        return _lambert(material.diffuse_color), ()
    output = material.node_tree.get_output_node("CYCLES")
    links = output.inputs["Surface"].links if output else ()
    if not links:
        return _lambert((0.0, 0.0, 0.0)), ()
    found, left_out = _read_node(material, links[0].from_node)
    if not left_out:
        return found, ()
    return found, (f"Material '{material.name}' is no grain and is drawn as {_what(found)}; left out: "
                   f"{', '.join(dict.fromkeys(left_out))}.",)


def _what(found):
    return "a rough conductor" if found["model"] == METAL else "a Lambertian surface"


def _lambert(colour):
    return {"model": PLAIN, "reflectance": _reflectance(colour)}


def _conductor(colour, roughness):
    # Cycles' roughness is the square root of the GGX alpha.
    return {"model": METAL, "reflectance": _reflectance(colour), "roughness": min(max(roughness, 0.0), 1.0) ** 2}


def _reflectance(colour):
    return tuple(min(max(channel, 0.0), 1.0) for channel in colour[:3])


def _read_node(material, node):
    """({parameter: value}, what is left out)."""
    if node.type == "BSDF_DIFFUSE":
        return _read_diffuse(material, node)
    if node.type == "BSDF_PRINCIPLED":
        return _read_principled(material, node)
    if node.type in ("BSDF_GLOSSY", "BSDF_ANISOTROPIC"):
        left_out = []
        colour = _colour(material, node.inputs["Color"], left_out)
        return _conductor(colour, _number(node.inputs["Roughness"], left_out)), left_out
    if node.type == "EMISSION":
        left_out = ["its emission"]
        return _lambert(_colour(material, node.inputs["Color"], left_out)), left_out
    if node.type == "MIX_SHADER":
        return _read_mix(material, node)
    return _lambert(material.diffuse_color), [f"the node '{node.name}', for which its viewport colour stands"]


def _read_diffuse(material, node):
    left_out = []
    colour = _colour(material, node.inputs["Color"], left_out)
    if _number(node.inputs["Roughness"], left_out) > 0.0:
        left_out.append("its roughness")
    return _lambert(colour), left_out


def _read_principled(material, node):
    left_out = []
    colour = _colour(material, node.inputs["Base Color"], left_out)
    metallic = _number(node.inputs["Metallic"], left_out)
    if metallic >= 0.5:
        if metallic < 1.0:
            left_out.append("what of it is not metallic")
        return _conductor(colour, _number(node.inputs["Roughness"], left_out)), left_out
    left_out.append("its reflection")
    # The sockets' names before and after Blender 4.0.
    for names, what in ((("Transmission", "Transmission Weight"), "its transmission"),
                        (("Subsurface", "Subsurface Weight"), "its subsurface scattering")):
        socket = next((node.inputs[name] for name in names if name in node.inputs), None)
        if socket is not None and (socket.is_linked or socket.default_value > 0.0):
            left_out.append(what)
    return _lambert(colour), left_out


def _read_mix(material, node):
    left_out = []
    share = _number(node.inputs[0], left_out)
    chosen = node.inputs[2 if share > 0.5 else 1]
    left_out.append("the lesser part of its mix")
    if not chosen.is_linked:
        return _lambert(material.diffuse_color), left_out
    found, more = _read_node(material, chosen.links[0].from_node)
    return found, left_out + more


def _colour(material, socket, left_out):
    if not socket.is_linked:
        return socket.default_value
    source = socket.links[0]
    if source.from_node.type == "RGB":
        return source.from_socket.default_value
    left_out.append(f"the texture of its {socket.name.lower()}, for which its viewport colour stands")
    return material.diffuse_color


def _number(socket, left_out):
    if not socket.is_linked:
        return socket.default_value
    source = socket.links[0]
    if source.from_node.type == "VALUE":
        return source.from_socket.default_value
    left_out.append(f"the texture of its {socket.name.lower()}")
    return socket.default_value
