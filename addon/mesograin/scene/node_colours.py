# What shader nodes make of places on a surface or of directions, for the nodes that NumPy can follow: Cycles' formulas.
import dataclasses

import bpy
import numpy as np

from . import blackbody, hue, images, instance_attributes


class Unknown(Exception):
    """A node that is not followed; its name."""

    @property
    def reason(self):
        """A clause."""
        return f"Mesograin knows no {self}"


class Lost(Unknown):
    """A picture that is not there; a clause on it."""

    @property
    def reason(self):
        return str(self)


def cannot_load(image):
    """Lost, to be raised."""
    return Lost(f"its image '{image.name}' cannot be loaded")


@dataclasses.dataclass
class Places:
    """Where nodes are asked, n places. coordinates: (n, 3) each, by name. used: which of them were. with_suns: skies
    show theirs. from_camera: whether a camera looks there; None where that is not asked."""

    coordinates: dict
    used: set = dataclasses.field(default_factory=set)
    with_suns: bool = False
    from_camera: object = None

    def get(self, name):
        if name not in self.coordinates:
            raise Unknown(name)
        self.used.add(name)
        return self.coordinates[name]

    @property
    def count(self):
        return len(next(iter(self.coordinates.values())))


def nowhere():
    """Places for nodes that are the same everywhere; Unknown is raised of all that ask where they are."""
    return Places({"nowhere": np.zeros((1, 3))})


LUMINANCE = np.array((0.2126, 0.7152, 0.0722))  # Rec. 709, of Blender's default configuration


def colour(socket, places):
    """(n, 3) of a colour input. Raises Unknown."""
    return _as_colour(_input(socket, places), places.count)


def number(socket, places):
    """(n,) of a number input."""
    return _as_number(_input(socket, places), places.count)


def vector(socket, places, default):
    """(n, 3) of a vector input; default: which coordinates an unlinked one is."""
    if socket is None or not socket.is_linked:
        return places.get(default)
    return _as_colour(_input(socket, places), places.count)


def _input(socket, places):
    """What comes into a socket: (n, 3), (n,), 3 numbers or one."""
    link = feeding(socket)
    if link is None:
        return _plain(socket.default_value)
    node = link.from_node
    if node.type not in NODES:
        raise Unknown(node.name)
    if node.mute:
        raise Unknown(node.name)
    return NODES[node.type](node, link.from_socket, places)


def feeding(socket):
    """The link that feeds a socket, past what only leads through."""
    while socket.is_linked:
        link = socket.links[0]
        if link.from_node.type != "REROUTE":
            return link
        socket = link.from_node.inputs[0]
    return None


def by_instance(socket):
    """Whether an input is the same on all of an object, but not for all objects."""
    places = Places(complete(of_object(0.5, (1.0, 1.0, 1.0)), socket))
    try:
        colour(socket, places)
    except Unknown:
        return False
    return bool(places.used)


def of_object(random, own_colour, attributes=()):
    """Coordinates of one object. random: Object Info's, 0 to 1; own_colour: its own; attributes: (name, RGBA) pairs."""
    return {"random": np.array((random,)), "object colour": np.array((own_colour[:3],)),
            **{name: np.array((value,)) for name, value in attributes}}


def of_instances(each, own):
    """Coordinates of the n instances of one object. each: {name: (n,) or (n, 4)}; own: of_object's."""
    count = len(each["random"])
    return {**{name: np.broadcast_to(value, (count, *value.shape[1:])) for name, value in own.items()}, **each}


def attributes(socket):
    """(kind, name) pairs of the Attribute nodes behind an input that ask for what is the same on all of an instance."""
    link = feeding(socket)
    if link is None:
        return frozenset()
    node = link.from_node
    own = attributes_of((node,))
    return own.union(*(attributes(each) for each in node.inputs if each.is_linked))


def attributes_of(nodes):
    """`attributes` of these nodes themselves."""
    return frozenset((node.attribute_type, node.attribute_name) for node in nodes
                     if node.type == "ATTRIBUTE" and node.attribute_type in instance_attributes.KINDS)


def complete(own, socket):
    """of_object's coordinates, with 1 in place of attributes that it lacks."""
    return {**{instance_attributes.key(*each): np.ones((1, 4)) for each in attributes(socket)}, **own}


def random_of(name):
    """What Cycles' Object Info calls an object's random number, for one of its own: Blender's hash of its name."""
    number = 0
    for letter in name.encode():
        number = (number * 37 + letter) & 0xFFFFFFFF
    return _hashed(number) / 0xFFFFFFFF


def _hashed(number):
    """Jenkins' final mix of two numbers, the second 0, as BLI_hash_int_2d has it."""
    def turned(value, by):
        return (value << by | value >> (32 - by)) & 0xFFFFFFFF

    a = b = c = 0xDEADBEEF + (2 << 2) + 13
    a = (a + number) & 0xFFFFFFFF
    c = ((c ^ b) - turned(b, 14)) & 0xFFFFFFFF
    a = ((a ^ c) - turned(c, 11)) & 0xFFFFFFFF
    b = ((b ^ a) - turned(a, 25)) & 0xFFFFFFFF
    c = ((c ^ b) - turned(b, 16)) & 0xFFFFFFFF
    a = ((a ^ c) - turned(c, 4)) & 0xFFFFFFFF
    b = ((b ^ a) - turned(a, 14)) & 0xFFFFFFFF
    return ((c ^ b) - turned(b, 24)) & 0xFFFFFFFF


_paintings = {}
MOST_PAINTINGS = 16


def remembered(key, make):
    """What `make` makes of nodes told by this key: a slider elsewhere paints nothing anew."""
    found = _paintings.pop(key, None)
    if found is None:
        found = make()
        while len(_paintings) >= MOST_PAINTINGS:
            del _paintings[next(iter(_paintings))]
    _paintings[key] = found
    return found


def radiance(socket, places):
    """(n, 3) of a shader input of a world, at places whose coordinates are directions. Raises Unknown."""
    link = feeding(socket)
    if link is None:
        return np.zeros((places.count, 3))
    node = link.from_node
    if node.mute or node.type not in ("BACKGROUND", "MIX_SHADER", "ADD_SHADER"):
        raise Unknown(node.name)
    if node.type == "BACKGROUND":
        return colour(node.inputs["Color"], places) * number(node.inputs["Strength"], places)[:, None]
    first, second = (radiance(each, places) for each in list(node.inputs)[-2:])
    if node.type == "ADD_SHADER":
        return first + second
    share = np.clip(number(node.inputs["Fac"], places), 0.0, 1.0)[:, None]
    return first + share * (second - first)


def fingerprint(socket):
    """What tells one input's nodes from another's that look alike."""
    link = feeding(socket)
    if link is None:
        return _told(socket.default_value)
    node = link.from_node
    own = tuple((name, _told(getattr(node, name))) for name in node.bl_rna.properties.keys() if name not in _UNTOLD)
    return node.type, link.from_socket.identifier, own, tuple(fingerprint(each) for each in node.inputs if each.enabled)


# What a node has beside what it computes.
_UNTOLD = frozenset(bpy.types.Node.bl_rna.properties.keys()) | {
    "name", "label", "location", "select", "inputs", "outputs", "rna_type", "image_user", "interface"}


def _told(value):
    if isinstance(value, bpy.types.Image):
        # What is painted has no number that says so.
        return value.name_full, value.filepath, value.colorspace_settings.name, id(value) if value.is_dirty else None
    if isinstance(value, bpy.types.ColorRamp):
        return value.interpolation, value.color_mode, tuple((e.position, tuple(e.color)) for e in value.elements)
    if isinstance(value, bpy.types.CurveMapping):
        return tuple(tuple((tuple(p.location), p.handle_type) for p in curve.points) for curve in value.curves)
    if isinstance(value, (str, int, float, bool)) or value is None:
        return value
    try:
        return tuple(value)
    except TypeError:
        return repr(value)


def _plain(value):
    try:
        return np.array(tuple(value)[:3], dtype=np.float64)
    except TypeError:
        return float(value)


def _as_colour(value, count):
    value = np.asarray(value, dtype=np.float64)
    if value.shape == (count,):
        value = value[:, None]
    return np.broadcast_to(value, (count, 3))


def _as_number(value, count):
    value = np.asarray(value, dtype=np.float64)
    if value.shape in ((3,), (count, 3)):
        value = value @ LUMINANCE
    return np.broadcast_to(value, (count,))


def _named(node, name):
    """The input of that name that is in use: nodes for several types have one of each."""
    return next(socket for socket in node.inputs if socket.name == name and socket.enabled)


def _constant(node, socket, _places):
    return _plain(socket.default_value)


def _coordinates(node, socket, places):
    names = {"UV": "UV", "Generated": "generated", "Object": "object"}
    if socket.name not in names or getattr(node, "object", None) is not None:
        raise Unknown(f"{node.name}: {socket.name}")
    return places.get(names[socket.name])


def _object_info(_node, socket, places):
    names = {"Random": "random", "Color": "object colour"}
    return places.get(names.get(socket.name, f"object's {socket.name.lower()}"))


def _attribute(node, socket, places):
    if node.attribute_type not in instance_attributes.KINDS:
        raise Unknown(f"attribute '{node.attribute_name}' of the geometry")
    value = places.get(instance_attributes.key(node.attribute_type, node.attribute_name))
    if socket.name == "Alpha":
        return value[:, 3]
    return value[:, :3].mean(axis=1) if socket.identifier == "Fac" else value[:, :3]


def _light_path(node, socket, places):
    # What Cycles says of the other kinds depends on how it comes to ask.
    if socket.name != "Is Camera Ray" or places.from_camera is None:
        raise Unknown(f"{node.name}: {socket.name}")
    return float(places.from_camera)


def _uv_map(node, _socket, places):
    return places.get("UV")


def _mapping(node, _socket, places):
    value = _as_colour(_input(node.inputs["Vector"], places), places.count)
    rotation, scale = _plain_only(node, "Rotation"), _plain_only(node, "Scale")
    location = _plain_only(node, "Location") if node.vector_type in ("POINT", "TEXTURE") else np.zeros(3)
    turn = _euler(rotation)
    if node.vector_type == "TEXTURE":
        return np.divide((value - location) @ turn, scale, out=np.zeros_like(value), where=scale != 0.0)
    if node.vector_type == "NORMAL":
        turned = np.divide(value, scale, out=np.zeros_like(value), where=scale != 0.0) @ turn.T
        return turned / np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), 1e-30)
    return (value * scale) @ turn.T + location


def _plain_only(node, name):
    socket = node.inputs[name]
    if socket.is_linked:
        raise Unknown(f"{node.name}: {name}")
    return _plain(socket.default_value)


def _euler(angles):
    """Rotation about x, then y, then z, (3, 3)."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(angles), np.sin(angles)
    return (np.array(((cz, -sz, 0.0), (sz, cz, 0.0), (0.0, 0.0, 1.0)))
            @ np.array(((cy, 0.0, sy), (0.0, 1.0, 0.0), (-sy, 0.0, cy)))
            @ np.array(((1.0, 0.0, 0.0), (0.0, cx, -sx), (0.0, sx, cx))))


def _image(node, socket, places):
    if node.image is None:
        raise Lost(f"its node '{node.name}' has no image")
    if node.projection != "FLAT" or node.image.source in ("TILED", "MOVIE", "SEQUENCE"):
        raise Unknown(node.name)
    texels = images.texels(node.image)
    if texels is None:
        raise cannot_load(node.image)
    at = vector(node.inputs["Vector"], places, "UV")
    looked_up = _looked_up(texels, at[:, :2], node.extension, node.interpolation != "Closest")
    if socket.name == "Alpha":
        return looked_up[:, 3]
    return images.linear(looked_up[:, :3]) if images.is_encoded(node.image) else looked_up[:, :3]


def _environment(node, _socket, places):
    if node.image is None:
        raise Lost(f"its node '{node.name}' has no image")
    if node.image.source in ("TILED", "MOVIE", "SEQUENCE"):
        raise Unknown(node.name)
    texels = images.texels(node.image)
    if texels is None:
        raise cannot_load(node.image)
    towards = vector(node.inputs["Vector"], places, "generated")
    towards = towards / np.maximum(np.linalg.norm(towards, axis=1, keepdims=True), 1e-30)
    x, y, z = towards.T
    if node.projection == "EQUIRECTANGULAR":
        at = np.stack((0.5 - np.arctan2(y, x) / (2.0 * np.pi), np.arctan2(z, np.hypot(x, y)) / np.pi + 0.5), axis=1)
    else:
        # Cycles' direction_to_mirrorball.
        scale = 0.5 / np.sqrt(np.maximum(0.5 * (1.0 - y), 1e-30))
        at = np.stack((0.5 * (x * scale + 1.0), 0.5 * (z * scale + 1.0)), axis=1)
    looked_up = _looked_up(texels, at, "REPEAT", node.interpolation != "Closest")[:, :3]
    return images.linear(looked_up) if images.is_encoded(node.image) else looked_up


def _looked_up(texels, at, extension, smooth):
    """(n, 4) of (h, w, 4), row 0 at the bottom."""
    height, width = texels.shape[:2]
    place = at * (width, height) - (0.5 if smooth else 0.0)
    corner = np.floor(place).astype(np.int64)
    share = place - corner

    def texel(across, up):
        x, y = corner[:, 0] + across, corner[:, 1] + up
        if extension == "REPEAT":
            x, y = x % width, y % height
        elif extension == "MIRROR":
            x, y = (np.minimum(c % (2 * size), 2 * size - 1 - c % (2 * size)) for c, size in ((x, width), (y, height)))
        found = texels[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)]
        if extension == "CLIP":
            found = np.where(((x >= 0) & (x < width) & (y >= 0) & (y < height))[:, None], found, 0.0)
        return found

    if not smooth:
        return texel(0, 0).astype(np.float64)
    u, v = share[:, :1], share[:, 1:]
    return (texel(0, 0) * (1 - u) + texel(1, 0) * u) * (1 - v) + (texel(0, 1) * (1 - u) + texel(1, 1) * u) * v


def _checker(node, socket, places):
    # Cycles' svm_checker: shifted by a hair, so that faces on a whole number are no noise.
    at = vector(node.inputs["Vector"], places, "generated") * number(node.inputs["Scale"], places)[:, None]
    cells = np.floor((at + 0.000001) * 0.999999).astype(np.int64)
    odd = (cells[:, 0] % 2 == cells[:, 1] % 2) == (cells[:, 2] % 2 != 0)
    if socket.identifier == "Fac":
        return np.where(odd, 1.0, 0.0)
    return np.where(odd[:, None], colour(node.inputs["Color1"], places), colour(node.inputs["Color2"], places))


def _gradient(node, socket, places):
    x, y, z = vector(node.inputs["Vector"], places, "generated").T
    kind = node.gradient_type
    if kind == "LINEAR":
        value = x
    elif kind == "QUADRATIC":
        value = np.maximum(x, 0.0) ** 2
    elif kind == "EASING":
        r = np.clip(x, 0.0, 1.0)
        value = 3.0 * r * r - 2.0 * r * r * r
    elif kind == "DIAGONAL":
        value = 0.5 * (x + y)
    elif kind == "RADIAL":
        value = np.arctan2(y, x) / (2.0 * np.pi) + 0.5
    else:
        r = np.maximum(0.999999 - np.sqrt(x * x + y * y + z * z), 0.0)
        value = r * r if kind == "QUADRATIC_SPHERE" else r
    return np.clip(value, 0.0, 1.0)


def _ramp(node, socket, places):
    at = np.clip(number(node.inputs["Fac"], places), 0.0, 1.0)
    # Cycles' own table has 256 entries, between which it is straight.
    entries = np.array([node.color_ramp.evaluate(i / 255.0) for i in range(256)])
    if node.color_ramp.interpolation == "CONSTANT":
        found = entries[np.clip((at * 255.0).astype(np.int64), 0, 255)]
    else:
        found = np.stack([np.interp(at * 255.0, np.arange(256), entries[:, channel]) for channel in range(4)], axis=1)
    return found[:, 3] if socket.name == "Alpha" else found[:, :3]


def _mix_rgb(node, _socket, places):
    share, first, second = node.inputs["Fac"], node.inputs["Color1"], node.inputs["Color2"]
    return _mixed(node.blend_type, np.clip(number(share, places), 0.0, 1.0), colour(first, places),
                  colour(second, places), node.use_clamp)


def _mix(node, _socket, places):
    if node.data_type == "VECTOR" and node.factor_mode != "UNIFORM":
        raise Unknown(node.name)
    share = number(_named(node, "Factor"), places)
    if node.clamp_factor:
        share = np.clip(share, 0.0, 1.0)
    if node.data_type == "FLOAT":
        first, second = number(_named(node, "A"), places), number(_named(node, "B"), places)
        return first + share * (second - first)
    first, second = colour(_named(node, "A"), places), colour(_named(node, "B"), places)
    if node.data_type != "RGBA":
        return first + share[:, None] * (second - first)
    return _mixed(node.blend_type, share, first, second, node.clamp_result)


def _mixed(kind, share, a, b, clamped):
    t = share[:, None]
    if kind not in _BLENDS:
        raise Unknown(f"a mix by {kind.lower()}")
    found = _BLENDS[kind](a, b, t)
    return np.clip(found, 0.0, 1.0) if clamped else found


_BLENDS = {
    "MIX": lambda a, b, t: a + t * (b - a),
    "ADD": lambda a, b, t: a + t * b,
    "SUBTRACT": lambda a, b, t: a - t * b,
    "MULTIPLY": lambda a, b, t: a * (1.0 - t + t * b),
    "SCREEN": lambda a, b, t: 1.0 - (1.0 - t + t * (1.0 - b)) * (1.0 - a),
    "DIFFERENCE": lambda a, b, t: a + t * (np.abs(a - b) - a),
    "DARKEN": lambda a, b, t: a + t * (np.minimum(a, b) - a),
    "LIGHTEN": lambda a, b, t: np.maximum(a, a + t * (np.maximum(a, b) - a)),
    "OVERLAY": lambda a, b, t: np.where(a < 0.5, a * (1.0 - t + 2.0 * t * b),
                                        1.0 - (1.0 - t + 2.0 * t * (1.0 - b)) * (1.0 - a)),
    "DIVIDE": lambda a, b, t: np.where(b != 0.0, (1.0 - t) * a + t * a / np.where(b != 0.0, b, 1.0), a),
}


def _math(node, _socket, places):
    if node.operation not in _OPERATIONS:
        raise Unknown(node.name)
    values = [number(socket, places) for socket in node.inputs if socket.enabled]
    with np.errstate(all="ignore"):
        found = np.nan_to_num(_OPERATIONS[node.operation](*values))
    return np.clip(found, 0.0, 1.0) if node.use_clamp else found


_OPERATIONS = {
    "ADD": np.add, "SUBTRACT": np.subtract, "MULTIPLY": np.multiply,
    "DIVIDE": lambda a, b: np.where(b != 0.0, a / np.where(b != 0.0, b, 1.0), 0.0),
    "MULTIPLY_ADD": lambda a, b, c: a * b + c, "POWER": np.power, "SQRT": lambda a: np.sqrt(np.maximum(a, 0.0)),
    "ABSOLUTE": np.abs, "MINIMUM": np.minimum, "MAXIMUM": np.maximum, "LESS_THAN": np.less, "GREATER_THAN": np.greater,
    "ROUND": lambda a: np.floor(a + 0.5), "FLOOR": np.floor, "CEIL": np.ceil, "FRACT": lambda a: a - np.floor(a),
    "SINE": np.sin, "COSINE": np.cos, "EXPONENT": np.exp, "SIGN": np.sign, "TRUNC": np.trunc,
    "MODULO": lambda a, b: np.where(b != 0.0, np.fmod(a, np.where(b != 0.0, b, 1.0)), 0.0),
}


def _invert(node, _socket, places):
    value = colour(node.inputs["Color"], places)
    return value + number(node.inputs["Fac"], places)[:, None] * (1.0 - 2.0 * value)


def _gamma(node, _socket, places):
    value = colour(node.inputs["Color"], places)
    return np.where(value > 0.0, np.maximum(value, 0.0) ** number(node.inputs["Gamma"], places)[:, None], value)


def _bright_contrast(node, _socket, places):
    contrast = number(node.inputs["Contrast"], places)[:, None]
    shift = number(node.inputs["Bright"], places)[:, None] - 0.5 * contrast
    return np.maximum((1.0 + contrast) * colour(node.inputs["Color"], places) + shift, 0.0)


def _curves(node, _socket, places):
    share = number(node.inputs["Fac"], places)[:, None]
    value = colour(node.inputs["Color"], places)
    mapping = node.mapping
    mapping.initialize()
    grid = np.linspace(0.0, 1.0, 256)
    combined = np.array([mapping.evaluate(mapping.curves[3], position) for position in grid])
    bent = np.empty_like(value)
    for channel in range(3):
        own = np.array([mapping.evaluate(mapping.curves[channel], position) for position in combined])
        bent[:, channel] = np.interp(value[:, channel], grid, own)
    return value + share * (bent - value)


def _hue_saturation(node, _socket, places):
    """Cycles' svm_hsv."""
    share, colours = number(node.inputs["Fac"], places)[:, None], colour(node.inputs["Color"], places)
    turn, saturation, value = hue.split(colours)
    turn = (turn + number(node.inputs["Hue"], places) + 0.5) % 1.0
    saturation = np.clip(saturation * number(node.inputs["Saturation"], places), 0.0, 1.0)
    changed = hue.join(turn, saturation, value * number(node.inputs["Value"], places))
    return np.maximum(colours + share * (changed - colours), 0.0)


def _blackbody(node, _socket, places):
    return blackbody.colour(number(node.inputs["Temperature"], places))


def _to_grey(node, _socket, places):
    return colour(node.inputs["Color"], places) @ LUMINANCE


def _separate(node, socket, places):
    value = _as_colour(_input(node.inputs[0], places), places.count)
    parts = hue.split(value) if _mode(node) == "HSV" else value.T
    return parts[list(node.outputs).index(socket)]


def _mode(node):
    """Of a node that splits or joins a colour."""
    mode = getattr(node, "mode", "RGB")
    if mode not in ("RGB", "HSV"):
        raise Unknown(node.name)
    return mode


def _combine(node, _socket, places):
    parts = [number(socket, places) for socket in list(node.inputs)[:3]]
    return hue.join(*parts) if _mode(node) == "HSV" else np.stack(parts, axis=1)


def _clamp(node, _socket, places):
    least, most = number(node.inputs["Min"], places), number(node.inputs["Max"], places)
    if node.clamp_type == "RANGE":
        least, most = np.minimum(least, most), np.maximum(least, most)
    return np.minimum(np.maximum(number(node.inputs["Value"], places), least), most)


def _map_range(node, _socket, places):
    if getattr(node, "data_type", "FLOAT") != "FLOAT" or node.interpolation_type != "LINEAR":
        raise Unknown(node.name)
    value, from_least, from_most, to_least, to_most = (
        number(_named(node, name), places) for name in ("Value", "From Min", "From Max", "To Min", "To Max"))
    with np.errstate(all="ignore"):
        share = np.nan_to_num((value - from_least) / (from_most - from_least))
    if node.clamp:
        share = np.clip(share, 0.0, 1.0)
    return to_least + share * (to_most - to_least)


# What follows each type of node: a function of the node, its output and places. Patterns add themselves.
NODES = {
    "RGB": _constant, "VALUE": _constant, "TEX_COORD": _coordinates, "UVMAP": _uv_map, "OBJECT_INFO": _object_info,
    "ATTRIBUTE": _attribute, "LIGHT_PATH": _light_path, "MAPPING": _mapping, "TEX_IMAGE": _image,
    "TEX_ENVIRONMENT": _environment, "TEX_CHECKER": _checker, "TEX_GRADIENT": _gradient, "VALTORGB": _ramp,
    "MIX_RGB": _mix_rgb, "MIX": _mix, "MATH": _math, "INVERT": _invert, "HUE_SAT": _hue_saturation, "GAMMA": _gamma,
    "BRIGHTCONTRAST": _bright_contrast, "CURVE_RGB": _curves, "RGBTOBW": _to_grey, "SEPRGB": _separate,
    "SEPARATE_COLOR": _separate, "SEPXYZ": _separate, "COMBRGB": _combine, "COMBINE_COLOR": _combine,
    "COMBXYZ": _combine, "CLAMP": _clamp, "MAP_RANGE": _map_range, "BLACKBODY": _blackbody,
}
