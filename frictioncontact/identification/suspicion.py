"""Do the residuals of a fit look like scatter? Tests whose sum of false alarms is CHANCE.

What a fit leaves of pure scatter is (1 - H) z, with H the projection on the slopes of the fit and z normal.
Every test is a number of such residuals over their length. The scatter of that number over draws of z tells
how odd the residuals are. The least of the probabilities over all tests is held against the least of the
draws' own (Westfall and Young, 1993).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from scipy.spatial import cKDTree

from frictioncontact.identification.experiment import Experiment
from frictioncontact.identification.result import Fit

CHANCE = 0.01  # of a law that fits to be doubted
DRAWS = 4000
HELD = 4_000_000  # numbers of draws at a time
FEW = 3  # rows for each value of a column whose values are groups, on average, at least

# Of residuals of length 1, [draw, row] -> [draw]; large where they are no scatter.
Statistic = Callable[[np.ndarray], np.ndarray]


def suspicion(experiment: Experiment, result: Fit, shapes: Mapping[str, np.ndarray]) -> tuple[float, str]:
    """How likely scatter gives residuals as odd as these, and in what they are the oddest.

    shapes: of faults, what each would add to the forces.
    """
    rows, total = len(experiment.force), len(result.slopes)
    tests = _in_time(rows) if experiment.word == "sample" else _over_rows(experiment)
    for fault, shape in shapes.items():
        seen = visible(experiment, result, shape)
        if np.linalg.norm(seen) > 1e-6 * np.linalg.norm(shape * experiment.weight):
            tests[f"have the shape of {fault}"] = _along(seen)

    def values(residuals: np.ndarray) -> np.ndarray:
        unit = residuals / np.linalg.norm(residuals, axis=1, keepdims=True)
        return np.stack([test(unit) for test in tests.values()], axis=1)

    random, left, step = np.random.default_rng(0), _projection(result.slopes), max(1, HELD // total)
    sizes = [min(step, DRAWS - k) for k in range(0, DRAWS, step)]
    drawn = np.concatenate([values(left(random.standard_normal((n, total)))[:, :rows]) for n in sizes])
    own = np.mean(drawn >= values((result.residuals * experiment.weight)[None, :]), axis=0)
    ranks = np.argsort(np.argsort(-drawn, axis=0), axis=0) + 1.0
    chance = float(np.mean(ranks.min(axis=1) / DRAWS <= own.min()))
    return max(chance, 1.0 / DRAWS), list(tests)[int(np.argmin(own))]


def visible(experiment: Experiment, result: Fit, shape: np.ndarray) -> np.ndarray:
    """What a fault adds to the residuals: what the parameters can't make up for, in standard deviations."""
    rest = np.zeros(len(result.slopes) - len(shape))
    return _projection(result.slopes)(np.concatenate([shape * experiment.weight, rest])[None])[
        0, : len(shape)
    ]


def _projection(slopes: np.ndarray) -> Statistic:
    """What a fit leaves of [draw, residual]."""
    scale = np.linalg.norm(slopes, axis=0)
    u, size, _ = np.linalg.svd(slopes[:, scale > 0.0] / scale[scale > 0.0], full_matrices=False)
    basis = u[:, size > 1e-9 * size.max(initial=0.0)]
    return lambda residuals: residuals - (residuals @ basis) @ basis.T


def _along(direction: np.ndarray) -> Statistic:
    return lambda r: np.abs(r @ direction) / np.linalg.norm(direction)


def _in_time(samples: int) -> dict[str, Statistic]:
    """Sums over blocks of samples, of several lengths; the largest."""

    def blocks(length: int) -> Statistic:
        whole = samples // length
        return lambda r: np.sum(r[:, : whole * length].reshape(-1, whole, length).sum(axis=2) ** 2, axis=1)

    lengths = [2**k for k in range(1, 12) if 2**k <= max(samples // 4, 2)]
    found = {f"to {length} neighbouring samples are alike": blocks(length) for length in lengths}
    return {**found, "are far larger at a sample than at others": lambda r: np.abs(r).max(axis=1)}


def _over_rows(experiment: Experiment) -> dict[str, Statistic]:
    """Rows of neighbouring values, of each column and of all; the sizes in groups that share a value."""
    columns = {name: experiment.rows.column(name) for name in experiment.rows.names}
    ranks = {name: np.unique(each, return_inverse=True)[1] for name, each in columns.items()}
    varied = {name: each for name, each in ranks.items() if each.max() > 0}
    found: dict[str, Statistic] = {}
    for name, rank in varied.items():
        others = [each for other, each in varied.items() if other != name]
        strata = rank
        if (rank.max() + 1) * FEW <= len(rank):
            groups = [rank == k for k in range(rank.max() + 1)]
            found[f"are far larger at one {name} than at others"] = _sizes(groups, experiment.force)
        else:
            strata = np.unique([*others, 0 * rank], axis=1, return_inverse=True)[1].ravel()
            strata = strata if (strata.max() + 1) * FEW <= len(rank) else 0 * rank
        order = np.lexsort((*others, rank, strata))
        pairs = np.stack([order[:-1], order[1:]])
        same = pairs[:, strata[pairs[0]] == strata[pairs[1]]]
        found[f"to rows of neighbouring {name} are alike"] = _neighbours(same)
    if len(varied) > 1:
        places = np.stack([rank / rank.max() for rank in varied.values()], axis=1)
        near = cKDTree(places).query(places, min(3, len(places)))[1][:, 1:]
        pairs = np.stack([np.repeat(np.arange(len(near)), near.shape[1]), near.ravel()])
        found["to rows of like conditions are alike"] = _neighbours(pairs)
    return found


def _neighbours(pairs: np.ndarray) -> Statistic:
    return lambda r: -np.sum((r[:, pairs[0]] - r[:, pairs[1]]) ** 2, axis=1)


def _sizes(groups: list[np.ndarray], force: np.ndarray) -> Statistic:
    """Of the group that misses by the most, both in N and over its force."""
    relative = np.array([np.mean(force**2) / max(np.mean(force[group] ** 2), 1e-300) for group in groups])

    def size(r: np.ndarray) -> np.ndarray:
        sizes = np.stack([np.mean(r[:, group] ** 2, axis=1) for group in groups], axis=1)
        return np.max(sizes * np.minimum(1.0, relative), axis=1)

    return size
