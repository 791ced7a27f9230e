# The grains that can be made: each kind a function of a seed, of how finely it is divided and of its habit.
import numpy as np

from . import shape

EDGE = 80.0
"""How sharp the edges of a crystal are; see `_cut`."""


def sand(random, segments, angularity, roundness):
    """A pebble cut by planes and worn. Its axes are as those of natural sands: S/I .77, I/L .76 on average."""
    ball = shape.sphere(segments)
    normals = random.normal(size=(14, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    distances = 1.0 - angularity * random.uniform(0.1, 0.45, len(normals))
    radius = _cut(ball.vertices, normals, distances, 8.0 + 50.0 * (1.0 - roundness) ** 2)
    worn = _waves(ball.vertices, 2.5, random) + 0.5 * _waves(ball.vertices, 7.0, random)
    radius += 0.05 * (1.0 - 0.6 * roundness) * worn
    middle = float(np.clip(random.normal(0.76, 0.06), 0.6, 0.92))
    short = middle * float(np.clip(random.normal(0.77, 0.06), 0.6, 0.92))
    return ball.moved(ball.vertices * radius[:, None] * (1.0, middle, short))


def salt(random, segments, angularity, roundness):
    """A cube whose edges are worn."""
    edge = 0.02 + 0.5 * roundness
    turns = max(segments // 4, 2)
    bow = np.tan(np.linspace(0.0, np.pi / 4.0, turns + 1))
    flat = np.linspace(-1.0 + edge, 1.0 - edge, max(segments - 2 * turns, 1) + 1)
    block = shape.cube(np.concatenate((-1.0 + edge - edge * bow[:0:-1], flat, 1.0 - edge + edge * bow[1:])))
    inner = np.clip(block.vertices, -1.0 + edge, 1.0 - edge)
    outwards = block.vertices - inner
    vertices = inner + edge * outwards / np.linalg.norm(outwards, axis=1)[:, None]
    worn = 1.0 + 0.02 * angularity * _waves(vertices, 1.5, random)
    return block.moved(vertices * worn[:, None] * random.uniform(0.92, 1.0, 3))


def sugar(random, segments, angularity, roundness):
    """A monoclinic crystal of sucrose, with the faces a, c, r, p and q that are found on most of them."""
    ball = shape.sphere(segments)
    beta = np.radians(103.5)  # between the axes a and c
    c_star, a_star = np.array((0.0, 0.0, 1.0)), np.array((np.sin(beta), 0.0, -np.cos(beta)))
    b_axis = np.array((0.0, 1.0, 0.0))
    faces = [(a_star, 0.55), (c_star, 0.68), (a_star - c_star, 0.72), (a_star + 0.9 * b_axis, 0.82),
             (a_star - 0.9 * b_axis, 0.82), (c_star + 0.8 * b_axis, 0.86), (c_star - 0.8 * b_axis, 0.86)]
    normals = np.array([sign * normal / np.linalg.norm(normal) for normal, _ in faces for sign in (1.0, -1.0)])
    distances = np.array([distance for _, distance in faces for _ in range(2)])
    distances *= 1.0 + 0.25 * angularity * random.uniform(-0.5, 0.5, len(distances))
    radius = _cut(ball.vertices, normals, distances, EDGE * (1.0 - 0.85 * roundness))
    return ball.moved(ball.vertices * radius[:, None] * (1.0, 1.25, 1.0))


def snow(random, segments, angularity, roundness):
    """A plate of six arms. angularity: how far the arms stand out of the plate."""
    plate = shape.cube(np.linspace(-1.0, 1.0, segments + 1))
    x, y, z = plate.vertices.T
    # The cube's top and bottom become the plate, its sides the rim.
    square = np.maximum(np.abs(x), np.abs(y))
    angle = np.arctan2(y, x)
    from_arm = np.abs((angle / (np.pi / 3.0) + 0.5) % 1.0 - 0.5) * 2.0
    core, width = 1.0 - 0.65 * angularity, random.uniform(0.18, 0.3)
    arms = np.exp(-(from_arm / width) ** 2) + random.uniform(0.15, 0.35) * np.exp(-((from_arm - 0.55) / 0.12) ** 2)
    hexagon = np.cos(np.pi / 6.0) / np.cos((from_arm - 1.0) * np.pi / 6.0)
    reach = core * hexagon + (1.0 - core) * np.minimum(arms, 1.0)
    thickness = random.uniform(0.06, 0.1) * (1.0 + roundness)
    rise = z * np.sqrt(1.0 - 0.6 * square ** 8)
    out = square * reach
    return plate.moved(np.stack((out * np.cos(angle), out * np.sin(angle), thickness * rise), axis=-1))


def rounded_snow(random, segments, angularity, roundness):
    """Old snow: a grain that has sintered and rounded."""
    ball = shape.sphere(segments)
    radius = 1.0 + (0.05 + 0.12 * angularity) * (1.0 - 0.5 * roundness) * _waves(ball.vertices, 1.6, random)
    return ball.moved(ball.vertices * radius[:, None] * random.uniform(0.8, 1.0, 3))


def rice(random, segments, angularity, roundness):
    """A long grain, blunt at one end and slightly bent."""
    ball = shape.sphere(segments)
    x, y, z = ball.vertices.T
    slender = 0.36 - 0.06 * angularity + 0.1 * roundness
    blunt = 1.0 + 0.12 * x - 0.1 * x ** 2
    bend = random.uniform(0.05, 0.12) * (1.0 - x ** 2)
    thick = slender * blunt
    return ball.moved(np.stack((x, thick * y, thick * random.uniform(0.85, 1.0) * z + bend), axis=-1))


def bead(_random, segments, _angularity, _roundness):
    """A ball of glass."""
    return shape.sphere(segments)


KINDS = {"sand": sand, "salt": salt, "sugar": sugar, "snow": snow, "rounded_snow": rounded_snow, "rice": rice,
         "bead": bead}


def make(kind, seed=0, segments=16, angularity=0.5, roundness=0.3):
    """shape.Shape of one of KINDS, as large as the unit sphere. segments: divisions along each of its charts.
    angularity, roundness: 0 to 1."""
    random = np.random.default_rng([seed, list(KINDS).index(kind)])
    return KINDS[kind](random, segments, angularity, roundness).of_unit_volume()


def _cut(directions, normals, distances, sharpness):
    """How far a body reaches that planes cut out of a ball somewhat larger than the unit sphere: nearly the least of
    their distances along each direction, the more so the larger `sharpness` is."""
    facing = np.maximum(directions @ normals.T, 0.0) / distances
    return ((facing ** sharpness).sum(axis=1) + 1.12 ** -sharpness) ** (-1.0 / sharpness)


def _waves(places, frequency, random, count=16):
    """Noise of about this frequency, of variance 1/2: plane waves of random directions (a random Fourier series)."""
    directions = random.normal(size=(count, 3))
    directions *= frequency / np.linalg.norm(directions, axis=1)[:, None]
    phases = random.uniform(0.0, 2.0 * np.pi, count)
    return np.cos(places @ directions.T + phases).sum(axis=1) / np.sqrt(count)
