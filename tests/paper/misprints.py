"""Eq. 20-22 with and without each misprint, and what shows that Eq. 25 and the yield pressure are off."""

from __future__ import annotations

import math

from scipy.optimize import minimize_scalar

from frictioncontact.parameters import E_FULL, SEPARATION, Surfaces


def residual_eq_25(F_C: float, sigma: float, V_2: float, V_1: float, f: float, t: float) -> float:
    """By how much Eq. 25 fails Eq. 2 for constant sigma: (dF/dt - sigma (V - |V| F / F_C)) / (sigma V_1).

    With G = sigma |V| t / F_C, dF/dt = s F_C e^-G dG/dt, and Eq. 2 asks for s F_C e^-G sigma |V| / F_C.
    What is left is e^-G t (dV/dt) / V_1.
    """
    omega = 2.0 * math.pi * f
    V = V_2 + V_1 * math.cos(omega * t)
    return math.exp(-sigma * abs(V) * t / F_C) * t * -omega * math.sin(omega * t)


def area_eq_20(swapped: bool, positive_exponent: bool, lengths_over_R_q: bool = True) -> float:
    """A_r [m2] of Eq. 20-22 at 14 um with each of its misprints on or off; all off is the FMU's."""
    surfaces, d, E = Surfaces(), SEPARATION, E_FULL
    c, decay = (surfaces.lambda_, surfaces.c) if swapped else (surfaces.c, surfaces.lambda_)
    omega_c = surfaces.critical_interference(E)
    scale = surfaces.R_q if lengths_over_R_q else 1e-6  # lengths in um, as in the nomenclature
    x = decay * omega_c / scale
    front = c * math.pi * surfaces.beta * surfaces.A_n / decay**2
    sign = 1.0 if positive_exponent else -1.0
    elastic = (1.0 - (1.0 + x) * math.exp(sign * x)) * math.exp(-decay * d / scale)
    plastic = (2.0 + x) * math.exp(-decay * (d + omega_c) / scale)
    return front * (elastic + plastic)


def yield_pressure_ratio(nu: float) -> float:
    """Peak contact pressure over Y at which a Hertzian contact begins to yield below its centre (von Mises).

    On the axis, at depth u contact radii: sigma_z = -p / (1 + u^2),
    sigma_r = -p [(1 + nu)(1 - u atan(1/u)) - 1 / (2 (1 + u^2))].
    """

    def difference(u: float) -> float:
        axial = -1.0 / (1.0 + u * u)
        radial = -(1.0 + nu) * (1.0 - u * math.atan(1.0 / u)) + 0.5 / (1.0 + u * u)
        return -abs(axial - radial)

    best = minimize_scalar(difference, bounds=(0.05, 3.0), method="bounded", options={"xatol": 1e-12})
    return -1.0 / best.fun
