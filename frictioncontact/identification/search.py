"""The least sum of squares of an experiment: scipy's least squares from the best of some sampled starts."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy import stats
from scipy.optimize import least_squares
from scipy.spatial import cKDTree
from scipy.stats import qmc

from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionError
from frictioncontact.identification.experiment import TIGHT, TOLERANCE, Experiment
from frictioncontact.identification.result import Fit, Minimum, nearest_turn

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
