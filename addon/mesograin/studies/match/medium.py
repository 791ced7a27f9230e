# A grain's medium as numbers that a search can walk in, and back to its coefficients.
"""See `Medium`.

A picture tells a medium's colour and how far light goes in it apart from each other, but sigma_a and sigma_s hardly: so
the search walks in log(sigma_s' / sigma_a) and in the log of the reduced mean free path 1 / (sigma_a + sigma_s'), with
sigma_s' = (1 - g) sigma_s (similarity: van de Hulst, "Multiple Light Scattering", 1980, section 14.1). Both are steps
of alike size anywhere, and what similarity leaves of g is apart from both.
"""

import numpy

from ...scene import thick_layer
from .choices import COEFFICIENTS, PARAMETERS

CHANNELS = 3

BALANCES = (-7.0, 14.0)
"""Least and most of log(sigma_s' / sigma_a): a grain all black, and one that absorbs a millionth."""
THICKEST = 50.0
"""Mean free paths in a grain's radius, from where on more look the same; and radii in one, where it is clear."""
REACH = 8.0
"""How far the log of a single coefficient may go from where it starts: a factor of 3000."""
MOST_G = 0.95
STEP = 0.03
"""Of a difference quotient: large against what is left of noise, small against what bends."""
NOISY_STEP = 0.4
"""The same where light goes from grain to grain: rays are drawn anew for each medium, and a block is off by that as
much as a step of 0.03 changes it."""

STEP_BESIDE_G = 0.3
"""The same, of each unknown, where g is one of them: models look g up in tables, whose steps are as much as a step of
0.03 changes a picture in the direction in which g and the other coefficients are hardly told apart."""


class Medium:
    """What is searched for, and what stays.

    parameters: of choices.PARAMETERS, searched for. given: {'sigma_a', 'sigma_s': three numbers per unit of length,
    'g', 'eta', 'boundary'}, of which those stay that are not searched for. exposure: whether a factor for the whole
    picture is searched for, too. step: of difference quotients.

    A state is a vector: for each channel its unknowns, then g, then the log of the exposure, where these are searched
    for.
    """

    def __init__(self, parameters, given, exposure=False, step=STEP):
        self.parameters = tuple(name for name in PARAMETERS if name in parameters)
        self.exposed, self._step = exposure, step
        self._given = given
        self._each = [name for name in COEFFICIENTS if name in parameters]
        self._shared = [*(["g"] if "g" in parameters else []), *(["exposure"] if exposure else [])]
        self.size = CHANNELS * len(self._each) + len(self._shared)

    @property
    def pattern(self):
        """(channels, unknowns) bool: which channels of a picture an unknown changes."""
        each = len(self._each)
        pattern = numpy.ones((CHANNELS, self.size), bool)
        pattern[:, :CHANNELS * each] = numpy.repeat(numpy.eye(CHANNELS, dtype=bool), each, axis=1)
        return pattern

    @property
    def steps(self):
        """Of the difference quotients."""
        return numpy.full(self.size, max(self._step, STEP_BESIDE_G) if "g" in self._shared else self._step)

    @property
    def place_of_g(self):
        """Which unknown g is, or None."""
        return CHANNELS * len(self._each) if "g" in self._shared else None

    def limits(self, start, size):
        """(least, most) of each unknown, for a search from `start` in grains of this size."""
        least, most = start - REACH, start + REACH
        if len(self._each) == 2:
            least[0:CHANNELS * 2:2], most[0:CHANNELS * 2:2] = BALANCES
            least[1:CHANNELS * 2:2], most[1:CHANNELS * 2:2] = numpy.log([size / THICKEST, size * THICKEST])
        if "g" in self._shared:
            place = CHANNELS * len(self._each)
            least[place], most[place] = -MOST_G, MOST_G
        return least, most

    def state(self, sigma_a, sigma_s, g=None, exposure=1.0):
        """The vector of these coefficients."""
        g = self._given["g"] if g is None else g
        reduced = thick_layer.rest(g) * numpy.asarray(sigma_s, float)
        absorbed = numpy.asarray(sigma_a, float)
        if len(self._each) == 2:
            balances = numpy.log(numpy.maximum(reduced, 1e-12) / numpy.maximum(absorbed, 1e-12))
            each = numpy.stack([numpy.clip(balances, *BALANCES), -numpy.log(reduced + absorbed)], axis=1)
        else:
            chosen = {"sigma_a": absorbed, "sigma_s": numpy.asarray(sigma_s, float)}
            each = numpy.log(numpy.maximum([chosen[name] for name in self._each], 1e-12)).reshape(-1, CHANNELS).T
        shared = {"g": g, "exposure": numpy.log(exposure)}
        return numpy.concatenate([each.ravel(), [shared[name] for name in self._shared]])

    def coefficients(self, state):
        """{'sigma_a', 'sigma_s': tuples of three, 'g'} of a vector."""
        shared = self._shared_of(state)
        g = shared.get("g", self._given["g"])
        each = numpy.asarray(state[:CHANNELS * len(self._each)]).reshape(CHANNELS, -1)
        values = {name: tuple(float(channel) for channel in self._given[name]) for name in COEFFICIENTS}
        if len(self._each) == 2:
            extinctions = numpy.exp(-each[:, 1])
            absorbed = 1.0 / (1.0 + numpy.exp(each[:, 0]))
            values["sigma_a"] = tuple((extinctions * absorbed).tolist())
            values["sigma_s"] = tuple((extinctions * (1.0 - absorbed) / thick_layer.rest(g)).tolist())
        elif self._each:
            values[self._each[0]] = tuple(numpy.exp(each[:, 0]).tolist())
        return {**values, "g": float(g)}

    def exposure(self, state):
        """The factor of the picture's brightness over the scene's."""
        return float(numpy.exp(self._shared_of(state).get("exposure", 0.0)))

    @property
    def has_colour(self):
        """Whether colour and mean free path are searched for, rather than one coefficient."""
        return len(self._each) == 2

    def near(self):
        """Vectors around what is given, to look at first."""
        given = {name: numpy.array(self._given[name], float) for name in COEFFICIENTS}
        factors = numpy.exp(numpy.linspace(-3.0, 3.0, 5)) if self._each else [1.0]
        return [self.state(**{**given, **{name: factor * given[name] for name in self._each}}) for factor in factors]

    def coloured(self, colour, path):
        """The vector of a medium of this thick-layer colour, three numbers, and this reduced mean free path."""
        given = self._given
        sigma_a, sigma_s = thick_layer.coefficients(
            tuple(float(channel) for channel in colour), (path,) * CHANNELS, given["g"], given["eta"],
            given["boundary"])
        return self.state(sigma_a, sigma_s)

    def with_exposure(self, state, exposure):
        """The vector with another exposure, where that is searched for."""
        if not self.exposed:
            return state
        return numpy.append(state[:-1], numpy.log(exposure))

    def told(self, state, covariance):
        """{name: [(value, standard deviation of its log)] of each channel} of what a picture may determine: those
        searched for, and the mean free path; of g, one pair, whose deviation is of g itself."""
        values = self.coefficients(state)
        paths = thick_layer.mean_free_paths(values["sigma_a"], values["sigma_s"], values["g"])
        found = {}
        for name, slopes in self._slopes(state, values).items():
            deviations = [float(numpy.sqrt(max(slope @ covariance @ slope, 0.0))) for slope in slopes]
            value = {**values, "mean_free_path": paths, "exposure": (self.exposure(state),)}[name]
            found[name] = list(zip(value if isinstance(value, tuple) else (value,), deviations))
        return found

    def _slopes(self, state, values):
        """{name: rows of the derivative of its log, of g itself, by the state}."""
        slopes = {}
        unit = numpy.eye(self.size)
        each = len(self._each)
        by_g = unit[CHANNELS * each] / thick_layer.rest(values["g"]) if "g" in self._shared else numpy.zeros(self.size)
        if each == 2:
            balance, path = unit[0:CHANNELS * 2:2], unit[1:CHANNELS * 2:2]
            scattered = 1.0 / (1.0 + numpy.exp(-numpy.asarray(state[0:CHANNELS * 2:2])))[:, None]
            slopes["sigma_a"] = -scattered * balance - path
            slopes["sigma_s"] = (1.0 - scattered) * balance - path + by_g
            slopes["mean_free_path"] = path
        elif each:
            slopes[self._each[0]] = unit[:CHANNELS]
        for number, name in enumerate(self._shared):
            slopes[name] = unit[CHANNELS * each + number:][:1]
        return slopes

    def _shared_of(self, state):
        return dict(zip(self._shared, state[CHANNELS * len(self._each):]))
