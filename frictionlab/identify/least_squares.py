"""Least squares by Levenberg and Marquardt, for many problems of one experiment at once.

All problems share the experiment and differ in their start, their data and what is held. Each round asks
the experiment once, for forces and differences of all of them, so that the FMU runs in few, large batches.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

ROUNDS = 60
LONGEST = 2.0  # of a step, in coordinates: a factor of 7
SHORTEST = 1e-5  # step that ends the search
GAIN = 1e-3  # relative fall of the sum of squares that ends it
FIRM = 1.0  # least damping after a step that failed: it halves the next one
MERGED = 0.02  # in coordinates: searches of one problem that come so close go on as one


class Residuals(Protocol):
    """Residuals of points x[problem, coordinate], in standard deviations; nan where the FMU refuses."""

    low: np.ndarray
    high: np.ndarray

    def with_slopes(self, x: np.ndarray, targets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """[problem, residual] and [problem, residual, coordinate]"""


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
    enough: float | np.ndarray = 0.0,
    together: int = 1,
) -> Solutions:
    """From each start; targets and held (coordinates that stay where they are) have a row a problem.

    A search ends where the sum of squares falls in a step by less than GAIN of it, or less than enough (one
    for all, or one for each). Each `together` successive ones are searches for the
    least of one problem: of those that meet only the best goes on.
    """
    x = np.clip(starts, residuals.low, residuals.high)
    held = np.zeros(x.shape, bool) if held is None else held
    enough = np.broadcast_to(enough, len(x))
    r, jacobian = residuals.with_slopes(x, targets)
    squares = _squares(r)
    damping = np.full(len(x), 1e-3)
    running, converged = np.isfinite(squares), np.zeros(len(x), bool)
    for _ in range(ROUNDS):
        on = np.flatnonzero(running)
        if not len(on):
            break
        fixed = _fixed(residuals, x[on], jacobian[on], r[on], held[on])
        step = steps(jacobian[on], r[on], damping[on], fixed)
        trial = np.clip(x[on] + step, residuals.low, residuals.high)
        r_trial, jacobian_trial = residuals.with_slopes(trial, targets[on])
        found = _squares(r_trial)
        better = found < squares[on]
        small = np.max(np.abs(trial - x[on]), axis=1) < SHORTEST
        little = squares[on] - found <= np.maximum(GAIN * squares[on], enough[on])
        ends = small | (better & little) | (damping[on] > 1e9)
        damping[on] = np.where(
            better, np.maximum(0.1 * damping[on], 1e-12), np.maximum(8.0 * damping[on], FIRM)
        )
        moved = on[better]
        x[moved], r[moved], squares[moved] = trial[better], r_trial[better], found[better]
        jacobian[moved] = jacobian_trial[better]
        converged[on[ends]], running[on[ends]] = True, False
        if together > 1:
            running &= ~_met(x, squares, together)
    return Solutions(x, squares, converged)


def _met(x: np.ndarray, squares: np.ndarray, together: int) -> np.ndarray:
    """Which searches have come to where a better one of the same problem is."""
    places = x.reshape(-1, together, x.shape[1])
    near = (np.abs(places[:, :, None] - places[:, None]) < MERGED).all(axis=-1)
    least = squares.reshape(-1, together)
    order = np.arange(together)
    ahead = least[:, None] < least[:, :, None]
    ahead |= (least[:, None] == least[:, :, None]) & (order[None, :] < order[:, None])
    return (near & ahead).any(axis=2).reshape(-1)


def _squares(r: np.ndarray) -> np.ndarray:
    found = np.sum(r**2, axis=1)
    return np.where(np.isnan(found), np.inf, found)


def _fixed(
    residuals: Residuals, x: np.ndarray, jacobian: np.ndarray, r: np.ndarray, held: np.ndarray
) -> np.ndarray:
    """Coordinates that are held, or lie on a bound with the sum of squares falling beyond it."""
    at_bound = (x <= residuals.low) | (x >= residuals.high)
    if not at_bound.any():
        return held
    slope = np.einsum("mij,mi->mj", jacobian, r)
    return held | ((x <= residuals.low) & (slope > 0.0)) | ((x >= residuals.high) & (slope < 0.0))


def steps(jacobian: np.ndarray, r: np.ndarray, damping: np.ndarray, fixed: np.ndarray) -> np.ndarray:
    """The damped Gauss-Newton steps, none longer than LONGEST."""
    transposed = np.where(fixed[:, :, None], 0.0, jacobian.transpose(0, 2, 1))
    curvature = transposed @ transposed.transpose(0, 2, 1)
    k = np.arange(curvature.shape[1])
    diagonal = curvature[:, k, k]
    most = np.maximum(diagonal.max(axis=1, keepdims=True), 1e-300)
    curvature[:, k, k] += damping[:, None] * np.maximum(diagonal, 1e-9 * most) + 1e-14 * most
    step = -np.linalg.solve(curvature, transposed @ r[:, :, None])[:, :, 0]
    longest = np.abs(step).max(axis=1, keepdims=True)
    return step * np.minimum(1.0, LONGEST / np.maximum(longest, 1e-300))
