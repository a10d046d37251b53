"""Formulas that hunt/reference.c and the FMU are graded with: Eq. 3, 9, 12-14, 20-22, means of vibrations."""

from __future__ import annotations

import math
from typing import Any

from mpmath import mp, mpf
from scipy.special import ellipe, ellipk

# ---- the contact, at 30 digits; its parameters are those of the FMU's names without contact. ----


class Contact:
    """Without stiffnessScale."""

    def __init__(self, parameters: dict[str, float], d: Any, E: Any) -> None:
        with mp.workdps(30):
            R_q, R, eta, A_n, nu, Y, c, lam = (
                mpf(parameters[name]) for name in ("R_q", "R", "eta", "A_n", "nu", "Y", "c", "lambda")
            )
            E = mpf(E)
            p_m = (mpf("1.234") + mpf("1.256") * nu) * (1 - nu**2) * Y  # Eq. 12, 14
            x = lam * (mp.pi * p_m / (2 * E)) ** 2 * R / R_q  # lambda omega_c / R_q, Eq. 13
            reaching = eta * A_n * c * mp.exp(-lam * mpf(d) / R_q)
            # Eq. 20-22: elastic and plastic contacts
            shares = 1 - (1 + x) * mp.exp(-x) + (2 + x) * mp.exp(-x)
            self.A_r = reaching * mp.pi * R * R_q / lam**2 * shares
            # Eq. 9 and 16
            elastic = mpf(4) / 3 * E * mp.sqrt(R * R_q**3 / lam**5) * mp.gammainc(mpf("2.5"), 0, x)
            self.F_n = reaching * (elastic + mp.pi * R * R_q * p_m * (2 + x) * mp.exp(-x) / lam**2)
            self.asperities = E * self.A_r**2 / mpf(d) ** 3  # Eq. 3
            s = mpf("1.5")
            plastic = (2 / lam) ** s * mp.exp(-x / 2) * mp.gammainc(s, x / 2) / 2
            tangential = 2 * (1 - nu) / (2 - nu)
            stiffness = 2 * E * tangential * mp.sqrt(R * R_q) * (mp.gammainc(s, 0, x) / lam**s + plastic)
            self.mindlin = reaching * stiffness


# ---- means over F_C under a vibration, zeta = V / its amplitude, F_C and the stiffness constant ----

ZETA = (0.02, 0.1, 0.5, 2.0)
# law, kappa = sigma V_2 / (2 pi f F_C), circular instead of transverse, and the means of F_t over F_C at ZETA
MEANS = [
    ("Dahl", 1, False, (0.032034, 0.156855, 0.601966, 0.944313)),
    ("Dahl", 100, False, (0.055108, 0.229942, 0.642583, 0.945006)),
    ("ElasticPlastic", 3, False, (0.059552, 0.283433, 0.689144, 0.946266)),
    ("ElasticPlastic", 30, False, (0.066647, 0.256176, 0.643465, 0.945019)),
    ("Dahl", 1, True, (0.015000, 0.075031, 0.377154, 0.932768)),
    ("ElasticPlastic", 3, True, (0.009428, 0.047134, 0.233663, 0.937656)),
]


def coulomb_along(zeta: float) -> float:
    return 2.0 / math.pi * math.asin(max(-1.0, min(zeta, 1.0)))


def soft_along(zeta: float) -> float:
    """Of a bristle that averages over the vibration, kappa -> 0: V over the mean of |V|."""
    return zeta / (2 / math.pi * (math.sqrt(1 - zeta**2) + zeta * math.asin(zeta)))


def coulomb_across(zeta: float) -> float:
    m = 1 / (1 + zeta**2)
    return float(2 / math.pi * zeta * math.sqrt(m) * ellipk(m))


def coulomb_around(zeta: float) -> float:
    """The derivative of (2 / pi) (1 + zeta) E(m), m = 4 zeta / (1 + zeta)^2; dE/dm = (E - K) / (2 m)."""
    m = 4 * zeta / (1 + zeta) ** 2
    return float(2 / math.pi * (ellipe(m) + (ellipe(m) - ellipk(m)) * (1 - zeta) / (2 * zeta)))


def soft_across(zeta: float) -> float:
    m = 1 / (1 + zeta**2)
    return float(zeta / (2 / math.pi / math.sqrt(m) * ellipe(m)))
