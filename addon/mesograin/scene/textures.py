# Linked inputs of a material's nodes as pictures on a mesh: images as they are, what nodes make of places painted once.
import dataclasses

import numpy as np

from .. import native_module
from . import images, node_colours, node_patterns, node_skies, unwrapped

SIDE, COARSE = 1024, 512
"""Texels on a side of what is painted; where a viewport waits for it."""

_AFFINE = {"MAPPING", "TEX_COORD", "UVMAP", "REROUTE"}
_WRAPS = {"REPEAT": "repeat", "EXTEND": "extend", "CLIP": "clip", "MIRROR": "mirror"}


@dataclasses.dataclass(frozen=True)
class MapValues:
    """How a picture lies on a mesh. to_picture: 8 numbers, as native.TextureMap has them, row by row."""

    picture: object  # native.Picture, equal by identity
    by_position: bool = False
    to_picture: tuple = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0)
    wrap: str = "repeat"
    smooth: bool = True

    @property
    def mean(self):
        """Linear RGB."""
        return images.mean(self.picture)

    def to_native(self, native):
        return native.TextureMap(self.picture, self.by_position, np.array(self.to_picture).reshape(2, 4), self.wrap,
                                 self.smooth)


@dataclasses.dataclass(frozen=True)
class Box:
    """Where a mesh is, in its own space: what Generated coordinates go over."""

    lower: tuple = (-1.0, -1.0, -1.0)
    upper: tuple = (1.0, 1.0, 1.0)

    @staticmethod
    def of(thing):
        """Of an evaluated object."""
        corners = np.array([tuple(corner) for corner in thing.bound_box])
        return Box(tuple(corners.min(axis=0).tolist()), tuple(corners.max(axis=0).tolist()))

    @property
    def flat(self):
        """Whether all is at one height."""
        return self.upper[2] - self.lower[2] <= 1e-6 * max(self.upper[0] - self.lower[0], self.upper[1] - self.lower[1])

    def generated(self, places):
        """(n, 3) of (n, 3) places, as Blender's texture space has it: 0.5 along an axis without extent."""
        lower, upper = np.array(self.lower), np.array(self.upper)
        size = upper - lower
        size = np.where(size > 0.0, size, 2.0)
        return (places - 0.5 * (lower + upper)) / size + 0.5


FOLLOWED = (node_patterns, node_skies)
"""Whose nodes add themselves to those that are known."""

MARGIN = 8  # texels that what is painted over UVs goes on beyond their edges


def read(socket, box, numbers, side=SIDE, mesh=None):
    """MapValues of a linked colour input, or of one of numbers. side: of what is painted; mesh: native.Mesh, on whose
    UVs places may be painted. Raises node_colours.Unknown."""
    link = node_colours.feeding(socket)
    if link.from_node.type == "TEX_IMAGE" and link.from_socket.name == "Color" and not link.from_node.mute:
        found = _image(link.from_node, box)
        # A number is a colour's luminance, which only grey pictures hold in each channel.
        if found is not None and not (numbers and not images.is_grey(found.picture)):
            return found
    return _painted(socket, box, numbers, side, mesh)


def constant(colour):
    """MapValues that are one linear RGB everywhere."""
    return MapValues(images.made(np.array([[(*colour[:3], 1.0)]], dtype=np.float32)))


def _image(node, box):
    """MapValues of an image, or None if its places are no affine map of UVs or of the mesh's own."""
    if node.image is None or node.projection != "FLAT" or node.image.source in ("TILED", "MOVIE", "SEQUENCE"):
        return None
    if not _is_affine(node.inputs["Vector"]):
        return None
    picture = images.picture(node.image)
    if picture is None:
        raise node_colours.cannot_load(node.image)
    # An affine map is known from where it takes the origin and the ends of the axes.
    probes = np.array(((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    places = node_colours.Places({"UV": probes * (1.0, 1.0, 0.0), "object": probes, "generated": box.generated(probes)})
    origin, *ends = node_colours.vector(node.inputs["Vector"], places, "UV")[:, :2]
    if len(places.used) > 1:
        return None
    columns = [end - origin for end in ends] + [origin]
    rows = tuple(float(column[row]) for row in range(2) for column in columns)
    return MapValues(picture, places.used != {"UV"}, rows, _WRAPS[node.extension], node.interpolation != "Closest")


def _is_affine(socket):
    link = node_colours.feeding(socket)
    if link is None:
        return True
    return link.from_node.type in _AFFINE and not link.from_node.mute and all(
        _is_affine(each) for each in link.from_node.inputs if each.name == "Vector")


def _painted(socket, box, numbers, side, mesh):
    """MapValues of what nodes make of every UV from 0 to 1, of every place of a flat mesh, or of every place of another
    where its UVs lie."""
    used = _sources(socket)
    told = (node_colours.fingerprint(socket), numbers, side)
    if used == {"UV"}:
        return MapValues(node_colours.remembered(told, lambda: _painting(socket, {"UV": _grid(side)}, numbers)))
    if "UV" in used or not box.flat:
        key = (*told, box, mesh)
        return MapValues(node_colours.remembered(key, lambda: _painted_on_surface(socket, box, numbers, side, mesh)))
    lower, upper = np.array(box.lower), np.array(box.upper)
    size = np.maximum(upper - lower, 1e-30)

    def paint():
        places = lower + _grid(side) * size
        return _painting(socket, {"object": places, "generated": box.generated(places)}, numbers)

    to_picture = (1.0 / size[0], 0.0, 0.0, -lower[0] / size[0], 0.0, 1.0 / size[1], 0.0, -lower[1] / size[1])
    return MapValues(node_colours.remembered((*told, box), paint), True,
                     tuple(float(number) for number in to_picture), "extend")


def _grid(side):
    """(n, 3): middles of the texels of a picture over the unit square, row by row, the top one first."""
    row = (np.arange(side) + 0.5) / side
    u, v = (axis.ravel() for axis in np.meshgrid(row, row[::-1]))
    return np.stack((u, v, np.zeros_like(u)), axis=1)


def _sources(socket):
    """Which coordinates an input's nodes ask for. Raises node_colours.Unknown."""
    one = np.full((1, 3), 0.5)
    places = node_colours.Places({"UV": one, "object": one, "generated": one})
    node_colours.colour(socket, places)
    return places.used or {"UV"}


def _painted_on_surface(socket, box, numbers, side, mesh):
    """native.Picture of what nodes make of a mesh's places, where its UVs lie."""
    texels = unwrapped.texels(mesh, side) if mesh is not None else None
    if texels is None:
        raise node_colours.Unknown("a texture in space, which is drawn on what is flat, or on UVs from 0 to 1 that do "
                                   "not lie over each other")
    coordinates = {"object": texels.places, "generated": box.generated(texels.places),
                   "UV": np.pad(texels.uvs, ((0, 0), (0, 1)))}
    picture = np.zeros((side * side, 4), dtype=np.float32)
    picture[texels.numbers, :3] = _asked(socket, coordinates, numbers)
    picture[texels.numbers, 3] = 1.0
    return images.made(native_module.get().extend_margin(picture.reshape(side, side, 4), MARGIN))


def _painting(socket, coordinates, numbers):
    found = _asked(socket, coordinates, numbers)
    side = int(np.sqrt(len(found)))
    texels = np.ones((side * side, 4), dtype=np.float32)
    texels[:, :3] = found
    return images.made(texels.reshape(side, side, 4))


def _asked(socket, coordinates, numbers):
    """(n, 3) or (n, 1) of an input at places."""
    places = node_colours.Places(coordinates)
    found = node_colours.number(socket, places)[:, None] if numbers else node_colours.colour(socket, places)
    return np.nan_to_num(found)
