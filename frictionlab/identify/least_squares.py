"""Least squares by Levenberg and Marquardt, for many problems of one experiment at once.

All problems share the experiment and differ in their start, their data and what is held. Each round asks
the experiment once for the forces of all of them, so that the FMU runs in large batches. Derivatives are
carried on by Broyden's update, and computed anew where that does not help, and before a search ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

ROUNDS = 60
LONGEST = 2.0  # of a step, in coordinates: a factor of 7
SHORTEST = 1e-8  # step that ends the search
GAIN = 1e-11  # relative fall of the sum of squares that ends it


class Residuals(Protocol):
    """Residuals of points x[problem, coordinate], in standard deviations; nan where the FMU refuses."""

    low: np.ndarray
    high: np.ndarray

    def at(self, x: np.ndarray, targets: np.ndarray) -> np.ndarray:
        """[problem, residual]"""

    def derivatives(self, x: np.ndarray, r: np.ndarray, targets: np.ndarray) -> np.ndarray:
        """[problem, residual, coordinate], with the residuals r at x"""


@dataclass(frozen=True)
class Solutions:
    x: np.ndarray  # [problem, coordinate]
    squares: np.ndarray  # sum of squares of each; inf where no start works
    converged: np.ndarray


def solve(
    residuals: Residuals,
    starts: np.ndarray,
    targets: np.ndarray,
    held: np.ndarray | None = None,
    gain: float = GAIN,
) -> Solutions:
    """From each start; targets and held (coordinates that stay where they are) have a row a problem.

    A relative gain below `gain` ends the search.
    """
    x = np.clip(starts, residuals.low, residuals.high)
    held = np.zeros(x.shape, bool) if held is None else held
    r = residuals.at(x, targets)
    squares = _squares(r)
    jacobian = np.zeros((*r.shape, x.shape[1]))
    damping = np.full(len(x), 1e-3)
    running, converged = np.isfinite(squares), np.zeros(len(x), bool)
    wanted, exact = running.copy(), np.zeros(len(x), bool)  # derivatives: to be computed, just computed
    for _ in range(ROUNDS):
        on = np.flatnonzero(running)
        if not len(on):
            break
        todo = np.flatnonzero(running & wanted)
        if len(todo):
            jacobian[todo] = _derivatives(residuals, x[todo], r[todo], targets[todo])
            wanted[todo], exact[todo] = False, True
        step = _steps(
            jacobian[on], r[on], damping[on], _fixed(residuals, x[on], jacobian[on], r[on], held[on])
        )
        trial = np.clip(x[on] + step, residuals.low, residuals.high)
        r_trial = residuals.at(trial, targets[on])
        found = _squares(r_trial)
        better = found < squares[on]
        small = np.max(np.abs(trial - x[on]), axis=1) < SHORTEST
        done = small | (better & (squares[on] - found <= gain * squares[on])) | (damping[on] > 1e12)
        ends = done & (exact[on] | (gain > GAIN))
        moved = on[better]
        wanted[on] = ~better & ~exact[on] | (done & ~ends)
        damping[on] = np.where(better, np.maximum(damping[on] / 10.0, 1e-12), damping[on])
        damping[on] = np.where(~better & exact[on], damping[on] * 8.0, damping[on])
        jacobian[moved] = _updated(jacobian[moved], trial[better] - x[moved], r_trial[better] - r[moved])
        x[moved], r[moved], squares[moved], exact[moved] = (
            trial[better],
            r_trial[better],
            found[better],
            False,
        )
        converged[on[ends]], running[on[ends]] = True, False
    return Solutions(x, squares, converged)


def _squares(r: np.ndarray) -> np.ndarray:
    found = np.sum(r**2, axis=1)
    return np.where(np.isnan(found), np.inf, found)


def _derivatives(residuals: Residuals, x: np.ndarray, r: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """They do not depend on the data: once for all problems that are at the same point."""
    _, first, which = np.unique(x, axis=0, return_index=True, return_inverse=True)
    return residuals.derivatives(x[first], r[first], targets[first])[which.reshape(-1)]


def _updated(jacobian: np.ndarray, step: np.ndarray, change: np.ndarray) -> np.ndarray:
    """Broyden's update: the nearest derivatives that explain the change of the residuals by the step."""
    missing = change - np.einsum("mij,mj->mi", jacobian, step)
    size = np.maximum(np.sum(step**2, axis=1), 1e-300)
    return jacobian + missing[:, :, None] * (step / size[:, None])[:, None, :]


def _fixed(
    residuals: Residuals, x: np.ndarray, jacobian: np.ndarray, r: np.ndarray, held: np.ndarray
) -> np.ndarray:
    """Coordinates that are held, or lie on a bound with the sum of squares falling beyond it."""
    slope = np.einsum("mij,mi->mj", jacobian, r)
    return held | ((x <= residuals.low) & (slope > 0.0)) | ((x >= residuals.high) & (slope < 0.0))


def _steps(jacobian: np.ndarray, r: np.ndarray, damping: np.ndarray, fixed: np.ndarray) -> np.ndarray:
    """The damped Gauss-Newton steps, none longer than LONGEST."""
    jacobian = np.where(fixed[:, None, :], 0.0, jacobian)
    curvature = np.einsum("mij,mik->mjk", jacobian, jacobian)
    diagonal = np.einsum("mjj->mj", curvature)
    most = np.maximum(diagonal.max(axis=1, keepdims=True), 1e-300)
    added = damping[:, None] * np.maximum(diagonal, 1e-9 * most) + 1e-14 * most
    n = curvature.shape[1]
    matrix = curvature + added[:, :, None] * np.eye(n)
    slope = np.einsum("mij,mi->mj", jacobian, r)
    step = -np.linalg.solve(matrix, slope[:, :, None])[:, :, 0]
    longest = np.max(np.abs(step), axis=1, keepdims=True)
    return np.where(fixed, 0.0, step * np.minimum(1.0, LONGEST / np.maximum(longest, 1e-300)))
