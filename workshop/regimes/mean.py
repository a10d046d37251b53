"""Mean friction over the regimes, from the FMU: what it is sensitive to, and its closed-form limits.

Three numbers say where a vibrating contact is:

    kappa = sigma V_1 / (2 pi f F_C)   how often the bristle saturates in one swing: stiff above 1, soft below
    zeta  = V / V_1                    sliding against vibration; without reversals (zeta > 1) the mean is F_C
    alpha = a_d / R_q                  how much the separation moves
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from frictioncontact.batch import simulate_many
from frictioncontact.parameters import (
    COULOMB_FORCE,
    E_FULL,
    FREQUENCY,
    SEPARATION,
    STIFFNESS_PRINTED,
    Surfaces,
)

R_Q, DECAY = Surfaces.R_q, Surfaces.lambda_
V_1 = 1.0  # m/s: any value gives the same maps
STEP = 1e-3  # of the central differences, relative or in rad
Numbers = float | np.ndarray
PARAMETERS = ("V", "V_1", "d", "a_d", "phase_d", "E", "F_C")


@dataclass(frozen=True)
class Regime:
    """Vibrating contacts at d = 14 um and the full modulus, and factors on what a sensitivity changes.

    Each field is a number or an array; arrays broadcast, to as many regimes.
    """

    kappa: Numbers
    zeta: Numbers
    alpha: Numbers = 0.0
    phase_d: Numbers = 0.0  # rad
    V: float = 1.0
    V_1: float = 1.0
    d: float = 1.0
    a_d: float = 1.0
    E: float = 1.0
    F_C: float = 1.0

    def start_values(self) -> dict[str, Numbers]:
        sigma = self.kappa * 2.0 * math.pi * FREQUENCY * COULOMB_FORCE / V_1
        return {
            "V": self.V * self.zeta * V_1,
            "d": self.d * SEPARATION,
            "E": self.E * E_FULL,
            "F_C": self.F_C * COULOMB_FORCE,
            "contact.stiffnessScale": sigma / STIFFNESS_PRINTED,
            "vibration.f": FREQUENCY,
            "vibration.V_1": self.V_1 * V_1,
            "vibration.a_d": self.a_d * self.alpha * R_Q,
            "vibration.phase_d": self.phase_d,
        }


@dataclass(frozen=True)
class Probe:
    """Mean forces of many regimes at once."""

    fmu: Path
    tolerance: float = 1e-6

    def mean(self, regime: Regime) -> np.ndarray:
        """Mean forces over F_C of the unchanged regime, of the shape of the regimes."""
        values = {**regime.start_values(), "solver.tolerance": self.tolerance}
        force = simulate_many(values, settled=True, fmu=self.fmu)["F_t_mean"]
        return force / COULOMB_FORCE

    def sensitivity(self, regime: Regime, name: str) -> np.ndarray:
        """d(mean) / d(ln p) over F_C; for phase_d per rad."""
        if name == "phase_d":
            above, below = (replace(regime, phase_d=regime.phase_d + h) for h in (STEP, -STEP))
        else:
            above, below = (replace(regime, **{name: math.exp(h)}) for h in (STEP, -STEP))
        return (self.mean(above) - self.mean(below)) / (2.0 * STEP)


def on_map(
    kappas: Sequence[float], zetas: Sequence[float], alpha: float = 0.0, phase_d: float = 0.0
) -> Regime:
    """Regimes in rows over zeta, columns over kappa."""
    return Regime(np.asarray(kappas), np.asarray(zetas)[:, None], alpha, phase_d)


def coulomb_limit(zeta: float) -> float:
    """Mean over F_C for kappa -> infinity, whatever the separation does."""
    return 1.0 if zeta >= 1.0 else 2.0 / math.pi * math.asin(zeta)


def soft_limit(zeta: float, alpha: float = 0.0, phase_d: float = 0.0, points: int = 4096) -> float:
    """Mean over F_C for kappa -> 0.

    delta stands still at F_C <V> / <sigma |V|>, so the mean is zeta <sigma> / <sigma |zeta + cos|>. Without
    normal vibration this is zeta over the mean of |zeta + cos|.
    """
    theta = 2.0 * math.pi * (np.arange(points) + 0.5) / points
    shift = alpha * R_Q * np.cos(theta + phase_d)
    sigma = np.exp(-2.0 * DECAY * shift / R_Q) / (1.0 + shift / SEPARATION) ** 3
    return float(np.mean(sigma) * zeta / np.mean(sigma * np.abs(zeta + np.cos(theta))))


def coulomb_sensitivity(zeta: float, name: str) -> float:
    """The limit of Probe.sensitivity for kappa -> infinity."""
    slope = 0.0 if zeta >= 1.0 else 2.0 / math.pi * zeta / math.sqrt(1.0 - zeta**2)
    return {"V": slope, "V_1": -slope, "F_C": coulomb_limit(zeta)}.get(name, 0.0)


def soft_sensitivity(zeta: float, name: str, alpha: float, phase_d: float) -> float:
    """The limit of Probe.sensitivity for kappa -> 0; d enters it only through (d + a_d cos)^-3 in Eq. 3."""
    if name == "F_C":
        return soft_limit(zeta, alpha, phase_d)

    def limit(step: float) -> float:
        of_zeta = math.exp({"V": step, "V_1": -step}.get(name, 0.0))
        of_alpha = math.exp(step if name == "a_d" else 0.0)
        return soft_limit(of_zeta * zeta, of_alpha * alpha, phase_d + (step if name == "phase_d" else 0.0))

    return (limit(STEP) - limit(-STEP)) / (2.0 * STEP)


# What decides a regime, as classes of `regime_map`.
REGIMES = (
    "Coulomb",
    "Dahl, constant stiffness",
    "Dahl, moving separation",
    "mean friction may be negative",
)


def regime_map(
    probe: Probe,
    kappas: Sequence[float],
    zetas: Sequence[float],
    alpha: float,
    threshold: float = 0.01,
    phases: int = 12,
) -> np.ndarray:
    """Index into REGIMES: the simplest model whose mean is within threshold F_C at every phase."""
    angles = 2.0 * math.pi * np.arange(phases if alpha else 1) / phases
    regimes = on_map(kappas, zetas)
    constant = probe.mean(regimes)
    moving = probe.mean(replace(regimes, alpha=alpha, phase_d=angles[:, None, None]))
    coulomb = np.array([coulomb_limit(zeta) for zeta in zetas])[:, None]
    classes = (
        (np.min(moving, axis=0) < -threshold, 3),
        (np.max(np.abs(moving - coulomb), axis=0) <= threshold, 0),
        (np.max(np.abs(moving - constant), axis=0) <= threshold, 1),
    )
    return np.select([holds for holds, _ in classes], [index for _, index in classes], 2)
