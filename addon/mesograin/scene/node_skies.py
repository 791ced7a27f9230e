# Blender's Sky Texture, for node_colours: what of it is a sky, and which suns are to be lights of their own.
import numpy as np

from . import node_colours, sky
from .node_colours import Unknown, vector
from .node_patterns import follow


@follow("TEX_SKY")
def _sky(node, _socket, places):
    towards = vector(_turned_by(node), places, "generated")
    towards = towards / np.maximum(np.linalg.norm(towards, axis=1, keepdims=True), 1e-30)
    if node.sky_type == "PREETHAM":
        return np.maximum(sky.daylight(towards, node.sun_direction, node.turbidity), 0.0)
    if node.sky_type != "NISHITA":
        raise Unknown(f"{node.name}: {node.sky_type.replace('_', ' ').title()}")
    air = (node.air_density, node.dust_density)
    seen = sky.scattered_once(towards, node.sun_elevation, node.sun_rotation, _altitude(node), *air, node.ozone_density)
    if node.sun_disc and places.with_suns:
        disc = sky.sun_disc(towards, node.sun_elevation, node.sun_rotation, _altitude(node), *air, node.sun_size)
        seen = np.where(disc.any(axis=1, keepdims=True), node.sun_intensity * disc, seen)
    return np.maximum(seen, 0.0)


def _turned_by(node):
    """The input of directions; None in Blender 4 where there is a sun's disc, which is not turned."""
    return node.inputs.get("Vector")


def _altitude(node):
    return min(max(node.altitude, 1.0), 59999.0)


def suns(socket, from_camera=None):
    """[(direction to it (3,), its angle in radians, irradiance (3,))] of the suns in what feeds a world's shader input.
    They are too small for a picture of the world. from_camera: as node_colours.Places has it. Raises Unknown."""
    found = []
    for node in {link.from_node.name: link.from_node for link in _links(socket)}.values():
        if node.type != "TEX_SKY" or node.sky_type != "NISHITA" or not node.sun_disc or node.mute:
            continue
        turned_by = _turned_by(node)
        if turned_by is not None and turned_by.is_linked and not _is_plain(turned_by):
            raise Unknown(f"{node.name}: a sun that is turned by nodes")
        towards, half = sky.sun_direction(node.sun_elevation, node.sun_rotation), 0.5 * node.sun_size
        points = _disc(towards, half)
        with_suns, without = (node_colours.radiance(socket, node_colours.Places(
            {"generated": points, "object": points}, with_suns=each, from_camera=from_camera))
                              for each in (True, False))
        solid_angle = 2.0 * np.pi * (1.0 - np.cos(half))
        irradiance = np.maximum(with_suns - without, 0.0).mean(axis=0) * solid_angle
        if irradiance.any():
            found.append((towards, node.sun_size, irradiance))
    return found


def _links(socket):
    """Of all that feeds a socket."""
    for link in socket.links:
        yield link
        for before in link.from_node.inputs:
            yield from _links(before)


def _is_plain(socket):
    link = node_colours.feeding(socket)
    return link.from_node.type == "TEX_COORD" and link.from_socket.name == "Generated"


def _disc(middle, half, rings=24, around=48):
    """Directions spread evenly over a disc of the sky, (n, 3)."""
    aside = np.arccos(1.0 - (np.arange(rings) + 0.5) / rings * (1.0 - np.cos(half)))
    turn = 2.0 * np.pi * (np.arange(around) + 0.5) / around
    aside, turn = (each.ravel()[:, None] for each in np.meshgrid(aside, turn))
    x = np.cross(middle, (1.0, 0.0, 0.0) if abs(middle[0]) < 0.5 else (0.0, 1.0, 0.0))
    x /= np.linalg.norm(x)
    y = np.cross(middle, x)
    return np.cos(aside) * middle + np.sin(aside) * (np.cos(turn) * x + np.sin(turn) * y)
