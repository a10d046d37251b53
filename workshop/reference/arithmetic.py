"""The numbers the reference computes with: mpmath at 40 digits, or the machine's extended precision.

The quadrature of ``quadrature`` is written once for arrays of either kind. Extended precision (19
digits on x86-64) serves sweeps of many scenes; it is itself graded against the 40 digits.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import mpmath
import numpy as np
from numpy.polynomial.legendre import leggauss

DIGITS = 40
MP = mpmath.mp.clone()
MP.dps = DIGITS


@dataclass(frozen=True)
class Arithmetic:
    name: str
    real: Callable[[Any], Any]  # an mpf, float or int as a number of this kind
    exp: Callable[[Any], Any]  # elementwise, on arrays
    expm1: Callable[[Any], Any]
    cos: Callable[[Any], Any]
    log: Callable[[Any], Any]
    dtype: Any
    nodes: int  # Gauss nodes in one piece of the mesh
    window_nodes: int  # Gauss nodes in one window of the integrating factor
    window: float  # exponent beyond which the integrating factor has forgotten its past

    def array(self, values: Any) -> np.ndarray:
        return np.array([self.real(value) for value in values], dtype=self.dtype)

    def matrix(self, rows: Any) -> np.ndarray:
        return np.array([[self.real(value) for value in row] for row in rows], dtype=self.dtype)


def _longdouble(value: Any) -> np.longdouble:
    if not isinstance(value, MP.mpf):
        return np.longdouble(value)
    high = float(value)
    return (
        np.longdouble(high) + np.longdouble(float(value - high)) if np.isfinite(high) else np.longdouble(high)
    )


def multiprecision(value: Any) -> Any:
    """An mpf of the same value, to 21 digits where it comes from extended precision."""
    if isinstance(value, np.longdouble):
        return MP.mpf(np.format_float_scientific(value, unique=True))
    return MP.mpf(value)


MULTIPRECISION = Arithmetic(
    "multiprecision",
    MP.mpf,
    np.frompyfunc(MP.exp, 1, 1),
    np.frompyfunc(MP.expm1, 1, 1),
    np.frompyfunc(MP.cos, 1, 1),
    np.frompyfunc(MP.log, 1, 1),
    object,
    nodes=16,
    window_nodes=32,
    window=56.0,
)
EXTENDED = Arithmetic(
    "extended",
    _longdouble,
    np.exp,
    np.expm1,
    np.cos,
    np.log,
    np.longdouble,
    nodes=16,
    window_nodes=36,
    window=46.0,
)


@dataclass(frozen=True)
class GaussRule:
    """Gauss-Legendre on [0, 1]."""

    nodes: Any  # in (0, 1)
    weights: Any  # sum 1
    from_start: Any  # from_start[i][j]: integral of the j-th Lagrange polynomial over [0, nodes[i]]
    to_end: Any  # the same over [nodes[i], 1]


@cache
def gauss_rule(n: int) -> GaussRule:
    points = [MP.findroot(lambda x: MP.legendre(n, x), (near, near + 1e-13)) for near in leggauss(n)[0]]
    P = [[MP.legendre(m, x) for m in range(n + 2)] for x in points]
    slopes = [n * (x * row[n] - row[n - 1]) / (x * x - 1) for x, row in zip(points, P, strict=True)]
    weights = [2 / ((1 - x * x) * slope * slope) for x, slope in zip(points, slopes, strict=True)]
    from_start, to_end = [], []
    for i in range(n):
        # integral of P_m over [x, 1] is (P_(m-1)(x) - P_(m+1)(x)) / (2 m + 1)
        rest = [1 - points[i]] + [(P[i][m - 1] - P[i][m + 1]) / (2 * m + 1) for m in range(1, n)]
        row = [weights[j] * sum((2 * m + 1) * P[j][m] * rest[m] for m in range(n)) / 4 for j in range(n)]
        to_end.append(row)
        from_start.append([weights[j] / 2 - row[j] for j in range(n)])
    return GaussRule([(1 + x) / 2 for x in points], [w / 2 for w in weights], from_start, to_end)


@cache
def gauss_arrays(n: int, arithmetic: Arithmetic) -> GaussRule:
    """The same in arrays of one arithmetic."""
    rule = gauss_rule(n)
    return GaussRule(
        arithmetic.array(rule.nodes),
        arithmetic.array(rule.weights),
        arithmetic.matrix(rule.from_start),
        arithmetic.matrix(rule.to_end),
    )
