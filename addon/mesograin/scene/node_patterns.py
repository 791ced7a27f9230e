# Blender's procedural textures, for node_colours: noise, cells, bricks, waves.
import numpy as np

from .. import compat
from . import hashes, noise, voronoi
from .node_colours import NODES, Unknown, colour, number, vector


def follow(kind):
    """Has node_colours follow nodes of this type."""
    def decorate(read):
        NODES[kind] = read
        return read
    return decorate


def _even(node, name, places, default=0.0):
    """A number that must be the same everywhere, or the default where this Blender's node has no such input."""
    socket = node.inputs.get(name)
    if socket is None:
        return default
    found = number(socket, places)
    if found.size > 1 and np.ptp(found) > 0.0:
        raise Unknown(f"{node.name}: {name}")
    return float(found.flat[0])


def _places(node, dimensions, places, scale=1.0):
    """(n, dimensions) where a pattern is asked: its vector, its W, or both."""
    across = vector(node.inputs["Vector"], places, "generated") if dimensions > 1 else np.empty((places.count, 0))
    along = number(node.inputs["W"], places)[:, None] if dimensions in (1, 4) else np.empty((places.count, 0))
    return np.concatenate((across[:, :min(dimensions, 3)], along), axis=1) * np.reshape(scale, (-1, 1))


def _fractal(kind, count, roughness, lacunarity, offset, gain, normalised):
    """A function of places."""
    return {
        "FBM": lambda at: noise.fbm(at, count, roughness, lacunarity, normalised),
        "MULTIFRACTAL": lambda at: noise.multifractal(at, count, roughness, lacunarity),
        "HETERO_TERRAIN": lambda at: noise.hetero_terrain(at, count, roughness, lacunarity, offset),
        "HYBRID_MULTIFRACTAL": lambda at: noise.hybrid_multifractal(at, count, roughness, lacunarity, offset, gain),
        "RIDGED_MULTIFRACTAL": lambda at: noise.ridged_multifractal(at, count, roughness, lacunarity, offset, gain),
    }[kind]


@follow("TEX_NOISE")
def _noise(node, socket, places):
    dimensions = int(node.noise_dimensions[0])
    at = _places(node, dimensions, places, number(node.inputs["Scale"], places))
    detail = min(max(_even(node, "Detail", places), 0.0), 15.0)
    fractal = _fractal(getattr(node, "noise_type", "FBM"), detail + 1.0, max(_even(node, "Roughness", places), 0.0),
                       _even(node, "Lacunarity", places, 2.0), _even(node, "Offset", places),
                       _even(node, "Gain", places), getattr(node, "normalize", True))
    bent = number(node.inputs["Distortion"], places)
    if bent.any():
        at = at + bent[:, None] * np.stack([noise.signed(at + noise.elsewhere(seed, dimensions))
                                            for seed in range(dimensions)], axis=1)
    if socket.name != "Color":
        return fractal(at)
    return np.stack([fractal(at)] + [fractal(at + noise.elsewhere(dimensions + i, dimensions)) for i in range(2)],
                    axis=1)


@follow("TEX_MUSGRAVE")
def _musgrave(node, _socket, places):
    at = _places(node, int(node.musgrave_dimensions[0]), places, number(node.inputs["Scale"], places))
    count = min(max(_even(node, "Detail", places), 0.0), 15.0)
    lacunarity = max(_even(node, "Lacunarity", places), 1e-5)
    kind = node.musgrave_type
    if kind in ("HETERO_TERRAIN", "RIDGED_MULTIFRACTAL") and count < 1.0:
        count += 1.0  # their first octave is always there
    return _fractal(kind, count, lacunarity ** -max(_even(node, "Dimension", places), 1e-5), lacunarity,
                    _even(node, "Offset", places), _even(node, "Gain", places), False)(at)


@follow("TEX_WHITE_NOISE")
def _white_noise(node, socket, places):
    at = _places(node, int(node.noise_dimensions[0]), places).astype(np.float32)
    if socket.name == "Color":
        return hashes.colours_of_cell(at)
    return hashes.share_of_numbers(*at.T)


@follow("TEX_VORONOI")
def _voronoi(node, socket, places):
    if not compat.cells_by_lookup3():
        raise Unknown(node.name)
    if _even(node, "Detail", places) > 0.0:
        raise Unknown(f"{node.name}: Detail")
    dimensions = int(node.voronoi_dimensions[0])
    scale = number(node.inputs["Scale"], places)
    at = _places(node, dimensions, places, scale)
    cells = voronoi.Cells(at, min(max(_even(node, "Randomness", places), 0.0), 1.0))
    metric = node.distance if dimensions > 1 else "EUCLIDEAN"
    exponent = _even(node, "Exponent", places) if metric == "MINKOWSKI" else 1.0
    feature = node.feature
    if feature == "DISTANCE_TO_EDGE":
        return _normalised(node, voronoi.distance_to_edge(cells))
    if feature == "N_SPHERE_RADIUS":
        return voronoi.ball_radius(cells)
    smoothness = min(max(_even(node, "Smoothness", places) / 2.0, 0.0), 0.5) if feature == "SMOOTH_F1" else 0.0
    if smoothness > 0.0:
        distance, tint, place = voronoi.smooth_nearest(cells, metric, exponent, smoothness)
    else:
        distance, tint, place = voronoi.nearest(cells, metric, exponent, 1 if feature == "F2" else 0)
    if socket.name == "Color":
        return tint
    if socket.name == "Distance":
        return _normalised(node, distance)
    unscaled = np.divide(place, scale[:, None], out=np.zeros_like(place), where=scale[:, None] != 0.0)
    if socket.name == "W":
        return unscaled[:, -1]
    across = unscaled if dimensions < 4 else unscaled[:, :3]
    return np.pad(across, ((0, 0), (0, 3 - across.shape[1])))


def _normalised(node, distance):
    """Blender 4's Voronoi may divide by the largest distance there can be."""
    if getattr(node, "normalize", False):
        raise Unknown(f"{node.name}: Normalize")
    return distance


@follow("TEX_BRICK")
def _bricks(node, socket, places):
    x, y, _ = (vector(node.inputs["Vector"], places, "generated")
               * number(node.inputs["Scale"], places)[:, None]).T
    width, height, size, smooth, bias = (number(node.inputs[name], places) for name in (
        "Brick Width", "Row Height", "Mortar Size", "Mortar Smooth", "Bias"))
    row = np.floor(y / height).astype(np.int64)
    shift = np.zeros_like(x)
    if node.offset_frequency and node.squash_frequency:
        # C's remainder of a negative row is 0 where the mathematical one is.
        width = np.where(row % node.squash_frequency != 0, width, width * node.squash)
        shift = np.where(row % node.offset_frequency != 0, 0.0, width * node.offset)
    brick = np.floor((x + shift) / width).astype(np.int64)
    across, up = x + shift - width * brick, y - height * row
    tint = np.clip(_brick_noise((row << 16) + (brick & 0xFFFF)) + bias, 0.0, 1.0)
    edge = np.minimum(np.minimum(across, up), np.minimum(width - across, height - up))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.clip((1.0 - edge / size) / smooth, 0.0, 1.0)
    mortar = np.where(edge >= size, 0.0, np.where(smooth == 0.0, 1.0, share * share * (3.0 - 2.0 * share)))
    if socket.identifier == "Fac":
        return mortar
    first, second, between = (colour(node.inputs[name], places) for name in ("Color1", "Color2", "Mortar"))
    tint, mortar = tint[:, None], mortar[:, None]
    return (first + np.where(mortar != 1.0, tint, 0.0) * (second - first)) * (1.0 - mortar) + between * mortar


def _brick_noise(whole):
    """(n,) from 0 to 1 of whole numbers: Blender's fast one, in 32 bits."""
    with np.errstate(over="ignore"):
        word = (whole.astype(np.uint32) + np.uint32(1013)) & np.uint32(0x7FFFFFFF)
        word = (word >> np.uint32(13)) ^ word
        word = word * (word * word * np.uint32(60493) + np.uint32(19990303)) + np.uint32(1376312589)
    return 0.5 * (word & np.uint32(0x7FFFFFFF)).astype(np.float64) / 1073741824.0


@follow("TEX_WAVE")
def _waves(node, _socket, places):
    at = vector(node.inputs["Vector"], places, "generated") * number(node.inputs["Scale"], places)[:, None]
    at = (at + 0.000001) * 0.999999  # as Cycles has it
    if node.wave_type == "BANDS":
        axes = {"X": (2, 0, 0), "Y": (0, 2, 0), "Z": (0, 0, 2), "DIAGONAL": (1, 1, 1)}[node.bands_direction]
        phase = 10.0 * at @ np.array(axes, dtype=np.float64)
    else:
        axes = {"X": (0, 1, 1), "Y": (1, 0, 1), "Z": (1, 1, 0), "SPHERICAL": (1, 1, 1)}[node.rings_direction]
        phase = 20.0 * np.linalg.norm(at * axes, axis=1)
    phase = phase + number(node.inputs["Phase Offset"], places)
    bent = number(node.inputs["Distortion"], places)
    if bent.any():
        detail = min(max(_even(node, "Detail", places), 0.0), 15.0)
        turbulence = noise.fbm(at * number(node.inputs["Detail Scale"], places)[:, None], detail + 1.0,
                               max(_even(node, "Detail Roughness", places), 0.0), 2.0, True)
        phase = phase + bent * (2.0 * turbulence - 1.0)
    turns = phase / (2.0 * np.pi)
    if node.wave_profile == "SIN":
        return 0.5 + 0.5 * np.sin(phase - 0.5 * np.pi)
    if node.wave_profile == "SAW":
        return turns - np.floor(turns)
    return 2.0 * np.abs(turns - np.floor(turns + 0.5))


# What one step more of Magic makes of which of x, y and z: the function, its sign, and the signs of the three.
_MAGIC = ((1, np.cos, -1, (1, -1, 1)), (0, np.cos, 1, (1, -1, -1)), (2, np.sin, 1, (-1, -1, -1)),
          (0, np.cos, -1, (-1, 1, -1)), (1, np.sin, -1, (-1, 1, 1)), (1, np.cos, -1, (-1, 1, 1)),
          (0, np.cos, 1, (1, 1, 1)), (2, np.sin, 1, (1, 1, -1)), (0, np.cos, -1, (-1, -1, 1)),
          (1, np.sin, -1, (1, -1, 1)))


@follow("TEX_MAGIC")
def _magic(node, socket, places):
    at = np.fmod(vector(node.inputs["Vector"], places, "generated"), 2.0 * np.pi)
    scale, bent = (number(node.inputs[name], places) for name in ("Scale", "Distortion"))
    x, y, z = at.T * 5.0 * scale
    made = [np.sin(x + y + z), np.cos(-x + y - z), -np.cos(-x - y + z)]
    if node.turbulence_depth > 0:
        made = [each * bent for each in made]
    for into, function, sign, signs in _MAGIC[:node.turbulence_depth]:
        made[into] = bent * sign * function(sum(own * each for own, each in zip(signs, made)))
    doubled = np.where(bent != 0.0, 2.0 * bent, 1.0)
    made = 0.5 - np.stack(made, axis=1) / doubled[:, None]
    return made.mean(axis=1) if socket.identifier == "Fac" else made
