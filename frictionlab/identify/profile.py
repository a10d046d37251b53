"""Intervals by profile likelihood: as far as a parameter can go while the others make up for it.

An end is where the least sum of squares with the parameter held, over all others, has risen by
t^2 s^2. Where it never rises that far the data give no bound on that side.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from frictionlab.identify.experiment import Experiment
from frictionlab.identify.fit import Fit
from frictionlab.identify.least_squares import solve

FARTHEST = math.log(1e6)  # of a logarithm, or the end of the search where that is farther
POINTS, FINER = 10, 4
GAIN = 1e-3  # relative: of a sum of squares, a bound of which is sought


def profiles(experiment: Experiment, result: Fit) -> list[tuple[float, float]]:
    """Ends of the 95 % interval of each parameter, as values; -inf, 0 or inf where the data give none."""
    found = []
    for k, p in enumerate(experiment.parameters):
        ends = []
        for side in (-1.0, 1.0):
            reach = _reach(experiment, result, k, side)
            distance = (
                math.nan if not math.isfinite(result.variance) else _end(experiment, result, k, side, reach)
            )
            if math.isnan(distance):
                ends.append(math.nan)
            elif math.isinf(distance) and p.periodic:
                ends.append(float(result.coordinates[k]) + side * math.pi)
            elif math.isinf(distance):
                ends.append(side * math.inf if side > 0 or not p.logarithmic else 0.0)
            else:
                ends.append(float(p.to_value(result.coordinates[k] + side * distance)))
        found.append((ends[0], ends[1]))
    return found


def _reach(experiment: Experiment, result: Fit, k: int, side: float) -> float:
    """How far the coordinate is followed."""
    p, x = experiment.parameters[k], result.coordinates[k]
    bound = (experiment.high[k] - x) if side > 0 else (x - experiment.low[k])
    if p.periodic:
        return math.pi
    searched = abs(p.to_coordinate(p.search[1 if side > 0 else 0]) - x)
    usual = (
        max(FARTHEST, _finite(searched))
        if p.logarithmic
        else max(10.0 * abs(x), 20.0 * _finite(result.half_widths[k]), 1e-300)
    )
    return float(min(bound, usual))


def _finite(width: float) -> float:
    return float(width) if math.isfinite(width) else 0.0


def _end(experiment: Experiment, result: Fit, k: int, side: float, reach: float) -> float:
    """Distance of the end from the solution in the coordinate; inf where there is none within reach."""
    rise = result.variance * result.quantile**2
    width = result.half_widths[k]
    first = 0.2 * width if 0.0 < width < 5.0 * reach else 0.2 * reach
    near, far, far_rise, point, near_rise = 0.0, None, 0.0, result.point, 0.0
    grid: Sequence[float] = np.geomspace(min(first, 0.5 * reach), reach, POINTS) if reach > 0.0 else []
    for _ in range(2):
        if len(grid) == 0:
            return math.inf
        squares, points = _least(experiment, result, k, side, grid, point)
        over = np.flatnonzero(~(squares - result.squares <= rise))
        if len(over) == 0 and far is None:
            return math.inf
        cross = over[0] if len(over) else len(grid)
        if cross < len(grid):
            far, far_rise = float(grid[cross]), float(squares[cross] - result.squares)
        if cross > 0:
            near, point = float(grid[cross - 1]), points[cross - 1]
            near_rise = float(squares[cross - 1] - result.squares)
        grid = np.linspace(near, far, FINER + 2)[1:-1]
    if not math.isfinite(far_rise):
        return 0.5 * (near + far)
    return near + (far - near) * (rise - near_rise) / (far_rise - near_rise)


def _least(
    experiment: Experiment, result: Fit, k: int, side: float, grid: Sequence[float], point: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Least sums of squares, and where, with coordinate k held at each place of the grid.

    From the last point and from the other minima, since the best of the others may jump.
    """
    seeds = np.array([point, *(one.point for one in result.minima[1:4])])
    starts = np.repeat(seeds, len(grid), axis=0)
    starts[:, k] = np.tile(result.coordinates[k] + side * np.asarray(grid), len(seeds))
    held = np.zeros(starts.shape, bool)
    held[:, k] = True
    targets = np.broadcast_to(experiment.target, (len(starts), len(experiment.target)))
    found = solve(experiment, starts, targets, held, GAIN)
    squares = found.squares.reshape(len(seeds), len(grid))
    best = np.argmin(squares, axis=0), np.arange(len(grid))
    return squares[best], found.x.reshape(len(seeds), len(grid), -1)[best]
