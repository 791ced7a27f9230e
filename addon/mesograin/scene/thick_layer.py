# The colour of a layer without end, and the coefficients that a medium needs to have it.
"""A grain said as artists say it: by the colour of a thick layer of its medium, and by how far light goes in it."""

import functools
import math

from .. import native_module

SHORTEST, LONGEST = 1e-6, 1e6
"""Mean free paths in mm, as far as they can be told; what scatters and absorbs nothing has the longest."""

WHITEST = 0.999
"""The lightest colour that is looked for: from here on the albedo changes in its seventh digit."""

NEAR_ENOUGH = 1e-6
MOST_STEPS = 40

# Of 1 - g: nearer to 1 than this, g is no longer told from it.
LEAST_REST = 1e-3


def rest(g):
    """What similarity leaves of scattering, 1 - g."""
    return max(1.0 - g, LEAST_REST)


def reduced(sigma_a, sigma_s, g):
    """(reduced extinctions, reduced albedos) of each channel."""
    extinctions = [a + rest(g) * s for a, s in zip(sigma_a, sigma_s)]
    return extinctions, [rest(g) * s / t if t > 0.0 else 0.0
                         for s, t in zip(sigma_s, extinctions)]


def mean_free_paths(sigma_a, sigma_s, g, scale=1.0):
    """Reduced mean free paths of each channel, in the length that the coefficients are per."""
    return tuple(min(max(1.0 / (t * scale), SHORTEST), LONGEST) if t * scale > 0.0 else LONGEST
                 for t in reduced(sigma_a, sigma_s, g)[0])


@functools.lru_cache(maxsize=256)
def colour(albedos, eta, boundary):
    """What a layer without end sends back of the light that enters it from everywhere, for three reduced albedos; g by
    similarity. Where nothing is absorbed that is white, whatever the interface."""
    return tuple(channel / white for channel, white in zip(_sent_back(albedos, eta, boundary),
                                                           _sent_back((1.0, 1.0, 1.0), eta, boundary)))


@functools.lru_cache(maxsize=256)
def _sent_back(albedos, eta, boundary):
    native = native_module.get()
    sigma_a = [1.0 - albedo for albedo in albedos]
    return native.half_space_albedo(
        native.Material(model="model_1", sigma_a=sigma_a, sigma_s=albedos, eta=eta, boundary=boundary))


def albedos_of_colour(wanted, eta, boundary):
    """The reduced albedos of a layer of this colour, by false position over sqrt(1 - albedo), in which the colour of a
    light layer is nearly straight; three channels at a time."""
    channels = [_Bracket(min(max(channel, 0.0), WHITEST)) for channel in wanted]
    for _ in range(MOST_STEPS):
        albedos = tuple(1.0 - channel.guess()**2 for channel in channels)
        if all([channel.narrow(found) for channel, found in zip(channels, colour(albedos, eta, boundary))]):
            break
    return tuple(1.0 - channel.found**2 for channel in channels)


class _Bracket:
    """Of one channel: a root of wanted less found, between a light layer at 0 and a dark one at 1 (Dowell and Jarratt,
    "A modified regula falsi method", 1971: the Illinois algorithm)."""

    def __init__(self, wanted):
        self.wanted = wanted
        self.found = 1.0
        self._ends = [(0.0, wanted - 1.0), (1.0, wanted)]
        self._last = None

    def guess(self):
        (light, above), (dark, below) = self._ends
        self.found = dark if below == 0.0 else (light * below - dark * above) / (below - above)
        return self.found

    def narrow(self, colour):
        """Takes the colour at the last guess; whether that is near enough."""
        missing = self.wanted - colour
        side = int(missing > 0.0)
        if side == self._last:  # the other end has stayed: it counts half
            place, value = self._ends[1 - side]
            self._ends[1 - side] = (place, 0.5 * value)
        self._ends[side] = (self.found, missing)
        self._last = side
        return abs(missing) < NEAR_ENOUGH


def coefficients(wanted, paths, g, eta, boundary):
    """(sigma_a, sigma_s) of a medium of this colour and these reduced mean free paths."""
    albedos = albedos_of_colour(wanted, eta, boundary)
    return (tuple((1.0 - albedo) / path for albedo, path in zip(albedos, paths)),
            tuple(albedo / (path * rest(g)) for albedo, path in zip(albedos, paths)))


def thickness(sizes, paths):
    """How many mean free paths a grain is thick that is this long along each axis: the cube root of its box's volume
    over the middle channel's path. 0 for what is flat."""
    return math.prod(sizes) ** (1.0 / 3.0) / sorted(paths)[1]


def looks(thick):
    """What light does in a grain so many mean free paths thick."""
    if thick < 1.0:
        return "light passes nearly unhindered, it looks clear"
    if thick < 6.0:
        return "light shines through all of it"
    if thick < 30.0:
        return "light shines through its rim"
    return "light leaves near where it enters, it looks solid"
