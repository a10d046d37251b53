"""Steady sliding under a vibration purely normal to it (Dong 2015): how much friction falls, law by law.

The load over a period is F_n = load e^(-alpha cos) / I_0(alpha), alpha = lambda a_d / R_q. Neither alpha
nor the tangential stiffness k of the rig is known. Friction relative to its value without vibration
depends on alpha and on k / (mu load) alone. For each alpha, k is fitted to the slowest sliding and the
fastest one is predicted, as is one between them whose number is not at hand.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from frictioncontact.batch import simulate_many
from tools.validate.measurements import NormalVibration

LAWS = ("Dahl", "ElasticPlastic")
SWINGS = np.array([1.0, 1.3, 1.5, 2.0, 3.0, 5.0])  # alpha, how far the normal force swings: by e^(2 alpha)
R_Q, LAMBDA, LOAD, MU = 6e-6, 3.0, 100.0, 0.176  # any: only ratios count


@dataclass(frozen=True)
class NormalFit:
    law: str
    swing: float  # alpha
    yielding: float | None  # m, mu load / k fitted to the first row; None: no k reaches it
    predicted: float | None  # reduction at the second row
    between: float | None  # reduction at the velocity between, where nothing is at hand to compare


def hyperbola(data: NormalVibration) -> tuple[float, float]:
    """An empirical baseline, 1 / (1 + V / V_0) with V_0 from the first row: second row, between."""
    V_0 = data.V[0] * data.reduction[0] / (1.0 - data.reduction[0])
    return float(1.0 / (1.0 + data.V[1] / V_0)), float(1.0 / (1.0 + data.between / V_0))


def reduction(
    fmu: Path, law: str, f: float, V: np.ndarray, swing: float, yielding: np.ndarray, limit: str = "Load"
) -> np.ndarray:
    """Fall of the mean friction, over friction without vibration; V [m/s] and mu load / k [m] broadcast."""
    values = {
        "friction.model": law,
        "friction.limit": limit,
        **({"friction.mu": MU} if limit == "Load" else {"F_C": MU * LOAD}),
        "contact.model": "Constant",
        "contact.sigma": MU * LOAD / yielding,
        "contact.input": "Load",
        "load": LOAD,
        "contact.R_q": R_Q,
        "contact.lambda": LAMBDA,
        "vibration.f": f,
        "vibration.a_d": swing * R_Q / LAMBDA,
        "V": V,
    }
    return 1.0 - simulate_many(values, settled=True, fmu=fmu)["F_t_mean"] / (MU * LOAD)


def fit(fmu: Path, data: NormalVibration, law: str, swing: float) -> NormalFit:
    def missing(logarithm: float) -> float:
        at = reduction(fmu, law, data.f, data.V[0], swing, np.exp([logarithm]))
        return float(at[0]) - data.reduction[0]

    grid = np.log(np.logspace(-9.0, -3.0, 61))
    misses = reduction(fmu, law, data.f, data.V[0], swing, np.exp(grid)) - data.reduction[0]
    crossing = np.flatnonzero(np.sign(misses[:-1]) != np.sign(misses[1:]))
    if not len(crossing):
        return NormalFit(law, swing, None, None, None)
    root = np.exp(brentq(missing, grid[crossing[0]], grid[crossing[0] + 1]))
    V = np.array([data.V[1], data.between])
    predicted, between = map(float, reduction(fmu, law, data.f, V, swing, np.array([root])))
    return NormalFit(law, swing, float(root), predicted, between)
