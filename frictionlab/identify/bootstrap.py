"""Intervals by simulation: new data from the fitted law with new noise, fitted again, many times."""

from __future__ import annotations

import math

import numpy as np

from frictionlab.identify.experiment import Experiment
from frictionlab.identify.fit import Fit
from frictionlab.identify.least_squares import solve
from frictionlab.project import UserError

MINIMA = 2  # from which each refit starts


def bootstrap(experiment: Experiment, result: Fit, refits: int, seed: int = 0) -> np.ndarray:
    """Coordinates of every refit, [refit, parameter]; their 2.5 % and 97.5 % quantiles are an interval.

    The noise is normal, with the stated uncertainties or the estimated scatter; measured inputs get theirs.
    """
    if not math.isfinite(result.variance):
        raise UserError("--bootstrap needs a scatter: state the uncertainty of the force, or give more rows")
    targets = noisy(experiment, result, refits, seed)
    seeds = np.array([one.point for one in result.minima[:MINIMA]])
    starts = np.tile(seeds, (refits, 1))
    found = solve(experiment, starts, np.repeat(targets, len(seeds), axis=0), together=len(seeds))
    best = np.argmin(found.squares.reshape(refits, len(seeds)), axis=1)
    points = found.x.reshape(refits, len(seeds), -1)[np.arange(refits), best]
    points = points[:, : len(result.parameters)]
    for k, p in enumerate(result.parameters):
        if p.periodic:  # the turn nearest to the solution
            away = (points[:, k] - result.point[k] + math.pi) % (2.0 * math.pi) - math.pi
            points[:, k] = result.point[k] + away
    return points


def noisy(experiment: Experiment, result: Fit, count: int, seed: int) -> np.ndarray:
    """Targets as Experiment.target: what the fitted law would have given in count new measurements."""
    rows = len(experiment.force)
    deviation = 1.0 / experiment.weight if experiment.known else np.full(rows, math.sqrt(result.variance))
    random = np.random.default_rng(seed).standard_normal((count, len(experiment.target)))
    centre = np.concatenate([result.model, _measured(experiment, result.point)])
    return centre + random * np.concatenate([deviation, np.ones(len(centre) - rows)])


def _measured(experiment: Experiment, point: np.ndarray) -> np.ndarray:
    nuisances = point[len(experiment.parameters) :]
    return np.array([x for x, one in zip(nuisances, experiment.nuisances, strict=True) if one.measured])


def quantiles(result: Fit, points: np.ndarray, k: int) -> tuple[float, float]:
    """The interval of parameter k, as values."""
    low, high = np.quantile(points[:, k], (0.025, 0.975))
    p = result.parameters[k]
    return p.to_value(float(low)), p.to_value(float(high))
