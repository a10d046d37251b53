"""What could mend ElasticPlastic's misfit of the cycles: more elements, or a force besides.

ElasticPlastic is one Jenkins element, a spring in series with a slider. Several in parallel round its kink:
Iwan (1966) takes infinitely many of one stiffness whose limits are spread evenly. A force that is the same
on the way to and fro, proportional to the load, tilts the friction instead. Each is fitted to the cycles
that the laws are fitted to, and predicts the others.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from tools.validate.measurements import Record, rms
from tools.validate.record import fitted_cycles, predicted_cycles, sliding_friction

IWAN = 32  # elements that stand for infinitely many
Elements = tuple[np.ndarray, np.ndarray, float]  # stiffness [N/m] and limit / load of each; tilt [N/N]


@dataclass(frozen=True)
class ElementFit:
    name: str
    rms_fitted: float  # over the sliding friction
    rms_predicted: float
    tilt: float  # N/N


def forces(record: Record, elements: Elements) -> np.ndarray:
    """The sum of the elements' forces and of the tilt [N] at the samples."""
    stiffness, limit, tilt = elements
    share = (record.friction[0] - tilt * record.load[0]) / (limit.sum() * record.load[0])
    each = limit * record.load[0] * np.clip(share, -1.0, 1.0)
    sums = [each.sum()]
    for dx, load in zip(np.diff(record.position), record.load[1:], strict=True):
        each = np.clip(each + stiffness * dx, -limit * load, limit * load)
        sums.append(each.sum())
    return np.array(sums) + tilt * record.load


def parallel(count: int) -> Callable[[Sequence[float]], Elements]:
    """Elements of any stiffness and limit; parameters: their logarithms."""
    return lambda x: (np.exp(x[:count]), np.exp(x[count : 2 * count]), 0.0)


def iwan(x: Sequence[float]) -> Elements:
    """Limits spread evenly by a part x[2] in 0..1 of their mean; x[0], x[1]: logarithms of the sums."""
    spread = 1.0 + x[2] * (2.0 * np.arange(IWAN) + 1.0 - IWAN) / IWAN
    return np.full(IWAN, np.exp(x[0]) / IWAN), np.exp(x[1]) / IWAN * spread, 0.0


def tilted(x: Sequence[float]) -> Elements:
    """One element and a force that is x[2] times the load."""
    return np.exp([x[0]]), np.exp([x[1]]), float(x[2])


def fits(record: Record) -> list[ElementFit]:
    """Every variant, fitted to the fitted cycles of the record."""
    one = np.log([4e4, 0.47])
    variants = (
        ("one element, ElasticPlastic", parallel(1), one),
        ("two in parallel", parallel(2), np.log([2e4, 2e4, 0.3, 0.17])),
        ("four in parallel", parallel(4), np.log([1e4, 1e4, 1e4, 1e4, 0.18, 0.14, 0.1, 0.05])),
        ("Iwan's distribution", iwan, np.array([*one, 0.3])),
        ("one element and a force proportional to the load", tilted, np.array([*one, 0.0])),
    )
    return [_fit(record, *variant) for variant in variants]


def _fit(
    record: Record, name: str, elements: Callable[[Sequence[float]], Elements], guess: np.ndarray
) -> ElementFit:
    sliding = sliding_friction(record)
    cycles, predicted = fitted_cycles(record), predicted_cycles(record)
    high = np.full(len(guess), np.inf)
    if elements is iwan:
        high[2] = 1.0
    result = least_squares(
        lambda x: forces(cycles, elements(x)) - cycles.friction, guess, diff_step=1e-4, bounds=(-high, high)
    )
    error = forces(predicted, elements(result.x)) - predicted.friction
    return ElementFit(name, rms(result.fun) / sliding, rms(error) / sliding, elements(result.x)[2])
