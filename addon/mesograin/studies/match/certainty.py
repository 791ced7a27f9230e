# How well a picture determines what was found in it: from the derivatives, and from what is left unexplained.
"""See `covariance`."""

import numpy

from . import least_squares

UNKNOWING = 3.0
"""Standard deviation of what a picture says nothing about: a factor of twenty."""
RATIO = 3.0
"""What lies between the ends of an interval, as a factor, where a coefficient is still called determined."""
SCARCE = 0.1
"""Of scattering: an absorption that is certainly less is told by that."""
PATTERNS = 4
"""Of so many smooth patterns over a grain a model's error is made: brighter, from one side to the other, from the top
to the bottom, from the middle to the rim. docs/match.md has how often intervals hold the truth by that."""
LEAST_ERROR = 0.005
"""What a model is off in each of them at least, a part of the picture: docs/accuracy.md. Of a picture by a model that
errs alike, as model_2 and model_3 do of spheres, a fit shows less."""
G_RANGE = 0.5
"""The same of g, as a difference."""


def covariance(fit, pattern, tiles, even, noise, smooth, unsteady=0.0, least_error=0.0):
    """(unknowns, unknowns): of the state of a least_squares.Fit, with the pattern that it was found with.

    The sum of four: what the residuals' size lets expect of independent errors (Gauss and Newton's); what the state
    would change by if parts of the picture were left out in turn (the delete-a-group jackknife: Efron and Tibshirani,
    "An Introduction to the Bootstrap", 1993, section 11.5; to first order, without a render), which sees errors that
    neighbours share; and what it would change by if the whole picture were brighter or darker by as much as its blocks
    are off in the mean, which no residual shows; and what the model's own error is, which other unknowns imitate as
    well as any picture (Kennedy and O'Hagan, "Bayesian calibration of computer models", 2001, section 4.2): in each of
    its PATTERNS it is as large as in those that are left over, and as `least_error`, a part of the picture.
    tiles: (n,), the part of each residual. even: (channels, n), the residuals of a picture twice as bright, less those
    of this one. noise: (channels, n), the mean square of each residual by noise alone. smooth: as fit.jacobian, of a
    model whose differences are no steps of a table.
    unsteady: the sum of squares by which the model goes in steps, an error as any other of its.
    """
    total = numpy.zeros((pattern.shape[1],) * 2)
    for unknowns, channels in least_squares.parts(pattern):
        rows = fit.jacobian[channels][..., unknowns]
        total[numpy.ix_(unknowns, unknowns)] = _covariance(
            rows, fit.residuals[channels], tiles, even[channels])
        total[numpy.ix_(unknowns, unknowns)] += _imitated(
            smooth[channels][..., unknowns], fit.residuals[channels], noise[channels], unsteady,
            least_error**2 * numpy.mean(numpy.sum(even[channels]**2, axis=1)))
    return total


def _imitated(jacobian, residuals, noise, unsteady, least):
    """Of the error of a model that leaves these residuals and such noise. jacobian: (channels, n, unknowns). least: sum
    of squares of a pattern."""
    channels, _, size = jacobian.shape
    rows = jacobian.reshape(-1, size)
    left_over = (max(numpy.sum(residuals**2) - numpy.sum(noise), 0.0) + unsteady) / max(PATTERNS * channels - size, 1)
    return numpy.linalg.inv(rows.T @ rows / max(left_over, least, 1e-12) + numpy.eye(size) / UNKNOWING**2)


def _covariance(jacobian, residuals, tiles, even):
    """jacobian: (channels, n, unknowns), residuals and even: (channels, n)."""
    size = jacobian.shape[-1]
    prior = numpy.eye(size) / UNKNOWING**2
    rows, left = jacobian.reshape(-1, size), residuals.ravel()
    variance = left @ left / max(len(left) - size, 1)
    scaled = numpy.linalg.inv(rows.T @ rows / max(variance, 1e-12) + prior)
    brighter = numpy.abs(left).sum() / numpy.abs(even).sum() * even.ravel()
    moved = numpy.linalg.solve(rows.T @ rows + prior, rows.T @ brighter)
    return scaled + _jackknife(jacobian, residuals, tiles, prior * variance) + numpy.outer(moved, moved)


def _jackknife(jacobian, residuals, tiles, prior):
    size = jacobian.shape[-1]
    groups = numpy.unique(tiles)
    moves = []
    for group in groups:
        kept = tiles != group
        rows, left = jacobian[:, kept].reshape(-1, size), residuals[:, kept].ravel()
        moves.append(-numpy.linalg.solve(rows.T @ rows + prior + 1e-12 * numpy.eye(size), rows.T @ left))
    moves = numpy.array(moves) - numpy.mean(moves, axis=0)
    return (len(groups) - 1) / len(groups) * moves.T @ moves


def interval(name, value, deviation):
    """{'value', 'low', 'high', 'determined', 'bounded'}, two deviations either way; bounded: see `bound`. deviation:
    the standard one of the log, of g itself."""
    if name == "g":
        low, high = max(value - 2.0 * deviation, -1.0), min(value + 2.0 * deviation, 1.0)
        return {"value": value, "low": low, "high": high, "determined": high - low <= G_RANGE, "bounded": False}
    factor = float(numpy.exp(2.0 * deviation))
    return {"value": value, "low": value / factor, "high": value * factor, "determined": factor**2 <= RATIO,
            "bounded": False}


def bound(intervals, sigma_s):
    """The same intervals, {name: [of each channel]}, `bounded` where absorption is too little for the picture to tell
    how much, and certainly little: below SCARCE of a scattering that is known. sigma_s: of each channel."""
    scattering = intervals.get("sigma_s")
    found = []
    for channel, entry in enumerate(intervals.get("sigma_a", ())):
        known = scattering is None or scattering[channel]["determined"]
        little = entry["high"] < SCARCE * sigma_s[channel]
        found.append({**entry, "bounded": bool(not entry["determined"] and known and little)})
    return {**intervals, "sigma_a": found} if found else intervals
