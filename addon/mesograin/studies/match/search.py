# The search for the coefficients whose picture is nearest: where it starts, how it goes, what it found.
"""See `Request` and `search`."""

import hashlib
import json
from dataclasses import dataclass, field

import numpy

from ...schema import models
from . import certainty, least_squares
from .blocks import Blocks
from .medium import NOISY_STEP, STEP, Medium
from .memory import Memory
from .subject import SubjectError

MODEL = "transport"
"""What stands for a model that is left open: the one that is nearest for any shape."""
ROUGH_MODEL = models.PREFERRED
"""What looks for the neighbourhood, where the model itself takes long."""
MOST_ITERATIONS = 8
ROUGH_ITERATIONS = 5
SHARES = (0.1, 0.3, 1.0, 3.0)
"""Mean free paths that are looked at first, as parts of the grain's radius."""
FIRST_COLOUR = 0.5
COLOURS = (0.005, 0.98)
RIM = 2
"""Pixels by which what shows the grains is shrunk."""
LEAST_BLOCKS = 4
ENOUGH = 0.02
"""A correction that moves no unknown by more is the last one."""
TRACED = "traced"


@dataclass(frozen=True)
class Request:
    """parameters: of choices.PARAMETERS. model: of schema.models, or `auto`. exposure: whether the picture's brightness
    is free. keep: (h, w) bool of the target's size, what may count of it, or None. path: of memory.Memory, or None.
    corrections: how often the model is corrected by `trace`, which is asked for the picture of {'sigma_a', 'sigma_s',
    'g'} by whoever made the target, (h, w, 3 or 4), and tells how far it is by a function of a share."""

    parameters: tuple
    model: str
    exposure: bool = False
    keep: numpy.ndarray = None
    path: object = None
    corrections: int = 0
    trace: object = None


@dataclass
class Found:
    """coefficients: {'sigma_a', 'sigma_s', 'g'} per unit of length of the scene, for a `scale` of 1. exposure: by which
    the scene's light is to be multiplied. intervals: {name: [certainty.interval of each channel, or of all]}. picture:
    (h, w, 4), with that exposure; target: (h, w, 3); mask: (h, w) bool; metrics: of native.compare. corrections: how
    many there were; corrected: what the corrected means in blocks are off, None without. renders: how many there were;
    remembered: of these, how many were known from before. converged: whether the search came to its end.
    """

    model: str
    coefficients: dict
    exposure: float
    intervals: dict
    picture: numpy.ndarray
    target: numpy.ndarray
    mask: numpy.ndarray
    metrics: dict
    corrections: int
    corrected: float
    renders: int
    remembered: int
    iterations: int
    converged: bool
    warnings: list = field(default_factory=list)


def model_of(model):
    """The model that is drawn for the one that is asked for."""
    return MODEL if model == models.AUTO.name else model


def steps(request, guess):
    """What `search` will begin if it goes as usual, as comparison.progress.Progress.plan takes it. guess: seconds of a
    picture by the rough model."""
    model = model_of(request.model)
    if model != ROUGH_MODEL:
        rough = 2 * len(SHARES) + 3 * (len(request.parameters) + 1)
        yield from ((f"rough picture {number + 1}", "rough", guess) for number in range(rough))
    yield from ((f"picture {number + 1}", "fine", 3.0 * guess) for number in range(fine_steps(request)))
    for number in range(request.corrections):
        yield from corrected_steps(request, number, guess)


def corrected_steps(request, number, guess):
    """What a correction will begin."""
    yield f"Cycles' picture {number + 1}", TRACED, 60.0 * guess
    yield from (("corrected picture", "fine", 3.0 * guess) for _ in range(2 * (len(request.parameters) + 1)))


def guess(subject):
    """Seconds of a picture of a subject.Subject by the rough model, before there was one."""
    width, height = subject.size
    return 0.3 * subject.samples * width * height * 1e-6


def fine_steps(request):
    """How many pictures the model itself usually draws."""
    first = 2 * len(SHARES) if model_of(request.model) == ROUGH_MODEL else 1
    return first + 3 * (len(request.parameters) + 1)


def search(native, subject, target, request, progress):
    """The Found of the coefficients by which `subject` looks most like `target`.

    subject: subject.Subject. target: target.Target, of the subject's size. progress: comparison.progress.Progress, for
    which `steps` are planned. Raises SubjectError, native.Error or progress.Cancelled. After a KeyboardInterrupt what
    was rendered is in the file of memory.Memory.
    """
    return _Search(native, subject, target, request, progress).run()


class _Search:
    def __init__(self, native, subject, target, request, progress):
        self._native, self._subject, self._target = native, subject, target
        self._request, self._progress = request, progress
        self._model = model_of(request.model)
        given = {**{"g": 0.0}, **subject.values}
        self._medium = Medium(request.parameters, given, request.exposure,
                              NOISY_STEP if subject.lights_itself else STEP)
        if not self._medium.size:
            raise SubjectError("There is nothing to be searched for: name at least one of sigma_a, sigma_s and g.")
        self._size = subject.grain_size
        self._mask = self._choose()
        self._blocks = Blocks(self._mask, target.pixels)
        if len(self._blocks.counts) < LEAST_BLOCKS:
            raise SubjectError(f"Only {int(self._mask.sum())} pixels show the grains wholly; that is too few to tell"
                               " coefficients from: use a larger picture, or move the camera nearer.")
        self._memory = Memory(request.path, self._fingerprint())
        self._renders = self._known = 0
        self._corrections = 0
        self._factors = 1.0  # by which means in blocks are multiplied

    def run(self):
        rough = ROUGH_MODEL if self._model != ROUGH_MODEL else self._model
        state = self._start(rough)
        if rough != self._model:
            state = self._fit(rough, state, ROUGH_ITERATIONS).state
            corrected = sum(len(list(corrected_steps(self._request, number, 0.0)))
                            for number in range(self._request.corrections))
            self._progress.skip_to_last(min(self._progress.steps_left, fine_steps(self._request) + corrected))
        fit = self._fit(self._model, state, MOST_ITERATIONS)
        for number in range(self._request.corrections):
            before = fit.state
            self._corrections += 1
            fit = self._corrected(before, number)
            if numpy.abs(fit.state - before).max() < ENOUGH:
                break
        return self._found(fit)

    def _corrected(self, state, number):
        """The Fit by a model that is multiplied, block by block, by what it is off at `state` (output space mapping:
        Bandler et al., "Space mapping: the state of the art", 2004, section V): it lends no more than its derivatives.
        """
        per_correction = len(list(corrected_steps(self._request, number, 0.0)))
        later = per_correction * (self._request.corrections - number)
        self._progress.skip_to_last(min(self._progress.steps_left, later))
        truth = self._means(TRACED, state)
        own = self._means(self._model, state)
        self._factors = truth / numpy.maximum(own, 1e-6 * own.max(axis=1, keepdims=True))
        return self._fit(self._model, state, MOST_ITERATIONS)

    def _choose(self):
        """(h, w) bool: pixels that show what is matched, and nothing else, in both pictures."""
        covered = self._subject.covered()
        mask = self._native.default_mask(covered, erode=RIM) & self._target.usable
        if self._request.keep is not None:
            mask &= self._request.keep
        if not mask.any():
            seen = int((covered > 0.999).sum())
            raise SubjectError("No pixel is left to be matched: " + (
                "the camera sees no grain of this material." if not seen else
                f"of {seen} that show the grains, the mask, what is white in the picture and a rim of {RIM} pixels"
                " leave none."))
        return mask

    def _fingerprint(self):
        """Of all that means in blocks depend on but model and coefficients: told by a picture of some."""
        some = self._medium.coefficients(self._medium.state(*(numpy.ones(3) / self._size,) * 2))
        digest = hashlib.sha256(self._mask.tobytes())
        digest.update(self._subject.picture(ROUGH_MODEL, some).tobytes())
        return digest.hexdigest()

    def _means(self, model, state):
        """The means in blocks of the picture of a state, at the scene's own exposure."""
        coefficients = self._medium.coefficients(state)
        key = json.dumps([model, coefficients])
        self._renders += 1
        means = self._memory.get(key)
        if means is not None:
            self._known += 1
            return means
        self._begin(model)
        means = self._blocks.of(self._request.trace(coefficients, self._progress.update) if model == TRACED else
                                self._subject.picture(model, coefficients))
        self._progress.end()
        self._memory.add(key, means)
        return means

    def _begin(self, model):
        if not self._progress.steps_left:
            kind = model if model == TRACED else "fine" if model == self._model else "rough"
            self._progress.insert([(f"picture {self._renders}", kind, 1.0)])
        self._progress.begin()

    def _start(self, model):
        """The best of a few vectors by a model, for each channel by itself where these are apart."""
        looked = list(self._colours(model) if self._medium.has_colour else self._near(model))
        costs = numpy.array([numpy.sum(residuals ** 2, axis=1) for _, residuals in looked])
        states = numpy.array([state for state, _ in looked])
        best = states[costs.sum(axis=1).argmin()].copy()
        for unknowns, channels in least_squares.parts(self._medium.pattern):
            best[unknowns] = states[costs[:, channels].sum(axis=1).argmin()][unknowns]
        return best

    def _near(self, model):
        for state in self._medium.near():
            yield self._exposed(state, self._means(model, state))

    def _colours(self, model):
        """Media in which light goes a little to far, each of the colour that would make the picture as bright as the
        target if brightness followed colour."""
        colour = numpy.full(3, FIRST_COLOUR)
        for share in SHARES:
            for _ in range(2):
                state = self._medium.coloured(colour, share * self._size)
                means = self._means(model, state)
                yield self._exposed(state, means)
                counts = self._blocks.counts
                brighter = (self._blocks.means @ counts) / numpy.maximum(means @ counts, 1e-30)
                if self._medium.exposed:
                    brighter *= FIRST_COLOUR / numpy.max(colour * brighter)
                colour = numpy.clip(colour * brighter, *COLOURS)

    def _exposed(self, state, means):
        """(state, residuals) with the exposure that suits these means best, where it is free."""
        blocks = self._blocks
        if self._medium.exposed:
            squares = blocks.weights ** 2
            best = numpy.sum(squares * means * blocks.means) / max(numpy.sum(squares * means ** 2), 1e-30)
            state = self._medium.with_exposure(state, max(best, 1e-12))
        return state, blocks.residuals(means * self._medium.exposure(state))

    def _residuals(self, model):
        seen = {}

        def residuals(state):
            key = json.dumps(self._medium.coefficients(state))
            if key not in seen:  # the exposure alone needs no new picture
                seen[key] = self._means(model, state)
            return self._blocks.residuals(seen[key] * self._factors * self._medium.exposure(state))

        return residuals

    def _fit(self, model, state, iterations):
        medium = self._medium
        return least_squares.minimise(self._residuals(model), state, medium.pattern, medium.steps,
                                      medium.limits(state, self._size), iterations)

    def _found(self, fit):
        medium, native = self._medium, self._native
        blocks = self._blocks
        coefficients, exposure = medium.coefficients(fit.state), medium.exposure(fit.state)
        picture = self._subject.picture(self._model, coefficients)
        picture[..., :3] *= exposure
        noise = blocks.noise(self._target.pixels, picture)
        if self._corrections:
            noise *= 2.0  # Cycles' pictures of both have as much
        spread = certainty.covariance(fit, medium.pattern, blocks.tiles, blocks.means * blocks.weights, noise,
                                      self._smooth_jacobian(fit), self._unsteadiness(fit),
                                      0.0 if self._corrections else certainty.LEAST_ERROR)
        intervals = {name: [certainty.interval(name, value, deviation) for value, deviation in channels]
                     for name, channels in medium.told(fit.state, spread).items()}
        intervals = certainty.bound(intervals, coefficients["sigma_s"])
        return Found(
            model=self._model, coefficients=coefficients, exposure=exposure, intervals=intervals, picture=picture,
            target=self._target.pixels, mask=self._mask,
            metrics=native.compare(picture, self._target.pixels, mask=self._mask), corrections=self._corrections,
            corrected=self._off(fit.residuals) if self._corrections else None, renders=self._renders,
            remembered=self._known, iterations=fit.iterations, converged=fit.converged, warnings=self._subject.warnings)

    def _smooth_jacobian(self, fit):
        """The Jacobian of ROUGH_MODEL at what was found: that of a model with tables may have their steps in it."""
        if self._model == ROUGH_MODEL:
            return fit.jacobian
        residuals = self._residuals(ROUGH_MODEL)
        medium = self._medium
        return least_squares.differences(residuals, fit.state, residuals(fit.state), medium.pattern, medium.steps,
                                         medium.limits(fit.state, self._size)[1])

    def _unsteadiness(self, fit):
        """The sum of squares by which a picture with g a little further is off from what the derivative says: what
        steps of tables hide of g. 0 where g is not searched for."""
        place = self._medium.place_of_g
        if place is None:
            return 0.0
        moved = fit.state.copy()
        moved[place] -= numpy.copysign(STEP, moved[place])
        expected = fit.residuals + fit.jacobian[..., place] * (moved[place] - fit.state[place])
        return float(numpy.sum((self._residuals(self._model)(moved) - expected) ** 2))

    def _off(self, residuals):
        """Relative L1 of means in blocks (docs/metrics.md)."""
        blocks = self._blocks
        return float((numpy.abs(residuals / blocks.weights) @ blocks.counts).sum() /
                     (blocks.means @ blocks.counts).sum())
