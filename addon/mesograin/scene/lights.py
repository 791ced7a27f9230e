# Blender's lights as the native module takes them: Cycles' units, copied, nothing borrowed.
import dataclasses
import math

import numpy as np

from .. import compat
from . import node_colours


@dataclasses.dataclass(frozen=True)
class SunValues:
    name: str
    direction_to_light: tuple
    irradiance: tuple
    angle: float
    flat: bool

    def to_native(self, native):
        return _made(self.name, native, native.DirectionalLight, direction_to_light=self.direction_to_light,
                     irradiance=self.irradiance, angle=self.angle, flat=self.flat)


@dataclasses.dataclass(frozen=True)
class PlacedLightValues:
    """A light that has a place. kind: PointLight, SpotLight or AreaLight; values: (parameter, value) pairs."""

    name: str
    kind: str
    values: tuple

    def to_native(self, native):
        return _made(self.name, native, getattr(native, self.kind), **dict(self.values))


def _made(name, native, kind, **values):
    try:
        return kind(**values)
    except native.Error as error:
        raise native.Error(f"Light '{name}': {error}") from error


def read(evaluated_object, matrix_world):
    """(SunValues or PlacedLightValues or None, sentences about what is left out) of an object that is a light."""
    light, name = evaluated_object.data, evaluated_object.name
    axes = [axis.normalized().length for axis in matrix_world.to_3x3().col]
    if not all(axes[number] > 0.5 for number in _AXES[light.type]):
        return None, (f"Light '{name}' is scaled to nothing, so it is left out.",)
    factor, sentences = _emission_of_nodes(light, name)
    if not compat.casts_shadows(light):
        sentences = (*sentences, f"Light '{name}' casts shadows, though it should not.")
    power = [own * node for own, node in zip(_power(light), factor)]
    wrong = fault(power)
    if wrong:
        return None, (f"Light '{name}' {wrong}, so it is left out.",)
    return _READERS[light.type](light, name, power, matrix_world), sentences


def energy_and_colour(light):
    """(strength, colour) of a light without nodes, exposure or temperature that is as bright as this."""
    power = [own * node for own, node in zip(_power(light), _emission_of_nodes(light, light.name)[0])]
    strongest = max(power)
    if strongest <= 0.0 or fault(power):
        return 0.0, (1.0, 1.0, 1.0)
    return strongest, tuple(channel / strongest for channel in power)


def is_left_out(light):
    """Whether a light, wherever it is, has a strength that cannot be drawn."""
    return bool(fault([own * node for own, node in zip(_power(light), _emission_of_nodes(light, light.name)[0])]))


def fault(power):
    """Why a light or world of this power, linear RGB, cannot be drawn; empty where it can."""
    if not all(math.isfinite(channel) for channel in power):
        return "has a strength or colour that is no number"
    if min(power) < 0.0:
        return "has a negative strength or colour, and would take light away"
    return ""


def _power(light):
    """Linear RGB: W, of a sun W/m^2."""
    strength = light.energy * 2.0 ** getattr(light, "exposure", 0.0)
    colour = [channel * strength for channel in light.color]
    if getattr(light, "use_temperature", False):
        colour = [channel * tint for channel, tint in zip(colour, light.temperature_color)]
    return colour


def _emission_of_nodes(light, name):
    """(colour times strength of a light's Emission node, sentences); from Blender 5 on every light has one."""
    white = (1.0, 1.0, 1.0)
    if not compat.uses_nodes(light):
        return white, ()
    output = light.node_tree.get_output_node("CYCLES")
    links = output.inputs["Surface"].links if output else ()
    if not links:
        return (0.0, 0.0, 0.0), ()
    node = links[0].from_node
    if node.type == "EMISSION" and node.mute:
        return (0.0, 0.0, 0.0), ()
    if node.type != "EMISSION":
        return white, (f"Light '{name}' has the node '{node.name}', which is left out: its own colour and strength are "
                       "rendered.",)
    told, unknown = [], []
    for socket, ask in ((node.inputs["Color"], node_colours.colour), (node.inputs["Strength"], node_colours.number)):
        try:
            told.append(ask(socket, node_colours.nowhere())[0])
        except node_colours.Unknown:
            told.append(1.0)
            unknown.append(socket.name.lower())
    sentences = (f"Light '{name}' has nodes that vary its {' and '.join(unknown)}, which are left out.",
                 ) if unknown else ()
    return tuple((told[1] * told[0] * np.ones(3)).tolist()), sentences


widest_flat_sun = math.radians(179.0)


def _times(power, factor):
    return tuple(channel * factor for channel in power)


def _sun(light, name, power, matrix_world):
    # A sun shines along its -z axis, and its strength is irradiance already.
    direction = matrix_world.to_3x3().col[2].normalized()
    angle = min(light.angle, math.pi)
    if not getattr(light, "normalize", True) and angle > 0.0:
        power = _times(power, math.pi * math.sin(0.5 * angle) ** 2)
    # As wide as half the sky a flat disc's light comes from its rim alone, and Cycles draws none.
    flat = not compat.has_even_lights() and angle < widest_flat_sun
    return SunValues(name, tuple(direction), _times(power, sun_irradiance(angle)), angle, flat)


def sun_irradiance(angle):
    """What a sun of this full angle and of Blender's strength 1 has as `irradiance`, of which a plane that faces it
    receives (1 + cos(angle / 2)) / 2: where Cycles' suns are even, it receives the strength there."""
    return 2.0 / (1.0 + math.cos(0.5 * angle)) if compat.has_even_lights() else 1.0


def _ball(light, power, matrix_world):
    """What point lights and spots have in common."""
    radius = light.shadow_soft_size
    per_watt = 1.0 / (4.0 * math.pi)
    if not getattr(light, "normalize", True):
        per_watt = radius * radius if radius > 0.0 else 1.0 / math.pi
    # Cycles' soft falloff came as a choice; before 4.0 there was nothing else.
    soft = getattr(light, "use_soft_falloff", not compat.has_even_lights())
    return {"position": tuple(matrix_world.translation), "radiant_intensity": _times(power, per_watt),
            "radius": radius, "shape": "disc" if soft else "sphere"}


def _point(light, name, power, matrix_world):
    return PlacedLightValues(name, "PointLight", tuple(_ball(light, power, matrix_world).items()))


def _spot(light, name, power, matrix_world):
    values = _ball(light, power, matrix_world)
    axes = matrix_world.to_3x3().col
    values.update(axis=tuple(-axes[2].normalized()), angle=min(light.spot_size, math.pi), blend=light.spot_blend)
    if not compat.has_even_lights():
        values["cosine"] = True
    else:
        # The object's scale stretches the cone's cross-section.
        length = axes[2].length
        values.update(wide_x=tuple(axes[0] / length), wide_y=tuple(axes[1] / length))
    return PlacedLightValues(name, "SpotLight", tuple(values.items()))


def _area(light, name, power, matrix_world):
    if hasattr(light, "cycles") and light.cycles.is_portal:
        return None  # it only guides Cycles' rays into a room
    axes = matrix_world.to_3x3().col
    size_y = light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size
    half_x, half_y = 0.5 * light.size * axes[0], 0.5 * size_y * axes[1]
    if half_x.cross(half_y).dot(axes[2]) < 0.0:
        half_y = -half_y  # it shines along -z, mirrored or not
    ellipse = light.shape in ("DISK", "ELLIPSE")
    area = 4.0 * half_x.length * half_y.length * (0.25 * math.pi if ellipse else 1.0)
    if area == 0.0:
        return None
    per_watt = 1.0 / math.pi if compat.has_even_lights() else 0.25
    if getattr(light, "normalize", True):
        per_watt /= area
    return PlacedLightValues(name, "AreaLight", (
        ("position", tuple(matrix_world.translation)), ("half_x", tuple(half_x)), ("half_y", tuple(half_y)),
        ("radiance", _times(power, per_watt)), ("ellipse", ellipse), ("spread", min(light.spread, math.pi))))


_READERS = {"SUN": _sun, "POINT": _point, "SPOT": _spot, "AREA": _area}
_AXES = {"SUN": (2,), "POINT": (), "SPOT": (0, 1, 2), "AREA": (0, 1)}
"""Which of an object's axes tell where a light of a kind shines: they must have a length."""
