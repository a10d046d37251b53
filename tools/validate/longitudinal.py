"""Sliding under a vibration along it (Luo 2024): the mean friction of the periodic state, law by law.

Fixed beforehand: F_C is the friction measured without vibration at the same velocity; frequency and
amplitude are the authors'. LuGre's static ratio is the measured static friction over that of the fastest
sliding. Fitted: one tangential stiffness, by least squares on the vibrated rows. Predicted: each row by
the stiffness fitted to the others.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar

from frictioncontact.batch import simulate_many
from tools.validate.measurements import Sliding

LAWS = ("Coulomb", "Dahl", "LuGre", "ElasticPlastic")
STIFFNESSES = np.logspace(3.0, 11.0, 161)  # N/m, searched; constant beyond for all laws
STRIBECK = 1e-4  # m/s, of LuGre: friction without vibration falls over the first 0.1 mm/s


@dataclass(frozen=True)
class Fit:
    """One law against the vibrated rows. Forces in N."""

    law: str
    stiffness: float | None  # N/m; None where the law has none
    factor: float  # by which the stiffness of the leave-one-out fits varies, largest over least
    model: np.ndarray  # with the stiffness fitted to all rows
    predicted: np.ndarray  # each row by the stiffness fitted to the others
    least: np.ndarray  # over all stiffnesses searched
    most: np.ndarray


def constant_force(data: Sliding) -> Fit:
    """The plain baseline: one force for every row."""
    return _straight("a constant force", data, np.ones((len(data.V), 1)))


def constant_ratio(data: Sliding) -> Fit:
    """An empirical baseline: vibration multiplies friction by a number."""
    return _straight("a constant ratio", data, data.without[:, None])


def logarithm(data: Sliding) -> Fit:
    """An empirical baseline: a + b ln V, two numbers."""
    return _straight("a + b ln V", data, np.column_stack([np.ones(len(data.V)), np.log(data.V)]))


BASELINES = (constant_force, constant_ratio, logarithm)


def _straight(name: str, data: Sliding, columns: np.ndarray) -> Fit:
    """The vibrated rows as a sum of columns, by least squares; each row besides by the others."""
    rows = np.arange(len(data.V))

    def numbers(kept: np.ndarray) -> np.ndarray:
        return np.linalg.lstsq(columns[kept], data.vibrated[kept], rcond=None)[0]

    model = columns @ numbers(rows)
    predicted = np.array([columns[k] @ numbers(rows[rows != k]) for k in rows])
    return Fit(name, None, 1.0, model, predicted, model, model)


def fit(fmu: Path, data: Sliding, law: str) -> Fit:
    """Least squares over the stiffness; on a grid first, since the misfit has several minima."""

    def means(stiffness: np.ndarray) -> np.ndarray:
        """Mean friction [N], a row a stiffness [N/m]."""
        values = {
            "friction.model": law,
            "contact.model": "Constant",
            "contact.sigma": np.atleast_1d(stiffness)[:, None],
            "vibration.f": data.f,
            "vibration.V_1": data.V_1,
            "V": data.V,
            "F_C": data.without,
        }
        if law == "LuGre":
            values["friction.staticRatio"] = data.static_without / data.without[-1]
            values["friction.V_S"] = STRIBECK
        return simulate_many(values, settled=True, fmu=fmu)["F_t_mean"]

    grid = means(STIFFNESSES)
    rows = np.arange(len(data.V))
    if law == "Coulomb":
        return Fit(law, None, 1.0, grid[0], grid[0], grid[0], grid[0])

    def best(kept: np.ndarray) -> float:
        def misfit(logarithm: float) -> float:
            return float(np.sum((means(np.exp([logarithm]))[0] - data.vibrated)[kept] ** 2))

        k = int(np.argmin(np.sum((grid - data.vibrated)[:, kept] ** 2, axis=1)))
        around = np.log(STIFFNESSES[[max(k - 1, 0), min(k + 1, len(STIFFNESSES) - 1)]])
        return float(np.exp(minimize_scalar(misfit, bounds=tuple(around), method="bounded").x))

    stiffness = best(rows)
    others = [best(rows[rows != k]) for k in rows]
    predicted, model = np.diagonal(means(np.array(others))), means(np.array([stiffness]))[0]
    factor = max(others) / min(others)
    return Fit(law, stiffness, factor, model, predicted, grid.min(axis=0), grid.max(axis=0))
