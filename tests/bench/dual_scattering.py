"""What dual scattering makes of a heap of 696 balls beside light that is exchanged: totals and blocks, against path
tracing.

    dual_scattering.py BUILD_FOLDER [--kinds K ...] [--lights L ...] [--samples N] [--paths N]

Zinke, Yuksel, Weber and Keyser, "Dual scattering approximation for fast multiple scattering in hair", 2008: light
that comes to a ball through n others is left a_f^n, what a ball sends on forwards (eq. 5), and spread; what comes back
from those behind is A_b of it, by a_b, what one throws back (eq. 14, 16). Both are weighed by a density, d_f and d_b
there, 0.7 or 1. What one ball alone does with the light that meets it is taken from the path tracer, so that all that
is off is the approximation's own; it is told in green, and so is what is drawn by View with exchange order_1 and heaps.
Rays: of dual scattering to each direction of light, each through all balls on its way; of the exchange in all, most of
them to the next ball. Kinds without a surface that refracts; prints a line for each.
"""
import argparse
import pathlib
import sys
import tempfile

import heap_light
import numpy

WALKS = 100_000
RAYS = 16  # of each ball, to each direction of light
DENSITIES = (0.7, 1.0)
SKY_DIRECTIONS = 64
# Of what leaves a ball forwards or backwards, about evenly in a lobe: the mean cosine.
SPREAD = 2.0 / 3.0


def lobe(normals, random):
    """Directions in cosine lobes about unit vectors (n, 3)."""
    directions = random.normal(size=normals.shape)
    directions /= numpy.linalg.norm(directions, axis=1, keepdims=True)
    directions += normals * (1.0 + 1e-9)
    return directions / numpy.linalg.norm(directions, axis=1, keepdims=True)


class Ball:
    """What a ball of a material does to light that comes from +z, as shares of what meets its disk. thickness: mean
    free paths to the radius, infinite if opaque. through: unscattered; forwards, backwards: scattered, with
    `through` in forwards; scattered, slope: what leaves otherwise, and the same times the cosine between the light's
    direction and the place that it leaves at."""

    def __init__(self, material):
        random = numpy.random.default_rng(3)
        radius = numpy.sqrt(random.random(WALKS))
        azimuth = 2.0 * numpy.pi * random.random(WALKS)
        place = numpy.stack([radius * numpy.cos(azimuth), radius * numpy.sin(azimuth), numpy.sqrt(1.0 - radius**2)], -1)
        if material["kind"] == "diffuse":
            self.thickness, self.through = numpy.inf, 0.0
            left, weight, direction = place, numpy.full(WALKS, material["reflectance"]), lobe(place, random)
        else:
            sigma_s, sigma_a = (float(numpy.broadcast_to(material[name], 3)[1]) for name in ("sigma_s", "sigma_a"))
            self.thickness = sigma_s + sigma_a
            left, weight, direction = self.walked(place, sigma_s / self.thickness, random)
            self.through = float(numpy.exp(-2.0 * self.thickness * place[:, 2]).mean())
        self.scattered = float(weight.sum() / WALKS)
        self.slope = float((weight * left[:, 2]).sum() / WALKS)
        self.backwards = float((weight * (direction[:, 2] > 0.0)).sum() / WALKS)
        self.forwards = self.through + self.scattered - self.backwards

    def walked(self, place, albedo, random):
        """Where what was scattered leaves, its weight and whereto."""
        place, direction = place.copy(), numpy.tile([0.0, 0.0, -1.0], (len(place), 1))
        weight, met = numpy.ones(len(place)), numpy.zeros(len(place), bool)
        left, inside = numpy.zeros_like(place), numpy.arange(len(place))
        while inside.size:
            at, along = place[inside], direction[inside]
            toward = (at * along).sum(1)
            chord = -toward + numpy.sqrt(numpy.maximum(toward**2 + 1.0 - (at**2).sum(1), 0.0))
            flight = random.exponential(1.0 / self.thickness, inside.size)
            leaves = flight >= chord
            left[inside[leaves]] = (at + chord[:, None] * along)[leaves]
            inside, flight = inside[~leaves], flight[~leaves]
            place[inside] += flight[:, None] * direction[inside]
            evenly = random.normal(size=(inside.size, 3))
            direction[inside] = evenly / numpy.linalg.norm(evenly, axis=1, keepdims=True)
            weight[inside] *= albedo
            met[inside] = True
            faint = weight[inside] < 1e-3
            weight[inside[faint]] = 0.0
            inside = inside[~faint]
        return left, weight * met, direction

    def back(self):
        """Of light that comes to a ball, what comes back to it from those behind it."""
        square = self.forwards**2
        once = self.backwards * square / (1.0 - square)
        return once + self.backwards**3 * square / (1.0 - square) ** 3


def crossed(origins, to_light, balls, of):
    """Of rays (n, 3) from the balls `of` (n,): how many others each meets, and the sum of its chords."""
    counts, chords = numpy.zeros(len(origins), int), numpy.zeros(len(origins))
    for first in range(0, len(origins), 1024):
        piece = slice(first, first + 1024)
        aside = balls[None, :, :3] - origins[piece, None]
        along = aside @ to_light
        half = balls[:, 3] ** 2 - (aside**2).sum(-1) + along**2
        meets = (half > 0.0) & (along > 0.0)
        meets[numpy.arange(meets.shape[0]), of[piece]] = False
        counts[piece] = meets.sum(1)
        chords[piece] = 2.0 * numpy.sqrt(numpy.where(meets, half, 0.0)).sum(1)
    return counts, chords


def directions_of(light):
    """(directions to it (n, 3), their irradiances (n,))."""
    if light["type"] == "distant":
        return numpy.array([light["direction_to_light"]]), numpy.array([numpy.pi])
    random = numpy.random.default_rng(4)
    height = (numpy.arange(SKY_DIRECTIONS) + random.random(SKY_DIRECTIONS)) / SKY_DIRECTIONS
    azimuth = numpy.pi * (1.0 + 5.0**0.5) * numpy.arange(SKY_DIRECTIONS)
    across = numpy.sqrt(1.0 - height**2)
    return (numpy.stack([across * numpy.cos(azimuth), across * numpy.sin(azimuth), height], -1),
            numpy.full(SKY_DIRECTIONS, 2.0 * numpy.pi / SKY_DIRECTIONS))


def sent(ball, balls, light, density):
    """Of each ball what it sends out, radiance: (mean (n,), slope over its normals (n, 3)), but for what one alone
    makes of light that comes unscattered."""
    random = numpy.random.default_rng(5)
    mean, slope = numpy.zeros(len(balls)), numpy.zeros((len(balls), 3))
    of = numpy.repeat(numpy.arange(len(balls)), RAYS)
    for to_light, irradiance in zip(*directions_of(light)):
        origins = balls[of, :3] + balls[of, 3:] * 1.0001 * lobe(numpy.tile(to_light, (len(of), 1)), random)
        counts, chords = crossed(origins, to_light, balls, of)
        forwards = numpy.where(counts > 0, density * ball.forwards ** counts, 1.0)
        unscattered = numpy.where(counts > 0, numpy.exp(-ball.thickness * numpy.maximum(chords, 1e-9)), 1.0)
        more = numpy.maximum((forwards - unscattered).reshape(-1, RAYS).mean(1), 0.0)
        behind = density * ball.back() * forwards.reshape(-1, RAYS).mean(1)
        mean += irradiance / (4.0 * numpy.pi) * ball.scattered * (more + behind)
        slope += irradiance / (4.0 * numpy.pi) * 3.0 * ball.slope * SPREAD * (more - behind)[:, None] * to_light
    return mean, slope


def picture(ball, balls, light, density):
    """(h, w): what is drawn of that, straight through balls that let it."""
    seen = heap_light.MANIFEST["camera"]
    width, height = heap_light.SIZE
    right, up, forwards = (numpy.array(seen[name], float) for name in ("right", "up", "direction"))
    x = ((numpy.arange(width) + 0.5) / width * 2.0 - 1.0) * seen["half_width"]
    y = (1.0 - (numpy.arange(height) + 0.5) / height * 2.0) * seen["half_height"]
    origins = (numpy.array(seen["centre"]) + x[None, :, None] * right + y[:, None, None] * up).reshape(-1, 3)
    mean, slope = sent(ball, balls, light, density)
    found = numpy.zeros(len(origins))
    met = 1.0 - ball.through
    for pixel, origin in enumerate(origins - 60.0 * forwards):
        aside = balls[:, :3] - origin
        along = aside @ forwards
        half = balls[:, 3] ** 2 - (aside**2).sum(1) + along**2
        hits = numpy.flatnonzero(half > 0.0)
        left = 1.0
        for number in hits[numpy.argsort(along[hits] - numpy.sqrt(half[hits]))][:6]:
            reach = numpy.sqrt(half[number])
            normal = (origin + (along[number] - reach) * forwards - balls[number, :3]) / balls[number, 3]
            chord = 2.0 * reach / balls[number, 3]
            crossing = 0.0 if numpy.isinf(ball.thickness) else numpy.exp(-ball.thickness * chord)
            found[pixel] += left * (1.0 - crossing) / met * (mean[number] + slope[number] @ normal)
            left *= crossing
    return numpy.maximum(found, 0.0).reshape(height, width)


def main():
    kinds = [kind for kind, material in heap_light.KINDS.items() if "eta" not in material]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the folder of the native module and of the referee")
    parser.add_argument("--kinds", nargs="+", default=kinds, choices=kinds, metavar="K",
                        help=f"of grains: {', '.join(kinds)} (default: all)")
    parser.add_argument("--lights", nargs="+", default=heap_light.LIGHTS, choices=heap_light.LIGHTS)
    parser.add_argument("--samples", type=int, default=16, help="of each picture (default: 16)")
    parser.add_argument("--paths", type=int, default=64, help="of the truth, a pixel (default: 64)")
    options = parser.parse_args()
    sys.path.insert(0, options.build)
    import mesograin_native as native

    referee = pathlib.Path(options.build) / "tests/referee/mesograin-referee"
    balls = numpy.loadtxt(heap_light.DATA / "spheres.csv", delimiter=",", skiprows=1)
    for kind in options.kinds:
        material = heap_light.KINDS[kind]
        ball = Ball(material)
        for name in options.lights:
            light = heap_light.light_of(name, material)
            with tempfile.TemporaryDirectory() as folder:
                right, noise, own = heap_light.truth(native, referee, material, light, options.paths,
                                                     pathlib.Path(folder))
            green = right[..., 1:2]
            line = [f"{kind:<16}{name:<5}truth's noise {noise:.1%}", told("alone", own, green)]
            line += [told(f"dual {density}", own + picture(ball, balls, light, density)[..., None], green)
                     for density in DENSITIES]
            model = "lambert" if material["kind"] == "diffuse" else "model_2"
            for exchange in ("order_1", "heaps"):
                _, found = heap_light.measure(native, (material, light, (right, noise, None)), model, exchange,
                                              options.samples, "balls")
                line.append(told(exchange, found[..., 1:2], green))
            print("  ".join(line), flush=True)


def told(name, found, right):
    total, blocks = heap_light.how_far(found, right)
    return f"{name} {total:.2f} {blocks:.1%}"


if __name__ == "__main__":
    main()
