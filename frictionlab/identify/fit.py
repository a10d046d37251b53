"""Fits parameters of the FMU to measured mean friction by least squares, and says what the data can tell.

A parameter that must be positive is fitted in its logarithm, so that its interval is a factor. Intervals are
the linear ones, value -+ t s sqrt(C), from the derivatives of F_t_mean at the solution.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy import stats
from scipy.optimize import least_squares
from scipy.stats import qmc

from frictionlab.fmu import FrictionError, FrictionFmu, Session
from frictionlab.identify.data import Measurements, accepted
from frictionlab.periodic import settled_mean
from frictionlab.project import UserError

TOLERANCE = 1e-9  # of the FMU's solver: finite differences need a smooth F_t_mean
SETTLING_PERIODS = 20_000  # in one communication step, before the one that is measured
CALLS_PER_SESSION = 2_000  # then start again at time 0, so that the period stays resolved
DIFFERENCE = 1e-4
STIFF = 100.0  # kappa beyond which the mean tells nearly nothing about the stiffness
STIFFNESS_LIKE = ("contact.stiffnessScale", "contact.sigma", "d", "E")
# Where to search when no start value is given; other parameters are searched within a factor of 3.
SEARCH = {
    "contact.stiffnessScale": (1e-9, 10.0),
    "contact.sigma": (1e3, 1e13),
    "vibration.phase_d": (0.0, 2.0 * math.pi),
}


@dataclass(frozen=True)
class Parameter:
    """A fitted parameter, and the coordinate it is fitted in: its logarithm if it must be positive."""

    name: str
    unit: str
    low: float  # bounds of the model description
    high: float
    search: tuple[float, float]
    start: float | None = None

    @property
    def logarithmic(self) -> bool:
        return self.low > 0.0

    def to_coordinate(self, value: float) -> float:
        if self.logarithmic:
            return math.log(value) if value > 0.0 else -math.inf
        return value

    def to_value(self, coordinate: float) -> float:
        return math.exp(min(coordinate, 700.0)) if self.logarithmic else coordinate


@dataclass(frozen=True)
class Fit:
    """What the data say. Arrays are in the order of the parameters or of the rows."""

    parameters: tuple[Parameter, ...]
    coordinates: np.ndarray
    covariance: np.ndarray  # of the coordinates
    degrees: int  # rows minus parameters
    quantile: float  # half-width of an interval in standard deviations
    model: np.ndarray  # N
    residuals: np.ndarray  # N, model minus measurement
    deviation: float  # N, of one row; nan when not estimable
    kappa: np.ndarray
    warnings: list[str] = field(default_factory=list)

    @property
    def values(self) -> np.ndarray:
        return np.array([p.to_value(x) for p, x in zip(self.parameters, self.coordinates, strict=True)])

    @property
    def half_widths(self) -> np.ndarray:
        """Of the intervals, in the coordinates."""
        return self.quantile * np.sqrt(np.diag(self.covariance))

    def interval(self, k: int) -> tuple[float, float]:
        parameter, x, width = self.parameters[k], self.coordinates[k], self.half_widths[k]
        return parameter.to_value(x - width), parameter.to_value(x + width)

    @property
    def correlation(self) -> np.ndarray:
        scale = np.sqrt(np.diag(self.covariance))
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.covariance / np.outer(scale, scale)


def parameter(
    fmu: FrictionFmu,
    name: str,
    start: float | None,
    search: tuple[float, float] | None,
    constants: Mapping[str, Any],
) -> Parameter:
    """A parameter by its name in the FMU, with bounds and unit from the model description."""
    if name not in accepted(fmu):
        raise UserError(f"{name} can't be fitted; these can: {', '.join(accepted(fmu))}")
    variable = fmu.variables[name]
    low = -math.inf if variable.min is None else float(variable.min)
    high = math.inf if variable.max is None else float(variable.max)
    if search is None:
        usual = float(constants.get(name, variable.start))
        nominal = usual or float(variable.nominal or 1.0)
        search = SEARCH.get(name, (max(nominal / 3.0, low), min(nominal * 3.0, high)))
    for value in (*search, *([] if start is None else [start])):
        if not low <= value <= high:
            raise UserError(f"{name} = {value:g} {variable.unit} must be from {low:g} to {high:g}")
    return Parameter(name, variable.unit, low, high, search, start)


class Experiment:
    """The measured rows in the FMU: one session a row, or new sessions where a fixed parameter is fitted."""

    def __init__(self, fmu: FrictionFmu, rows: Measurements, parameters: Sequence[Parameter]) -> None:
        self.fmu, self.rows, self.parameters = fmu, rows, parameters
        self.fixed = any(fmu.variables[p.name].variability == "fixed" for p in parameters)
        self._sessions: list[Session | None] = [None] * len(rows)
        self._calls = 0

    def means(self, coordinates: Sequence[float]) -> np.ndarray:
        """F_t_mean [N] of every row in its periodic state."""
        values = {p.name: p.to_value(x) for p, x in zip(self.parameters, coordinates, strict=True)}
        self._calls += 1
        if self.fixed or self._calls % CALLS_PER_SESSION == 0:
            self.close()
        return np.array([self._mean(k, values) for k in range(len(self.rows))])

    def kappa(self, coordinates: Sequence[float]) -> np.ndarray:
        """sigma V_1 / (2 pi f F_C) of every row, with the mean stiffness of the vibration left out."""
        self.means(coordinates)
        found = []
        for session in self._sessions:
            V_1, f, F_C = (session.get(n) for n in ("vibration.V_1", "vibration.f", "F_C"))
            session.set("vibration.a_d", 0.0)
            session.step(0.0)
            found.append(session.get("sigma") * V_1 / (2.0 * math.pi * f * F_C))
        self.close()
        return np.array(found)

    def _mean(self, k: int, values: Mapping[str, float]) -> float:
        try:
            session = self._sessions[k]
            if session is None:
                start = {**self.rows.conditions[k], **values, "solver.tolerance": TOLERANCE}
                session = self._sessions[k] = self.fmu.session(start)
            else:
                for name, value in values.items():
                    session.set(name, value)
            return settled_mean(session, SETTLING_PERIODS)
        except FrictionError as error:
            self.close()
            raise FrictionError(f"row {k + 1}: {error}") from None

    def close(self) -> None:
        for session in self._sessions:
            if session is not None:
                session.close()
        self._sessions = [None] * len(self.rows)

    def __enter__(self) -> Experiment:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def fit(experiment: Experiment, samples: int = 256, starts: int = 4) -> Fit:
    """Least squares from the best of some sampled starts, or from the given start values."""
    rows, parameters = experiment.rows, tuple(experiment.parameters)
    if len(rows) < len(parameters):
        names = ", ".join(p.name for p in parameters)
        raise UserError(f"{len(rows)} rows can't give {len(parameters)} parameters ({names})")
    weight = np.ones(len(rows)) if rows.uncertainty is None else 1.0 / np.array(rows.uncertainty)
    measured = np.array(rows.force)

    def residuals(x: np.ndarray) -> np.ndarray:
        return (experiment.means(x) - measured) * weight

    bounds = (
        [p.to_coordinate(p.low) for p in parameters],
        [p.to_coordinate(p.high) for p in parameters],
    )
    solutions = [
        least_squares(residuals, start, bounds=bounds, diff_step=DIFFERENCE, xtol=1e-10, ftol=1e-10)
        for start in _starts(parameters, residuals, samples, starts)
    ]
    solutions.sort(key=lambda solution: solution.cost)
    found = [
        np.array([_wrapped(p, value) for p, value in zip(parameters, solution.x, strict=True)])
        for solution in solutions
    ]
    result = _judged(experiment, found[0], residuals, weight)
    edge = region_bound(result, rows, 2.0 * solutions[0].cost)
    for x, solution in zip(found[1:], solutions[1:], strict=True):
        if np.max(np.abs(x - found[0])) > 0.05 and 2.0 * solution.cost < edge:
            values = ", ".join(
                f"{p.name} {p.to_value(value):.4g}" for p, value in zip(parameters, x, strict=True)
            )
            result.warnings.append(f"another solution lies within the 95 % region: {values}")
            break
    return result


def region_bound(result: Fit, rows: Measurements, least: float) -> float:
    """Sum of squares on the edge of the joint 95 % region; least is the one at the solution."""
    n = len(result.parameters)
    if rows.uncertainty is not None:
        return least + float(stats.chi2.ppf(0.95, n))
    if result.degrees == 0:
        return math.nan
    return least * (1.0 + n / result.degrees * float(stats.f.ppf(0.95, n, result.degrees)))


def _starts(parameters: Sequence[Parameter], residuals: Any, samples: int, starts: int) -> list[np.ndarray]:
    """The given start values, with the best of a Sobol sample for those that are not given."""
    if all(p.start is not None for p in parameters):
        return [np.array([p.to_coordinate(p.start) for p in parameters])]
    low, high = (np.array([p.to_coordinate(p.search[k]) for p in parameters]) for k in (0, 1))
    points = low + (high - low) * qmc.Sobol(len(parameters), scramble=False).random(samples)
    for k, p in enumerate(parameters):
        if p.start is not None:
            points[:, k] = p.to_coordinate(p.start)
    costs, problem = np.full(samples, np.inf), None
    for k, point in enumerate(points):
        try:
            costs[k] = np.sum(residuals(point) ** 2)
        except FrictionError as error:  # outside of what the model allows, for example d <= a_d
            problem = error
    if not np.isfinite(costs).any():
        raise problem or FrictionError("no start value works")
    return [points[k] for k in np.argsort(costs)[:starts] if np.isfinite(costs[k])]


def _wrapped(p: Parameter, coordinate: float) -> float:
    return coordinate % (2.0 * math.pi) if p.name == "vibration.phase_d" else coordinate


def _judged(experiment: Experiment, x: np.ndarray, residuals: Any, weight: np.ndarray) -> Fit:
    """Covariance, intervals and warnings at the solution."""
    rows, parameters = experiment.rows, tuple(experiment.parameters)
    at = residuals(x)
    jacobian = np.column_stack(
        [
            (residuals(x + step) - residuals(x - step)) / (2.0 * DIFFERENCE)
            for step in DIFFERENCE * np.eye(len(x))
        ]
    )
    degrees = len(rows) - len(parameters)
    known = rows.uncertainty is not None
    if known:
        variance, quantile = 1.0, float(stats.norm.ppf(0.975))
    elif degrees > 0:
        variance, quantile = float(at @ at) / degrees, float(stats.t.ppf(0.975, degrees))
    else:
        variance, quantile = math.nan, math.nan
    result = Fit(
        parameters=parameters,
        coordinates=x,
        covariance=variance * _inverse(jacobian.T @ jacobian),
        degrees=degrees,
        quantile=quantile,
        model=experiment.means(x),
        residuals=at / weight,
        deviation=math.nan if known else math.sqrt(variance),
        kappa=experiment.kappa(x),
    )
    result.warnings.extend(_warnings(result, rows, at, known))
    return result


def _inverse(information: np.ndarray) -> np.ndarray:
    """The inverse; infinite variances where a parameter, or a mixture of parameters, leaves no trace."""
    values, vectors = np.linalg.eigh(information)
    lost = values <= 1e-13 * max(values[-1], 1e-300)
    with np.errstate(divide="ignore"):
        inverse = (vectors[:, ~lost] / values[~lost]) @ vectors[:, ~lost].T
    for k in np.flatnonzero(lost):
        touched = np.abs(vectors[:, k]) > 1e-6
        inverse[touched, touched] = np.inf
    return inverse


def _warnings(result: Fit, rows: Measurements, at: np.ndarray, known: bool) -> list[str]:
    found = []
    if result.degrees == 0 and not known:
        found.append(
            "as many parameters as rows: the fit has nothing to check it, and no interval can be given"
        )
    elif result.degrees < 3:
        found.append(
            f"{len(rows)} rows for {len(result.parameters)} parameters: an identification, not a validation"
        )
    found += _stiffness_warnings(result, rows)
    for k, p in enumerate(result.parameters):
        width = result.half_widths[k]
        if not math.isnan(width) and width > (
            math.log(2.0) if p.logarithmic else _large(p, result.values[k])
        ):
            low, high = result.interval(k)
            span = (
                f"{low:.3g} to {high:.3g} {p.unit}".removesuffix(" 1") if math.isfinite(width) else "anything"
            )
            found.append(f"the data can't tell {p.name}: within 95 % it may be {span}")
        if result.values[k] <= p.low * (1 + 1e-6) or result.values[k] >= p.high * (1 - 1e-6):
            found.append(f"{p.name} ended at its bound {result.values[k]:g} {p.unit}")
    correlation = result.correlation
    for j in range(len(result.parameters)):
        for k in range(j):
            if abs(correlation[j, k]) > 0.95:
                pair = f"{result.parameters[k].name} and {result.parameters[j].name}"
                found.append(f"the data hardly tell {pair} apart: correlation {correlation[j, k]:.3f}")
    if known and result.degrees > 0 and (chance := float(stats.chi2.sf(at @ at, result.degrees))) < 0.01:
        found.append(f"the misfit is larger than the stated uncertainties allow (probability {chance:.1e})")
    return found


def _large(p: Parameter, value: float) -> float:
    """Half-width beyond which a value that may be zero is not known."""
    return math.pi / 4.0 if p.name == "vibration.phase_d" else abs(value)


def _stiffness_warnings(result: Fit, rows: Measurements) -> list[str]:
    reversing = [k for k, condition in enumerate(rows.conditions) if _moves(condition)]
    fitted = {p.name for p in result.parameters}
    if not reversing and not fitted & {"V", "vibration.V_1", "vibration.a_d"}:
        return [
            "no row has V < V_1, nor both V_1 and a_d: the means are F_C, and tell nothing about anything "
            "else"
        ]
    stiff = [p.name for p in result.parameters if p.name in STIFFNESS_LIKE]
    if stiff and reversing and min(result.kappa[reversing]) > STIFF:
        least = min(result.kappa[reversing])
        return [
            f"kappa = sigma V_1 / (2 pi f F_C) is at least {least:.3g}: beyond {STIFF:g} the mean friction "
            f"says nearly nothing about {', '.join(stiff)}"
        ]
    return []


def _moves(condition: Mapping[str, Any]) -> bool:
    """Whether the mean can differ from F_C: V reverses, or it varies while the stiffness does."""
    V_1 = float(condition.get("vibration.V_1", 0.0))
    return abs(float(condition.get("V", 0.0))) < V_1 or V_1 * float(condition.get("vibration.a_d", 0.0)) > 0.0
