# How well a picture determines what was found in it: from the derivatives, and from what is left unexplained.
"""See `covariance`."""

import numpy

from . import least_squares

UNKNOWING = 3.0
"""Standard deviation of what a picture says nothing about: a factor of twenty."""
RATIO = 3.0
"""What lies between the ends of a 95 % interval, as a factor, where a coefficient is still called determined."""
G_RANGE = 0.5
"""The same of g, as a difference."""


def covariance(fit, pattern, tiles, even):
    """(unknowns, unknowns): of the state of a least_squares.Fit, with the pattern that it was found with.

    The sum of three: what the residuals' size lets expect of independent errors (Gauss and Newton's); what the state
    would change by if parts of the picture were left out in turn (the delete-a-group jackknife: Efron and Tibshirani,
    "An Introduction to the Bootstrap", 1993, section 11.5; to first order, without a render), which sees errors that
    neighbours share; and what it would change by if the whole picture were brighter or darker by as much as its blocks
    are off in the mean, which no residual shows. tiles: (n,), the part of each residual. even: (channels, n), the
    residuals of a picture twice as bright, less those of this one.
    """
    total = numpy.zeros((pattern.shape[1],) * 2)
    for unknowns, channels in least_squares.parts(pattern):
        rows = fit.jacobian[channels][..., unknowns]
        total[numpy.ix_(unknowns, unknowns)] = _covariance(
            rows, fit.residuals[channels], tiles, even[channels])
    return total


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
    """{'value', 'low', 'high', 'determined'}: of 95 %. deviation: standard deviation of the log, of g itself."""
    if name == "g":
        low, high = max(value - 2.0 * deviation, -1.0), min(value + 2.0 * deviation, 1.0)
        return {"value": value, "low": low, "high": high, "determined": high - low <= G_RANGE}
    factor = float(numpy.exp(2.0 * deviation))
    return {"value": value, "low": value / factor, "high": value * factor, "determined": factor**2 <= RATIO}
