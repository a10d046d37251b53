"""What the paper prints and the FMU does not compute: Eq. 23 and 25, which its figures show."""

import math

import numpy as np


def force_eq_23(
    F_C: float, sigma: np.ndarray | float, V: np.ndarray | float, t: np.ndarray | float
) -> np.ndarray:
    """F_t [N] of Eq. 23: Eq. 2 solved from rest for constant V and sigma; with V(t) put in, Eq. 25."""
    return F_C * np.sign(V) * -np.expm1(-np.asarray(sigma) * np.abs(V) * t / F_C)


def force_eq_25(
    F_C: float, sigma: np.ndarray | float, V_2: float, V_1: float, f: float, t: np.ndarray
) -> np.ndarray:
    """F_t [N] of Eq. 25: Eq. 23 with V = V_2 + V_1 cos(2 pi f t) put in afterwards."""
    return force_eq_23(F_C, sigma, V_2 + V_1 * np.cos(2.0 * math.pi * f * t), t)
