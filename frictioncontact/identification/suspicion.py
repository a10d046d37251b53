"""Do the residuals of a fit look like scatter? Tests whose sum of false alarms is CHANCE, and what they point at.

What is left of pure scatter by the fit is (1 - H) z, with H the projection on the slopes of the fit and z
normal. Every test is a number of such residuals over their sum of squares; the scatter of the same number
over many draws of z tells how unlikely the residuals are, and the least of the probabilities over all tests is
held against the least of the draws' own (Westfall and Young, 1993).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from scipy.spatial import cKDTree

from frictioncontact.identification.data import Measurements
from frictioncontact.identification.experiment import Experiment
from frictioncontact.identification.result import Fit

CHANCE = 0.01  # of a law that fits to be doubted
DRAWS = 4000
HELD = 4_000_000  # numbers of draws at a time
FEW = 3  # rows for each value of a column whose values are groups, on average, at least

Statistic = Callable[[np.ndarray], np.ndarray]  # of residuals, [draw, row] -> [draw]; large where they are no scatter


def suspicion(experiment: Experiment, result: Fit, shapes: Mapping[str, np.ndarray]) -> tuple[float, str]:
    """How likely scatter gives residuals as odd as these, and in what they are the oddest.

    shapes: of faults, what each would add to the forces.
    """
    rows = len(experiment.force)
    left = _projection(result.slopes)
    statistics = _in_time(rows) if experiment.word == "sample" else _over_rows(experiment)
    for name, shape in shapes.items():
        seen = left(np.concatenate([shape * experiment.weight, np.zeros(len(result.slopes) - rows)])[None])[0]
        if np.linalg.norm(seen) > 1e-6 * np.linalg.norm(shape * experiment.weight):
            statistics[f"have the shape {name}"] = _along(seen[:rows])
    found = _values(statistics, (result.residuals * experiment.weight)[None, :])
    random = np.random.default_rng(0)
    size = max(1, HELD // len(result.slopes))
    drawn = np.concatenate(
        [
            _values(statistics, left(random.standard_normal((min(size, DRAWS - k), len(result.slopes))))[:, :rows])
            for k in range(0, DRAWS, size)
        ]
    )
    # The part of the draws that is at least as odd, for the residuals and for each draw.
    rank = np.argsort(np.argsort(-drawn, axis=0), axis=0) + 1.0
    own = np.mean(drawn >= found, axis=0)
    chance = float(np.mean(rank.min(axis=1) / DRAWS <= own.min()))
    return max(chance, 1.0 / DRAWS), list(statistics)[int(np.argmin(own))]


def visible(experiment: Experiment, result: Fit, shape: np.ndarray) -> float:
    """The part of a fault's shape that the parameters can't make up for, from 0 to 1."""
    rows = len(experiment.force)
    whole = np.concatenate([shape * experiment.weight, np.zeros(len(result.slopes) - rows)])
    size = float(np.linalg.norm(whole))
    return float(np.linalg.norm(_projection(result.slopes)(whole[None])[0])) / size if size > 0.0 else 0.0


def _projection(slopes: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """What a fit leaves of [draw, residual]."""
    scale = np.linalg.norm(slopes, axis=0)
    u, size, _ = np.linalg.svd(slopes[:, scale > 0.0] / scale[scale > 0.0], full_matrices=False)
    basis = u[:, size > 1e-9 * size.max(initial=0.0)]
    return lambda residuals: residuals - (residuals @ basis) @ basis.T


def _values(statistics: Mapping[str, Statistic], residuals: np.ndarray) -> np.ndarray:
    """[draw, statistic]"""
    unit = residuals / np.maximum(np.linalg.norm(residuals, axis=1, keepdims=True), 1e-300)
    return np.stack([statistic(unit) for statistic in statistics.values()], axis=1)


def _along(direction: np.ndarray) -> Statistic:
    return lambda r: np.abs(r @ direction) / np.linalg.norm(direction)


def _in_time(samples: int) -> dict[str, Statistic]:
    """Sums over blocks of samples, of several lengths."""
    lengths = [2**k for k in range(1, 12) if 2**k <= samples // 4]
    return {f"to {length} neighbouring samples are alike": _blocks(length) for length in lengths}


def _blocks(length: int) -> Statistic:
    def statistic(r: np.ndarray) -> np.ndarray:
        whole = r[:, : r.shape[1] // length * length].reshape(len(r), -1, length)
        return np.sum(whole.sum(axis=2) ** 2, axis=1)

    return statistic


def _over_rows(experiment: Experiment) -> dict[str, Statistic]:
    """Rows of neighbouring values, of each column and of all; groups of rows that share a value."""
    assert isinstance(experiment.rows, Measurements)
    conditions = experiment.rows.conditions
    columns = {name: np.array([row[name] for row in conditions], dtype=float) for name in experiment.rows.names}
    varied = {name: values for name, values in columns.items() if len(np.unique(values)) > 1}
    found: dict[str, Statistic] = {}
    for name, values in varied.items():
        others = [np.round(each, 12) for other, each in varied.items() if other != name]
        strata = np.unique(np.stack(others), axis=1, return_inverse=True)[1] if others else np.zeros(len(values))
        strata = strata if len(np.unique(strata)) * FEW <= len(values) else np.zeros(len(values))
        groups = [values == each for each in np.unique(values)]
        if len(groups) * FEW <= len(values):
            found[f"to the rows of one {name} are alike"] = _means(groups)
            found[f"are far larger at one {name} than at others"] = _sizes(groups, experiment.force)
        else:
            order = np.lexsort((*others, values, strata))
            pairs = np.stack([order[:-1], order[1:]])
            found[f"to rows of neighbouring {name} are alike"] = _neighbours(pairs[:, strata[pairs[0]] == strata[pairs[1]]])
    if len(varied) > 1:
        ranks = np.stack([np.unique(each, return_inverse=True)[1] / (len(np.unique(each)) - 1) for each in varied.values()])
        near = cKDTree(ranks.T).query(ranks.T, 3)[1][:, 1:]
        found["to rows of like conditions are alike"] = _neighbours(np.stack([np.repeat(np.arange(len(near)), 2), near.ravel()]))
    return found


def _neighbours(pairs: np.ndarray) -> Statistic:
    return lambda r: -np.sum((r[:, pairs[0]] - r[:, pairs[1]]) ** 2, axis=1)


def _means(groups: list[np.ndarray]) -> Statistic:
    return lambda r: np.sum([r[:, group].sum(axis=1) ** 2 / group.sum() for group in groups], axis=0)


def _sizes(groups: list[np.ndarray], force: np.ndarray) -> Statistic:
    """Of the group that misses by the most, both in N and over its force."""
    relative = [np.mean(force**2) / max(np.mean(force[group] ** 2), 1e-300) for group in groups]

    def statistic(r: np.ndarray) -> np.ndarray:
        sizes = np.stack([np.mean(r[:, group] ** 2, axis=1) for group in groups])
        return np.max(np.minimum(sizes, sizes * np.array(relative)[:, None]), axis=0)

    return statistic
