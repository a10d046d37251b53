"""Fits named parameters of the FMU to measurements by least squares.

Intervals: linear ones, value -+ t s sqrt(C) in the coordinates, from the derivatives at the solution; and
by profile likelihood (profile.py), which hold where the sum of squares is no parabola.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache

import numpy as np
from scipy import stats
from scipy.stats import qmc

from frictionlab.fmu import FrictionError
from frictionlab.identify.experiment import TIGHT, Experiment
from frictionlab.identify.least_squares import Solutions, solve, steps
from frictionlab.identify.parameter import Parameter
from frictionlab.project import UserError

COARSE = 1e-3  # tolerance of the FMU's solver where only the best starts are sought
SAME = 0.05  # in coordinates: solutions closer than that are one


@dataclass(frozen=True)
class Minimum:
    """A local minimum of the sum of squares."""

    point: np.ndarray
    squares: float


@dataclass(frozen=True)
class Fit:
    """What the data say. Arrays are in the order of the parameters or of the rows."""

    parameters: tuple[Parameter, ...]
    point: np.ndarray  # coordinates and nuisances
    covariance: np.ndarray  # of the coordinates
    degrees: int  # rows minus what is free
    quantile: float  # half-width of an interval in standard deviations
    variance: float  # of an independent residual; 1 where uncertainties are stated, nan when not estimable
    known: bool  # uncertainties are stated
    model: np.ndarray  # N
    residuals: np.ndarray  # N, model minus measurement
    squares: float  # sum of squares of the residuals, in standard deviations where they are stated
    correlated: float = 1.0  # how many samples of a series count as one
    minima: tuple[Minimum, ...] = ()
    kappa: np.ndarray | None = None
    profiles: list[tuple[float, float]] | None = None  # intervals, as values
    misfits: list[str] = field(default_factory=list)  # what is wrong with the fit, in words
    warnings: list[str] = field(default_factory=list)

    @property
    def coordinates(self) -> np.ndarray:
        return self.point[: len(self.parameters)]

    @property
    def deviation(self) -> float:
        """Scatter of one row [N], estimated; nan where it is stated or can't be estimated."""
        return math.nan if self.known else math.sqrt(self.variance / self.correlated)

    @property
    def values(self) -> np.ndarray:
        return np.array([p.to_value(x) for p, x in zip(self.parameters, self.coordinates, strict=True)])

    @property
    def half_widths(self) -> np.ndarray:
        """Of the intervals, in the coordinates."""
        return self.quantile * np.sqrt(np.diag(self.covariance))

    def interval(self, k: int) -> tuple[float, float]:
        """The linear one."""
        parameter, x, width = self.parameters[k], self.coordinates[k], self.half_widths[k]
        return parameter.to_value(x - width), parameter.to_value(x + width)

    @property
    def correlation(self) -> np.ndarray:
        scale = np.sqrt(np.diag(self.covariance))
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.covariance / np.outer(scale, scale)


def fit(experiment: Experiment, samples: int | None = None, starts: int = 8) -> Fit:
    """Least squares from the best of some sampled starts, or from the given start values."""
    from frictionlab.identify.judge import judge

    (result,) = fits(experiment, experiment.target[None, :], samples, starts)
    return judge(experiment, result)


def fits(
    experiment: Experiment, targets: np.ndarray, samples: int | None = None, starts: int = 8
) -> list[Fit]:
    """One for each row of targets (as Experiment.target), all solved together, without a judgement."""
    if experiment.degrees < 0:
        names = ", ".join(p.name for p in experiment.parameters)
        have = f"{len(experiment.force)} {experiment.word}s"
        raise UserError(f"{have} can't give {len(experiment.parameters)} parameters ({names})")
    first = start_points(experiment, targets, samples, starts)
    count = first.shape[1]
    repeated = np.repeat(targets, count, axis=0)
    found = solve(experiment, first.reshape(len(targets) * count, -1), repeated, together=count)
    return fits_of(experiment, targets, found, count)


def fits_of(experiment: Experiment, targets: np.ndarray, found: Solutions, count: int) -> list[Fit]:
    """The best of each count solutions, with its covariance, and the other minima."""
    if not np.isfinite(found.squares).reshape(len(targets), count).any(axis=1).all():
        raise FrictionError(experiment.problem)
    minima = [_minima(experiment, found, slice(k * count, (k + 1) * count)) for k in range(len(targets))]
    points, r, jacobians = _ended(experiment, np.array([each[0].point for each in minima]), targets)
    return [
        _described(experiment, point, each, target, one_r, jacobian)
        for point, each, target, one_r, jacobian in zip(points, minima, targets, r, jacobians, strict=True)
    ]


def _ended(
    experiment: Experiment, points: np.ndarray, targets: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One step more, with tight tolerance and central differences: points, residuals there, derivatives.

    A step of a search that has ended is far shorter than the derivatives need to change.
    """
    r, jacobian = experiment.with_slopes(points, targets, TIGHT, central=True)
    on_bound = (points <= experiment.low) | (points >= experiment.high)
    last = points + steps(jacobian, r, np.full(len(points), 1e-9), on_bound)
    last = np.clip(last, experiment.low, experiment.high)
    r_last = experiment.at(last, targets, TIGHT)
    better = np.sum(r_last**2, axis=1) < np.sum(r**2, axis=1)
    return np.where(better[:, None], last, points), np.where(better[:, None], r_last, r), jacobian


def start_points(experiment: Experiment, targets: np.ndarray, samples: int | None, starts: int) -> np.ndarray:
    """[target, start, coordinate]: the given start values, or the best of a Sobol sample of the others."""
    parameters = experiment.parameters
    if all(p.start is not None for p in parameters):
        given = experiment.start([p.to_coordinate(p.start) for p in parameters])
        return np.broadcast_to(given, (len(targets), 1, len(given)))
    low, high = (np.array([p.to_coordinate(p.search[k]) for p in parameters]) for k in (0, 1))
    samples = samples or 8 * 2 ** len(parameters)
    sample = low + (high - low) * _sobol(len(parameters), samples)
    for k, p in enumerate(parameters):
        if p.start is not None:
            sample[:, k] = p.to_coordinate(p.start)
    points = np.array([experiment.start(row) for row in sample])
    forces = experiment.forces(points, COARSE)  # nan outside of what the model allows, for example d <= a_d
    if np.isnan(forces).any(axis=1).all():
        raise FrictionError(experiment.problem)
    rows = len(experiment.force)
    squares = np.array(
        [np.sum(((forces - target[:rows]) * experiment.weight) ** 2, axis=1) for target in targets]
    )
    best = np.argsort(np.where(np.isnan(squares), np.inf, squares), axis=1)[:, :starts]
    return points[best]


@cache
def _sobol(dimensions: int, samples: int) -> np.ndarray:
    return qmc.Sobol(dimensions, scramble=False).random(samples)


def region_bound(experiment: Experiment, result: Fit) -> float:
    """Sum of squares on the edge of the joint 95 % region."""
    n = len(result.parameters)
    if result.known:
        return result.squares + result.correlated * float(stats.chi2.ppf(0.95, n))
    if result.degrees <= 0:
        return math.nan
    return result.squares + result.variance * n * float(stats.f.ppf(0.95, n, result.degrees))


def distance(parameters: Sequence[Parameter], a: np.ndarray, b: np.ndarray) -> float:
    """Largest difference of two points' coordinates, a phase's the shorter way round."""
    apart = np.abs(a - b)[: len(parameters)]
    return float(
        max(
            min(gap % (2.0 * math.pi), -gap % (2.0 * math.pi)) if p.periodic else gap
            for p, gap in zip(parameters, apart, strict=True)
        )
    )


def _minima(experiment: Experiment, found: Solutions, part: slice) -> tuple[Minimum, ...]:
    """The solutions of one problem, the best first, each minimum once."""
    minima: list[Minimum] = []
    order = np.argsort(found.squares[part]) + part.start
    for k in order:
        point = found.x[k].copy()
        n = len(experiment.parameters)
        on_bound = (point <= experiment.low + SAME)[:n] | (point >= experiment.high - SAME)[:n]
        if not np.isfinite(found.squares[k]) or (minima and (not found.converged[k] or on_bound.any())):
            continue
        for j, p in enumerate(experiment.parameters):
            point[j] = p.wrapped(point[j])
        if all(distance(experiment.parameters, point, other.point) > SAME for other in minima):
            minima.append(Minimum(point, float(found.squares[k])))
    return tuple(minima)


def _described(
    experiment: Experiment,
    point: np.ndarray,
    minima: tuple[Minimum, ...],
    target: np.ndarray,
    r: np.ndarray,
    jacobian: np.ndarray,
) -> Fit:
    rows, n = len(experiment.force), len(experiment.parameters)
    correlated = correlation_length(r[:rows]) if experiment.word == "sample" else 1.0
    degrees = int(rows / correlated) - (rows - experiment.degrees)
    if correlated > 1.0 and experiment.degrees > 0:
        degrees = max(1, degrees)
    squares = float(r @ r)
    if experiment.known:
        variance, quantile = correlated, float(stats.norm.ppf(0.975))
    elif degrees > 0:
        variance, quantile = squares / degrees, float(stats.t.ppf(0.975, degrees))
    else:
        variance, quantile = math.nan, math.nan
    residuals = r[:rows] / experiment.weight
    return Fit(
        parameters=experiment.parameters,
        point=point,
        covariance=(variance * inverse(jacobian.T @ jacobian))[:n, :n],
        degrees=degrees,
        quantile=quantile,
        variance=variance,
        known=experiment.known,
        model=target[:rows] + residuals,
        residuals=residuals,
        squares=squares,
        correlated=correlated,
        minima=(Minimum(point, squares), *minima[1:]),
    )


def correlation_length(r: np.ndarray) -> float:
    """How many successive residuals count as one: 1 + 2 times the sum of their first correlations."""
    size = float(r @ r)
    length = 1.0
    for lag in range(1, len(r) // 2):
        correlation = float(r[lag:] @ r[:-lag]) / size if size > 0.0 else 0.0
        if correlation <= 2.0 / math.sqrt(len(r)):  # what independent residuals may show
            break
        length += 2.0 * correlation
    return length


def inverse(information: np.ndarray) -> np.ndarray:
    """The inverse; infinite variances where a parameter, or a mixture of parameters, leaves no trace."""
    values, vectors = np.linalg.eigh(information)
    lost = values <= 1e-13 * max(values[-1], 1e-300)
    with np.errstate(divide="ignore"):
        found = (vectors[:, ~lost] / values[~lost]) @ vectors[:, ~lost].T
    for k in np.flatnonzero(lost):
        touched = np.abs(vectors[:, k]) > 1e-6
        found[np.ix_(touched, touched)] = np.inf
    return found
