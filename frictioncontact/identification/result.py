"""What a fit finds: the least sum of squares, its linear intervals, the other minima, the profiles."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy import stats

from frictioncontact.identification.parameter import Parameter


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
