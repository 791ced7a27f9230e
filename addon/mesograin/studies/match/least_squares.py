# Least squares by steps between Gauss and Newton's and the steepest one, of parts that know nothing of each other.
"""See `minimise`: Levenberg and Marquardt's method (Marquardt, "An algorithm for least-squares estimation of nonlinear
parameters", 1963), its derivatives by differences."""

from dataclasses import dataclass

import numpy

FIRST_DAMPING, LESS, MORE = 1e-2, 0.1, 10.0
LONGEST_STEP = 1.0
"""Of any unknown at once."""
ATTEMPTS = 4
"""Shorter and shorter steps, before a part rests where it is."""
LEAST_CURVATURE = 0.1
"""What holds an unknown in place that the residuals know nothing of."""


@dataclass(frozen=True)
class Fit:
    """state: vector of unknowns. residuals: (channels, n) there. jacobian: (channels, n, unknowns), where the last step
    began. converged: whether the steps became short. iterations: how many Jacobians there were."""

    state: numpy.ndarray
    residuals: numpy.ndarray
    jacobian: numpy.ndarray
    converged: bool
    iterations: int


def minimise(residuals, start, pattern, steps, limits, most_iterations=10, short=0.01):
    """The Fit of least squared residuals, found from `start`.

    residuals: of a vector of unknowns, (channels, n). pattern: (channels, unknowns) bool, which channels an unknown
    changes: what has no channel in common steps by itself, all in one evaluation, and what no channel sees together is
    moved together for the derivatives, by `steps`. limits: (least, most) of each unknown. short: a step that is shorter
    in every unknown is the last one.
    """
    least, most = limits
    state = numpy.clip(start, least, most)
    found = residuals(state)
    apart = parts(pattern)
    damping = numpy.full(len(apart), FIRST_DAMPING)
    moving = set(range(len(apart)))
    jacobian, iteration = None, 0
    while moving and iteration < most_iterations:
        iteration += 1
        jacobian = differences(residuals, state, found, pattern, steps, most)
        waiting = set(moving)
        for _ in range(ATTEMPTS):
            trial = state.copy()
            for part in waiting:
                unknowns, channels = apart[part]
                step = _step(jacobian[channels][..., unknowns], found[channels], damping[part])
                trial[unknowns] = numpy.clip(state[unknowns] + step, least[unknowns], most[unknowns])
            looked = residuals(trial)
            for part in sorted(waiting):
                unknowns, channels = apart[part]
                length = numpy.abs(trial[unknowns] - state[unknowns]).max()
                if numpy.sum(looked[channels] ** 2) < numpy.sum(found[channels] ** 2):
                    state[unknowns], found[channels] = trial[unknowns], looked[channels]
                    damping[part] *= LESS
                    waiting.discard(part)
                else:
                    damping[part] *= MORE
                if length < short:
                    waiting.discard(part)
                    moving.discard(part)
            if not waiting:
                break
        moving -= waiting  # where no step leads down, it is as good as it gets
    return Fit(state, found, jacobian, not moving, iteration)


def parts(pattern):
    """[(unknowns, channels)], index arrays: what has no channel in common with the rest."""
    found, left = [], set(range(pattern.shape[1]))
    while left:
        unknowns = numpy.zeros(pattern.shape[1], bool)
        unknowns[min(left)] = True
        size = 0
        while unknowns.sum() > size:
            size = unknowns.sum()
            channels = pattern[:, unknowns].any(axis=1)
            unknowns = pattern[channels].any(axis=0)
        found.append((numpy.flatnonzero(unknowns), numpy.flatnonzero(channels)))
        left -= set(found[-1][0].tolist())
    return found


def columns(pattern):
    """Lists of unknowns that no channel sees together (Curtis, Powell and Reid, "On the estimation of sparse Jacobian
    matrices", 1974)."""
    lists, seen = [], []
    for unknown in range(pattern.shape[1]):
        for column, channels in zip(lists, seen):
            if not (channels & pattern[:, unknown]).any():
                column.append(unknown)
                channels |= pattern[:, unknown]
                break
        else:
            lists.append([unknown])
            seen.append(pattern[:, unknown].copy())
    return lists


def differences(residuals, state, found, pattern, steps, most):
    """(channels, n, unknowns): the quotients of differences at a state, where the residuals are `found`; the rest as
    `minimise` has it."""
    jacobian = numpy.zeros((*found.shape, len(state)))
    for column in columns(pattern):
        by = numpy.where(state + steps > most, -steps, steps)
        moved = state.copy()
        moved[column] += by[column]
        change = residuals(moved) - found
        for unknown in column:
            channels = pattern[:, unknown]
            jacobian[channels, :, unknown] = change[channels] / by[unknown]
    return jacobian


def _step(jacobian, found, damping):
    """jacobian: (channels, n, unknowns), found: (channels, n)."""
    rows = jacobian.reshape(-1, jacobian.shape[-1])
    curvature = rows.T @ rows
    damped = curvature + damping * numpy.diag(numpy.diag(curvature)) + LEAST_CURVATURE * numpy.eye(len(curvature))
    step = -numpy.linalg.solve(damped, rows.T @ found.ravel())
    return step * min(1.0, LONGEST_STEP / max(numpy.abs(step).max(), 1e-300))
