# Blender's world as the native module takes it: a colour, or an image of the surroundings with a rotation.
import dataclasses
import hashlib
import weakref

import bpy
import numpy as np
from mathutils import Euler, Matrix

from .. import compat, native_module
from . import lights, node_colours, node_skies

SIDE, COARSE = 512, 256
"""Texels from bottom to top of what is painted of a world's nodes; where a viewport waits for it."""

STRAIGHT = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


@dataclasses.dataclass(frozen=True)
class WorldValues:
    """radiance: linear RGB, multiplies the image. image: native.Surroundings, equal by identity, or None; image_name,
    image_digest: of Blender's image. rotation: from the world's directions to the image's, 9 numbers, row by row.
    seen: in the picture. suns: lights.SunValues of those in its skies, which are not in the image. backdrop: None, or
    WorldValues of what a camera sees instead. film_transparent: where it is shown
    straight on, through grains as well, the picture is transparent."""

    radiance: tuple = (0.0, 0.0, 0.0)
    image: object = None
    image_name: str = ""
    image_digest: str = ""
    rotation: tuple = STRAIGHT
    seen: bool = False
    suns: tuple = ()
    backdrop: object = None
    film_transparent: bool = False

    @property
    def shines(self):
        return any(self.radiance)

    def before_film(self):
        """It lights, and shows where grains refract it, and nowhere else."""
        return dataclasses.replace(self, seen=False, film_transparent=True)

    def to_native(self, native):
        return native.World(**self.around(), seen=self.seen, film_transparent=self.film_transparent,
                            backdrop=self.backdrop and native.Backdrop(**self.backdrop.around()))

    def around(self):
        """What native.World and native.Backdrop both take."""
        return {"radiance": self.radiance, "image": self.image, "rotation": np.array(self.rotation).reshape(3, 3)}


def read(scene, side=SIDE, layer=None):
    """(WorldValues, sentences about what is left out) of a scene's world, or of that of its view layer. side: of what
    is painted, in texels."""
    transparent = scene.render.film_transparent
    world = layer and getattr(layer, "world_override", None) or scene.world
    if world is None or (layer and not layer.use_sky):
        return WorldValues(film_transparent=transparent), ()
    values, sentences = _read_checked(world, side)
    seen, hidden_from = values, _hidden_from(world)
    if "camera" in hidden_from:
        seen = WorldValues()
    elif _knows_cameras(world):
        seen, of_seen = _read_checked(world, side, from_camera=True)
        sentences = tuple(dict.fromkeys((*sentences, *of_seen)))
    if seen is not values:
        values = dataclasses.replace(values, backdrop=dataclasses.replace(seen, suns=()))
    others = [rays for rays in hidden_from if rays != "camera"]
    if others:
        sentences = (*sentences, f"World '{world.name}' lights as others do: that it is hidden from "
                                 f"{' and '.join(others)} rays is left out.")
    if _has_volume(world):
        sentences = (*sentences, f"World '{world.name}' has a volume, which is left out.")
    # Where nothing shines the picture is black, whether the world is drawn or not.
    return dataclasses.replace(values, seen=(seen.shines or values.shines) and not transparent,
                               film_transparent=transparent), sentences


def _read_checked(world, side, from_camera=False):
    """As _read, but for what is no light."""
    values, sentences = _read(world, side, from_camera)
    wrong = lights.fault(values.radiance)
    if wrong:
        return WorldValues(), (f"World '{world.name}' {wrong}, so it is black.",)
    return values, sentences


def _knows_cameras(world):
    """Whether a world may look otherwise to a camera than to what it lights."""
    return compat.uses_nodes(world) and any(node.type == "LIGHT_PATH" for node in world.node_tree.nodes)


def _hidden_from(world):
    """The kinds of Cycles' rays that do not see a world."""
    visibility = getattr(world, "cycles_visibility", None)
    return [rays for rays in ("camera", "diffuse", "glossy", "transmission") if not getattr(visibility, rays, True)]


def _has_volume(world):
    output = world.node_tree.get_output_node("CYCLES") if compat.uses_nodes(world) else None
    return output is not None and output.inputs["Volume"].is_linked


def _read(world, side, from_camera=False):
    if not compat.uses_nodes(world):
        return WorldValues(tuple(world.color)), ()
    output = world.node_tree.get_output_node("CYCLES")
    surface = output and _chosen(output.inputs["Surface"], from_camera)
    link = surface and node_colours.feeding(surface)
    if link is None:
        return WorldValues(), ()
    background = link.from_node
    if background.type == "BACKGROUND" and background.mute:
        return WorldValues(), ()
    strength = _constant(background.inputs["Strength"]) if background.type == "BACKGROUND" else None
    if strength is None:
        return _painted(world, surface, side, from_camera)
    colour = _constant(background.inputs["Color"])
    if colour is not None:
        return WorldValues(tuple(strength * channel for channel in colour[:3])), ()
    texture = background.inputs["Color"].links[0].from_node
    if texture.type == "TEX_ENVIRONMENT" and texture.projection == "EQUIRECTANGULAR":
        values, sentences = _read_image(world, texture, strength)
        if not sentences or values.image is None:
            return values, sentences
    return _painted(world, surface, side, from_camera)


def _chosen(socket, from_camera):
    """The input that a world's shader input comes to where mixes ask for no more than whether a camera looks."""
    while (link := node_colours.feeding(socket)) is not None and link.from_node.type == "MIX_SHADER":
        share = node_colours.feeding(link.from_node.inputs["Fac"])
        if link.from_node.mute or share is None or share.from_node.type != "LIGHT_PATH" or (
                share.from_socket.name != "Is Camera Ray"):
            break
        socket = link.from_node.inputs[2 if from_camera else 1]
    return socket


def _painted(world, socket, side, from_camera):
    """What nodes make of every direction."""
    try:
        pixels, suns = node_colours.remembered(
            (node_colours.fingerprint(socket), side, from_camera),
            lambda: (_paint(socket, side, from_camera), node_skies.suns(socket, from_camera)))
    except node_colours.Unknown as unknown:
        advice = ("" if isinstance(unknown, node_colours.Lost) else
                  ": use colours, gradients, patterns, skies, mixes or environment images")
        return WorldValues(tuple(world.color)), (
            f"World '{world.name}' is drawn in its viewport colour, for {unknown.reason}{advice}.",)
    surroundings = _made(pixels)
    _paintings[surroundings] = pixels
    suns = tuple(lights.SunValues(world.name, tuple(towards.tolist()), tuple(irradiance.tolist()), angle,
                                  flat=False)
                 for towards, angle, irradiance in suns)
    return WorldValues((1.0,) * 3, surroundings, "", _digests[surroundings], suns=suns), ()


def _paint(socket, side, from_camera):
    """(h, w, 3) float32."""
    turn = (0.5 - (np.arange(2 * side) + 0.5) / (2 * side)) * 2.0 * np.pi
    rise = (0.5 - (np.arange(side) + 0.5) / side) * np.pi
    turn, rise = (angles.ravel() for angles in np.meshgrid(turn, rise))
    directions = np.stack((np.cos(rise) * np.cos(turn), np.cos(rise) * np.sin(turn), np.sin(rise)), axis=1)
    places = node_colours.Places({"generated": directions, "object": directions}, from_camera=from_camera)
    radiance = np.nan_to_num(node_colours.radiance(socket, places), nan=0.0, posinf=3e38, neginf=0.0)
    return np.ascontiguousarray(radiance.clip(min=0.0).reshape(side, 2 * side, 3), dtype=np.float32)


def image_of(values, name):
    """(bpy.types.Image of a WorldValues' surroundings, whether it is new): the artist's own, or what was painted."""
    if values.image_name:
        return bpy.data.images[values.image_name], False
    pixels = _paintings[values.image]
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, float_buffer=True)
    compat.set_linear(image)
    colours = np.ones((height, width, 4), dtype=np.float32)
    colours[..., :3] = pixels[::-1]
    image.pixels.foreach_set(colours.ravel())
    image.update()
    return image, True


def _constant(socket):
    """What an input is if nothing varies it, else None."""
    if not socket.is_linked:
        return socket.default_value
    link = socket.links[0]
    return link.from_socket.default_value if link.from_node.type in ("RGB", "VALUE") else None


def _read_image(world, texture, strength):
    image = texture.image
    if image is None:
        return WorldValues(), (f"World '{world.name}' has an environment texture without an image, so it is black.",)
    rotation, sentences = _rotation(world, texture)
    surroundings = _surroundings(image)
    if surroundings is None:
        return WorldValues(), (f"World '{world.name}' is black: its image '{image.name}' cannot be loaded.",)
    return WorldValues((strength,) * 3, surroundings, image.name, _digests[surroundings], rotation), sentences


def _rotation(world, texture):
    """(world to image, row by row, sentences): what a Mapping node before the texture turns."""
    links = texture.inputs["Vector"].links
    node = links[0].from_node if links else None
    if node is not None and node.type == "MAPPING":
        matrix, plain = _of_mapping(node)
        before = node.inputs["Vector"].links
        plain = plain and (not before or _is_direction(before[0]))
        if plain:
            return matrix, ()
        return matrix, (f"World '{world.name}': of its Mapping node only a constant rotation of the generated "
                        "coordinates is rendered.",)
    if node is None or _is_direction(links[0]):
        return STRAIGHT, ()
    return STRAIGHT, (f"World '{world.name}' has the node '{node.name}' before its image, which is left out.",)


def _is_direction(link):
    return link.from_node.type == "TEX_COORD" and link.from_socket.name == "Generated"


def _of_mapping(node):
    """(rotation, row by row, whether that is all the node does)."""
    rotation, scale = node.inputs["Rotation"], node.inputs["Scale"]
    location = node.inputs.get("Location")
    matrix = Matrix.Identity(3) if rotation.is_linked else Euler(rotation.default_value, "XYZ").to_matrix()
    if node.vector_type == "TEXTURE":
        matrix = matrix.transposed()
    moved = location is not None and node.vector_type in ("POINT", "TEXTURE") and (
        location.is_linked or any(location.default_value))
    plain = not (rotation.is_linked or scale.is_linked or moved) and tuple(scale.default_value) == (1.0, 1.0, 1.0)
    return tuple(number for row in matrix for number in row), plain


# An image is read once, as long as anybody holds it; equal pixels are one native.Surroundings, wherever they come from.
_by_image = weakref.WeakValueDictionary()
_by_content = weakref.WeakValueDictionary()
_digests = weakref.WeakKeyDictionary()
_paintings = weakref.WeakKeyDictionary()


def _surroundings(image):
    """native.Surroundings of a bpy.types.Image, or None if it has no pixels."""
    image = image.original
    width, height = image.size
    if width == 0 or height == 0 or image.channels == 0:
        return None
    # What is painted may change at any time and has no number that says so.
    key = None if image.is_dirty else (image.name_full, image.filepath, width, height, image.source,
                                       image.colorspace_settings.name, tuple(getattr(image, "generated_color", ())))
    found = key and _by_image.get(key)
    if found is None:
        found = _made(_linear_pixels(image, width, height))
        if key:
            _by_image[key] = found
    return found


def _made(pixels):
    digest = hashlib.blake2b(pixels, digest_size=16).hexdigest()
    found = _by_content.get(digest)
    if found is None:
        found = native_module.get().Surroundings(pixels)
        _by_content[digest] = found
        _digests[found] = digest
    return found


def _linear_pixels(image, width, height):
    """(h, w, 3) float32, row 0 at the top; what is no light is black."""
    pixels = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, image.channels)[::-1]
    colours = pixels[..., :3] if image.channels >= 3 else np.repeat(pixels[..., :1], 3, axis=2)
    if not image.is_float and image.colorspace_settings.name == "sRGB":
        colours = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    colours = np.nan_to_num(colours, nan=0.0, posinf=3e38, neginf=0.0).clip(min=0.0)
    return np.ascontiguousarray(colours, dtype=np.float32)
