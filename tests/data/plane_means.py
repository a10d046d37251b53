"""Means under a vibration in the plane, by formulas and to six digits; F_C, constant stiffness, V along."""

from __future__ import annotations

import math

from scipy.special import ellipe, ellipk

ZETA = (0.02, 0.1, 0.5, 2.0)  # V / V_2

# law, kappa = sigma V_2 / (2 pi f F_C), circular instead of transverse, and the means of F_t over F_C at ZETA
MEANS = [
    ("Dahl", 1, False, (0.032034, 0.156855, 0.601966, 0.944313)),
    ("Dahl", 100, False, (0.055108, 0.229942, 0.642583, 0.945006)),
    ("ElasticPlastic", 3, False, (0.059552, 0.283433, 0.689144, 0.946266)),
    ("ElasticPlastic", 30, False, (0.066647, 0.256176, 0.643465, 0.945019)),
    ("Dahl", 1, True, (0.015000, 0.075031, 0.377154, 0.932768)),
    ("ElasticPlastic", 3, True, (0.009428, 0.047134, 0.233663, 0.937656)),
]


def coulomb_across(zeta: float) -> float:
    m = 1 / (1 + zeta**2)
    return float(2 / math.pi * zeta * math.sqrt(m) * ellipk(m))


def coulomb_around(zeta: float) -> float:
    """The derivative of (2 / pi) (1 + zeta) E(m), m = 4 zeta / (1 + zeta)^2; dE/dm = (E - K) / (2 m)."""
    m = 4 * zeta / (1 + zeta) ** 2
    return float(2 / math.pi * (ellipe(m) + (ellipe(m) - ellipk(m)) * (1 - zeta) / (2 * zeta)))


def soft_dahl(zeta: float) -> float:
    """Of a bristle that averages over the vibration: V over the mean of |V|; kappa -> 0, transverse."""
    m = 1 / (1 + zeta**2)
    return float(zeta / (2 / math.pi / math.sqrt(m) * ellipe(m)))
