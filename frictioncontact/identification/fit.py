"""The least sum of squares of an experiment: starts, searches, minima, and intervals by profile likelihood.

Linear intervals are value -+ t s sqrt(C) in the coordinates, from the derivatives at the solution. An
interval by profile ends where the least sum of squares with the parameter held, over all others, has risen by
t^2 s^2 (Raue and others, Bioinformatics 25, 2009, 1923-1929). Where it never rises that far within the
parameter's bounds the data give none on that side. It reaches as far as the farthest minimum below that rise,
and so may span values that are less likely. MINOS of iminuit gives the same ends where the least sum of
squares is a point, and none where it is a valley, of which a profile is to tell.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy import stats
from scipy.optimize import brentq, least_squares
from scipy.spatial import cKDTree
from scipy.stats import qmc

from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionError
from frictioncontact.identification.experiment import TIGHT, TOLERANCE, Experiment, Parameter


@dataclass(frozen=True)
class Minimum:
    """A local minimum of the sum of squares."""

    point: np.ndarray  # coordinates and nuisances
    squares: float
    settled: bool  # the search came to an end


@dataclass(frozen=True)
class Fit:
    """What the data say. Arrays are in the order of the parameters or of the rows."""

    parameters: tuple[Parameter, ...]
    target: np.ndarray  # as Experiment.target: what was fitted
    minima: tuple[Minimum, ...]  # the best first
    covariance: np.ndarray  # of the coordinates
    degrees: int  # rows minus what is free
    quantile: float  # half-width of an interval in standard deviations
    variance: float  # of an independent residual; 1 where uncertainties are stated, nan when not estimable
    known: bool  # uncertainties are stated
    model: np.ndarray  # N
    residuals: np.ndarray  # N, model minus measurement
    slopes: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))  # of the residuals, as weighed
    # Of the instrument: value, half-width.
    nuisances: dict[str, tuple[float, float]] = field(default_factory=dict)
    in_time: bool = False  # the forces are samples, whose own scatter is known
    correlated: float = 1.0  # how many samples of a series count as one
    profiles: list[tuple[float, float]] | None = None  # intervals, as values
    misfits: list[str] = field(default_factory=list)  # what is wrong with the fit, in words
    remedies: list[str] = field(default_factory=list)  # with what else it fits
    hidden: list[str] = field(default_factory=list)  # faults that the data can't show
    warnings: list[str] = field(default_factory=list)

    @property
    def judged(self) -> bool:
        """Whether the data can tell if the law fits."""
        return self.degrees > 0 and (self.known or self.in_time)

    @property
    def point(self) -> np.ndarray:
        """Coordinates and nuisances."""
        return self.minima[0].point

    @property
    def squares(self) -> float:
        """Sum of squares of the residuals, in standard deviations where they are stated."""
        return self.minima[0].squares

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
        """Of the linear intervals, in the coordinates."""
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

    @property
    def rise(self) -> float:
        """Of the sum of squares at the ends of a parameter's 95 % interval by profile."""
        return self.variance * self.quantile**2

    @property
    def region_bound(self) -> float:
        """Sum of squares on the edge of the joint 95 % region."""
        n = len(self.parameters)
        if self.known:
            return self.squares + self.correlated * float(stats.chi2.ppf(0.95, n))
        if self.degrees <= 0:
            return math.nan
        return self.squares + self.variance * n * float(stats.f.ppf(0.95, n, self.degrees))


def nearest_turn(parameters: Sequence[Parameter], point: np.ndarray, to: np.ndarray) -> np.ndarray:
    """The point with each phase on the turn that is nearest to the other point's."""
    point = point.copy()
    for k, p in enumerate(parameters):
        if p.periodic:
            point[k] = to[k] + (point[k] - to[k] + math.pi) % (2.0 * math.pi) - math.pi
    return point


Tell = Callable[[str], None]  # is told what is begun
COARSE = 1e-3  # tolerance of the FMU's solver where only the best starts are sought
STARTS = 8  # of the sample
MOST = 60  # evaluations of a search that does not settle
GAIN = 1e-3  # relative fall of the sum of squares that ends a search
EXACT = 10.0 * TOLERANCE  # of a force: least scatter that is believed, since the FMU's solver adds its own
SAME = 0.05  # in coordinates: minima closer than that are one


def silent(text: str) -> None:
    """For who does not want to be told."""


def search(
    experiment: Experiment,
    target: np.ndarray,
    tell: Tell = silent,
    most: int = STARTS,
    given: Sequence[np.ndarray] = (),
) -> Fit:
    """The fit to a target (as Experiment.target), without profiles and judgement.

    From given coordinates of the parameters, or so many starts of start_points.
    """
    if experiment.degrees < 0:
        names = ", ".join(p.name for p in experiment.parameters)
        have = f"{len(experiment.force)} {experiment.word}s"
        raise UserError(f"{have} can't give {len(experiment.parameters)} parameters ({names})")
    found = []
    starts = [experiment.start(x) for x in given] or start_points(experiment, target)[:most]
    for k, start in enumerate(starts):
        tell(f"search {k + 1} of {len(starts)}")
        found.append(solve(experiment, start, target))
    return described(experiment, target, found)


def solve(
    experiment: Experiment,
    start: np.ndarray,
    target: np.ndarray,
    held: int | None = None,
    gain: float = GAIN,
    tolerance: float = TOLERANCE,
) -> Minimum:
    """The local minimum that a start leads to; held: a coordinate that stays where it is.

    It is sought in the displacement from the start, of which scipy's first step is at most 1 long.
    """
    free = np.arange(len(start)) != held
    start = np.clip(start, experiment.low, experiment.high)

    def point(z: np.ndarray) -> np.ndarray:
        x = start.copy()
        x[free] += z
        return x

    def residuals(z: np.ndarray) -> np.ndarray:
        return experiment.residuals(point(z), target, tolerance)

    first = residuals(np.zeros(free.sum()))
    if not np.isfinite(first).all():
        return Minimum(start, math.inf, False)
    if not free.any():
        return Minimum(start, float(first @ first), True)
    found = least_squares(
        residuals,
        np.zeros(free.sum()),
        jac=lambda z: experiment.slopes(point(z), tolerance)[:, free],
        bounds=((experiment.low - start)[free], (experiment.high - start)[free]),
        ftol=gain,
        xtol=1e-7,
        gtol=1e-12,
        max_nfev=MOST,
    )
    return Minimum(point(found.x), 2.0 * found.cost, found.status > 0)


def start_points(experiment: Experiment, target: np.ndarray) -> np.ndarray:
    """[start, coordinate]: the given start values, or the best of a Sobol sample of the others.

    Of the sample those that are better than their neighbours, which lead to other minima.
    """
    parameters, n = experiment.parameters, len(experiment.parameters)
    given = [math.nan if p.start is None else p.to_coordinate(p.start) for p in parameters]
    if np.isfinite(given).all():
        return experiment.start(given)[None, :]
    low, high = (np.array([p.to_coordinate(p.search[k]) for p in parameters]) for k in (0, 1))
    unit = qmc.Sobol(n, scramble=False).random_base2(4 + n)
    sample = np.where(np.isfinite(given), given, low + (high - low) * unit)
    points = np.array([experiment.start(row) for row in sample])
    squares = np.sum(experiment.misfits(points, target, COARSE) ** 2, axis=1)  # nan where the FMU refuses
    if np.isnan(squares).all():
        raise FrictionError(experiment.problem)
    squares = np.where(np.isnan(squares), np.inf, squares)
    neighbours = cKDTree(unit).query(unit, 1 + 2 * n)[1]  # each with itself
    candidates = np.flatnonzero(np.isfinite(squares) & (squares <= squares[neighbours].min(axis=1)))
    return points[candidates[np.argsort(squares[candidates])[:STARTS]]]


def described(experiment: Experiment, target: np.ndarray, found: list[Minimum]) -> Fit:
    """The best of the solutions, searched again to the last digit, and what its neighbourhood says."""
    minima = _distinct(experiment, found)
    if not minima:
        raise FrictionError(experiment.problem)
    best = solve(experiment, minima[0].point, target, gain=1e-10, tolerance=TIGHT)
    best = best if best.squares <= minima[0].squares else minima[0]
    point = _on_bounds(experiment, best.point)
    r = experiment.residuals(point, target, TIGHT)
    best = Minimum(point, float(r @ r), best.settled)
    jacobian = experiment.slopes(point, TIGHT)
    rows, n = len(experiment.force), len(experiment.parameters)
    correlated = correlation_length(r[:rows]) if experiment.word == "sample" else 1.0
    degrees = int(rows / correlated) - (rows - experiment.degrees)
    if correlated > 1.0 and experiment.degrees > 0:
        degrees = max(1, degrees)
    if experiment.known:
        variance, quantile = correlated, float(stats.norm.ppf(0.975))
    elif degrees > 0:
        variance = max(best.squares / degrees, float(np.mean((EXACT * experiment.force) ** 2)))
        quantile = float(stats.t.ppf(0.975, degrees))
    else:
        variance, quantile = math.nan, math.nan
    residuals = r[:rows] / experiment.weight
    covariance = variance * inverse(jacobian.T @ jacobian)
    return Fit(
        parameters=experiment.parameters,
        target=target,
        minima=(best, *minima[1:]),
        covariance=covariance[:n, :n],
        slopes=jacobian,
        nuisances=_of_instrument(experiment, point, quantile * np.sqrt(np.diag(covariance))),
        degrees=degrees,
        quantile=quantile,
        variance=variance,
        known=experiment.known,
        model=target[:rows] + residuals,
        residuals=residuals,
        correlated=correlated,
        in_time=experiment.word == "sample",
    )


def _of_instrument(
    experiment: Experiment, point: np.ndarray, widths: np.ndarray
) -> dict[str, tuple[float, float]]:
    """Values and half-widths of 95 % of what was asked of the instrument."""
    found = {}
    for name, k in experiment.places.items():
        scale = experiment.nuisances[k - len(experiment.parameters)].scale
        found[name] = scale * float(point[k]), scale * float(widths[k])
        if name == "amplitude":
            factor = math.exp(point[k])
            found[name] = factor, factor * float(widths[k])
    return found


def _on_bounds(experiment: Experiment, point: np.ndarray) -> np.ndarray:
    """scipy's search stays inside of the bounds; what it came close to is put on them."""
    for bound in (experiment.low, experiment.high):
        point = np.where(np.abs(point - bound) < 1e-6, bound, point)
    return point


def _distinct(experiment: Experiment, found: list[Minimum]) -> list[Minimum]:
    """The solutions, the best first, each minimum once; of others than the best those that settled inside."""
    minima: list[Minimum] = []
    parameters, n = experiment.parameters, len(experiment.parameters)
    for one in sorted(found, key=lambda one: one.squares):
        inside = (one.point > experiment.low + SAME) & (one.point < experiment.high - SAME)
        if not math.isfinite(one.squares) or (minima and not (one.settled and inside[:n].all())):
            continue
        point = one.point.copy()
        for k, p in enumerate(parameters):
            point[k] = p.wrapped(point[k])
        if all(
            np.abs(nearest_turn(parameters, point, other.point) - other.point)[:n].max() > SAME
            for other in minima
        ):
            minima.append(Minimum(point, one.squares, one.settled))
    return minima


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


SLOWEST, FASTEST = 1.5, 3.0  # factors by which the distance grows until an end is passed
RESTARTS = 5  # from lower minima that profiles come to
CLOSE = 0.005  # relative, of the square root of the rise: close enough to the end
STEEP = 10.0  # a rise that is as good as none found: where the FMU refuses


class LowerMinimum(Exception):
    """A profile has come to a place with a smaller sum of squares than the fit's."""

    def __init__(self, found: Minimum) -> None:
        self.found = found


def profiles(experiment: Experiment, result: Fit, tell: Tell = silent) -> list[tuple[float, float]]:
    """Ends of the 95 % interval of each parameter, as values; -inf, 0 or inf where the data give none.

    What did not settle is added to the fit's warnings. LowerMinimum where the fit is not the least.
    """
    found = []
    for k, p in enumerate(experiment.parameters):
        ends = []
        for side, word in ((-1.0, "lower"), (1.0, "upper")):
            tell(f"{word} end of {p.name}")
            ends.append(_End(experiment, result, k, side, f"the {word} end of {p.name}'s interval").value())
        found.append((ends[0], ends[1]))
    return found


class _End:
    """The search for one end along the distance from the fit in the coordinate k."""

    def __init__(self, experiment: Experiment, result: Fit, k: int, side: float, name: str) -> None:
        self.experiment, self.result, self.k, self.side, self.name = experiment, result, k, side, name
        bound = experiment.high[k] if side > 0 else experiment.low[k]
        self.reach = math.pi if experiment.parameters[k].periodic else abs(bound - result.point[k])
        self.gain = min(1e-3, max(1e-9, CLOSE * result.rise / (result.squares + result.rise)))
        self.others = [  # minima that the interval holds
            nearest_turn(result.parameters, one.point, result.point)
            for one in result.minima[1:]
            if one.squares < result.squares + result.rise
        ][:3]
        self.last, self.last_point = 0.0, result.point  # the farthest below the end, so far
        for point in self.others:
            away = side * (point[k] - result.point[k])
            if away > self.last:
                self.last, self.last_point = away, point
        self.seen = {0.0: -1.0}

    def value(self) -> float:
        """The end; where there is none, the end of all that the parameter may be."""
        p, x = self.result.parameters[self.k], float(self.result.point[self.k])
        if not math.isfinite(self.result.variance):
            return math.nan
        distance = self.distance()
        if math.isfinite(distance):
            return p.to_value(x + self.side * distance)
        if p.periodic:
            return x + self.side * math.pi
        return 0.0 if p.logarithmic and self.side < 0 else self.side * math.inf

    def distance(self) -> float:
        """From the fit in the coordinate; inf where there is no end within reach."""
        near, width = self.last, self.result.half_widths[self.k]
        place = max(width if 0.0 < width < math.inf else 0.1 * self.reach, SLOWEST * near)
        while near < self.reach:
            place = min(place, self.reach)
            excess = self.excess(place)
            if excess >= 0.0:
                return brentq(self.excess, near, place, xtol=1e-9, rtol=1e-3)
            near, grown = place, 1.05 * place / max(1.0 + excess, 1e-3)
            place = max(SLOWEST * near, min(FASTEST * near, grown))
        return math.inf

    def excess(self, distance: float) -> float:
        """Square root of the rise at a distance, over that of an end, minus 1; 0 where it is close to 0."""
        if distance not in self.seen:
            self.seen[distance] = self._excess(distance)
        return self.seen[distance]

    def _excess(self, distance: float) -> float:
        result, origin = self.result, self.result.point
        ahead = 0.0 if self.last == 0.0 else min(distance / self.last, FASTEST)
        starts = [origin + ahead * (self.last_point - origin), *(one.copy() for one in self.others)]
        for start in starts:
            start[self.k] = origin[self.k] + self.side * distance
        found = [solve(self.experiment, one, result.target, self.k, self.gain) for one in starts]
        best = min(found, key=lambda one: one.squares)
        if not math.isfinite(best.squares):
            self._say(f"{self.name} is where the FMU refuses: {self.experiment.problem}")
            return STEEP
        if not best.settled:
            self._say(f"{self.name} is not settled: the search for the others did not end")
        if best.squares < result.squares - 0.05 * result.rise:
            raise LowerMinimum(best)
        excess = math.sqrt(max(0.0, best.squares - result.squares) / result.rise) - 1.0
        if excess <= 0.0 and distance > self.last:
            self.last, self.last_point = distance, best.point
        return 0.0 if abs(excess) < CLOSE else min(excess, STEEP)

    def _say(self, text: str) -> None:
        about = text.partition(":")[0]
        if not any(told.startswith(about) for told in self.result.warnings):
            self.result.warnings.append(text)


def with_profiles(experiment: Experiment, result: Fit, tell: Tell = silent) -> Fit:
    """The fit with the intervals by profile, or the one of a lower minimum that they come to."""
    for _ in range(RESTARTS):
        try:
            return replace(result, profiles=profiles(experiment, result, tell))
        except LowerMinimum as lower:
            result = described(experiment, result.target, [lower.found, *result.minima])
    result.warnings.append("the fit and its intervals are not settled: each search finds a smaller misfit")
    return replace(result, profiles=[(math.nan, math.nan)] * len(result.parameters))
