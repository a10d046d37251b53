"""Intervals by simulation: new data from the fitted law with new noise, fitted again, many times."""

import math

import numpy as np

from frictioncontact.errors import UserError
from frictioncontact.identification.experiment import Experiment
from frictioncontact.identification.result import Fit, nearest_turn
from frictioncontact.identification.search import Tell, silent, solve

MINIMA = 2  # from which each refit starts


def bootstrap(experiment: Experiment, result: Fit, refits: int, tell: Tell = silent) -> np.ndarray:
    """Coordinates of every refit, [refit, parameter]; their 2.5 % and 97.5 % quantiles are an interval.

    The noise is normal, with the stated uncertainties or the estimated scatter; measured inputs get theirs.
    """
    if not math.isfinite(result.variance):
        raise UserError("--bootstrap needs a scatter: state the uncertainty of the force, or give more rows")
    found = []
    for k, target in enumerate(noisy(experiment, result, refits)):
        tell(f"refit {k + 1} of {refits}")
        solutions = [solve(experiment, one.point, target) for one in result.minima[:MINIMA]]
        best = min(solutions, key=lambda one: one.squares)
        found.append(nearest_turn(result.parameters, best.point, result.point)[: len(result.parameters)])
    return np.array(found)


def noisy(experiment: Experiment, result: Fit, count: int) -> np.ndarray:
    """Targets as Experiment.target: what the fitted law would have given in count new measurements."""
    rows = len(experiment.force)
    deviation = 1.0 / experiment.weight if experiment.known else np.full(rows, math.sqrt(result.variance))
    random = np.random.default_rng(0).standard_normal((count, len(experiment.target)))
    nuisances = result.point[len(experiment.parameters) :]
    measured = [x for x, one in zip(nuisances, experiment.nuisances, strict=True) if one.measured]
    deviations = np.concatenate([deviation, np.ones(len(measured))])
    return np.concatenate([result.model, measured]) + random * deviations


def quantiles(result: Fit, points: np.ndarray, k: int) -> tuple[float, float]:
    """The interval of parameter k, as values."""
    low, high = np.quantile(points[:, k], (0.025, 0.975))
    p = result.parameters[k]
    return p.to_value(float(low)), p.to_value(float(high))
