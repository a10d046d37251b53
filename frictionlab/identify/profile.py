"""Intervals by profile likelihood: as far as a parameter can go while the others make up for it.

An end is where the least sum of squares with the parameter held, over all others, has risen by
t^2 s^2 (Raue and others, Bioinformatics 25, 2009, 1923-1929). Where it never rises that far the data give
no bound on that side. An interval reaches as far as the farthest minimum below that rise, and so may span
values that are less likely. The square root of the rise is nearly a straight line, along which an end is
sought.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from frictionlab.identify.experiment import Experiment
from frictionlab.identify.fit import Fit, Minimum
from frictionlab.identify.least_squares import solve

FARTHEST = math.log(1e6)  # of a logarithm, or the end of the search where that is farther
LOOKS = 12  # at most, for an end
LARGEST, SMALLEST = 3.0, 1.2  # factors by which the distance grows until an end is passed
NEAR = 0.005  # relative, of the square root of the rise: close enough to the end
ENOUGH = 5e-3  # of the rise at an end: a smaller fall ends the search for the least sum of squares


@dataclass
class _End:
    """The search for one end. Rises are square roots, over that of the end: 0 at the solution, 1 there."""

    k: int  # parameter
    side: float
    reach: float
    place: float  # distance from the solution in the coordinate, looked at next
    near: float = 0.0
    near_rise: float = 0.0
    near_point: np.ndarray | None = None
    far: float = math.inf
    far_rise: float = math.inf
    gap: float = math.inf  # before the last look
    ended: bool = False

    def take(self, rise: float, point: np.ndarray) -> None:
        """What was found at the place; then the next one, or the end."""
        if rise <= 1.0:
            self.near, self.near_rise, self.near_point = self.place, rise, point
        else:
            self.far, self.far_rise = self.place, rise
        if abs(rise - 1.0) < NEAR or self.near >= self.reach or self.far - self.near < 1e-3 * self.far:
            self.ended = True
        elif math.isinf(self.far):
            ahead = 1.05 * self.near / self.near_rise if self.near_rise > 0.0 else math.inf
            self.place = min(max(ahead, SMALLEST * self.near), LARGEST * self.near, self.reach)
        else:
            gap = self.far - self.near
            is_line = math.isfinite(self.far_rise) and gap <= 0.5 * self.gap  # else halved
            part = (1.0 - self.near_rise) / (self.far_rise - self.near_rise) if is_line else 0.5
            self.place, self.gap = self.near + gap * min(max(part, 0.05), 0.95), gap

    @property
    def distance(self) -> float:
        """Of the end from the solution in the coordinate; inf where there is none within reach."""
        if math.isinf(self.far):
            return self.near if abs(self.near_rise - 1.0) < NEAR else math.inf
        if math.isinf(self.far_rise):
            return 0.5 * (self.near + self.far)
        part = (1.0 - self.near_rise) / (self.far_rise - self.near_rise)
        return self.near + (self.far - self.near) * part


def profiles(experiment: Experiment, result: Fit) -> list[tuple[float, float]]:
    """Ends of the 95 % interval of each parameter, as values; -inf, 0 or inf where the data give none."""
    return profiles_of(experiment, [result], experiment.target[None, :])[0]


def profiles_of(
    experiment: Experiment, results: Sequence[Fit], targets: np.ndarray
) -> list[list[tuple[float, float]]]:
    """The same of many fits, each to its row of targets, all followed together."""
    count = len(experiment.parameters)
    ends = [
        [_first(experiment, one, k, side) for k in range(count) for side in (-1.0, 1.0)] for one in results
    ]
    for _ in range(LOOKS):
        going = [
            (end, one, target)
            for each, one, target in zip(ends, results, targets, strict=True)
            for end in each
            if not end.ended
        ]
        if not going:
            break
        _look(experiment, *zip(*going, strict=True))
    found = [[_value(experiment, one, end) for end in each] for each, one in zip(ends, results, strict=True)]
    return [list(zip(each[0::2], each[1::2], strict=True)) for each in found]


def _value(experiment: Experiment, result: Fit, end: _End) -> float:
    p, x = experiment.parameters[end.k], float(result.coordinates[end.k])
    if not math.isfinite(result.variance):
        return math.nan
    if math.isfinite(end.distance):
        return p.to_value(x + end.side * end.distance)
    if p.periodic:
        return x + end.side * math.pi
    return end.side * math.inf if end.side > 0 or not p.logarithmic else 0.0


def _first(experiment: Experiment, result: Fit, k: int, side: float) -> _End:
    """The first look is at the end of the linear interval, or beyond the farthest minimum of the region."""
    reach, width = _reach(experiment, result, k, side), result.half_widths[k]
    place = min(width, reach) if width > 0.0 else 0.1 * reach  # width may be nan
    end = _End(k, side, reach, place, ended=reach <= 0.0 or not math.isfinite(result.variance))
    for one in () if end.ended else _others(experiment, result):
        away = side * (one.point[k] - result.point[k])
        if away > max(end.near, place):
            end.near, end.near_point = away, one.point
            end.near_rise = math.sqrt(max(0.0, one.squares - result.squares) / _rise(result))
            end.place = min(reach, SMALLEST * end.near)
    end.ended |= end.near >= reach
    return end


def _rise(result: Fit) -> float:
    """Of the sum of squares, at an end."""
    return result.variance * result.quantile**2


def _others(experiment: Experiment, result: Fit) -> list[Minimum]:
    """The other minima that an interval holds, on the turn that is nearest to the solution."""
    found = []
    for one in result.minima[1:]:
        point = one.point.copy()
        for k, p in enumerate(experiment.parameters):
            if p.periodic:
                away = (point[k] - result.point[k] + math.pi) % (2.0 * math.pi) - math.pi
                point[k] = result.point[k] + away
        if one.squares < result.squares + _rise(result):
            found.append(Minimum(point, one.squares))
    return found[:3]


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


def _look(
    experiment: Experiment, ends: Sequence[_End], results: Sequence[Fit], targets: Sequence[np.ndarray]
) -> None:
    """Least sum of squares at the place of each end, where its coordinate is held.

    From where the last look led to, and from the other minima, since the best of the others may jump.
    """
    starts = [_starts(experiment, end, one) for end, one in zip(ends, results, strict=True)]
    together = max(map(len, starts))
    starts = [each + each[:1] * (together - len(each)) for each in starts]  # equal ones meet at once
    held = np.zeros((len(ends) * together, starts[0][0].size), bool)
    held[np.arange(len(held)), np.repeat([end.k for end in ends], together)] = True
    points = np.array(starts).reshape(len(held), -1)
    enough = np.repeat([ENOUGH * _rise(one) for one in results], together)
    found = solve(experiment, points, np.repeat(targets, together, axis=0), held, enough, together)
    squares = found.squares.reshape(-1, together)
    points = found.x.reshape(len(ends), together, -1)
    for end, one, each, there in zip(ends, results, squares, points, strict=True):
        best = int(np.argmin(each))
        rise = max(0.0, each[best] - one.squares) / _rise(one)
        end.take(math.sqrt(rise), there[best])


def _starts(experiment: Experiment, end: _End, result: Fit) -> list[np.ndarray]:
    if end.near_point is not None:
        first = result.point + (end.near_point - result.point) * min(end.place / end.near, LARGEST)
    else:
        first = result.point.copy()
        n, k = len(result.parameters), end.k
        with np.errstate(invalid="ignore", divide="ignore"):
            towards = result.covariance[:, k] / result.covariance[k, k]
        first[:n] += end.side * end.place * np.where(np.isfinite(towards), towards, 0.0)
    others = [one.point.copy() for one in _others(experiment, result)]
    for start in (first, *others):
        start[end.k] = result.point[end.k] + end.side * end.place
    return [first, *others]
