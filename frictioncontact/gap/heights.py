"""Height statistics of the asperities: contact area, stiffness and normal load against the separation.

Three contacts over the same two surfaces, by the same integrals (paper, Eq. 6-19):

    exponential   density c exp(-lambda s), elastic-plastic asperities: the paper's, in closed form the FMU's
    gaussian      normal density, elastic-plastic asperities (Chang, Etsion, Bogy 1987)
    elastic       normal density, elastic asperities only (Greenwood, Williamson 1966)

s = z / R_q is the height, h = d / R_q the separation, w = omega_c / R_q the critical interference.
"""

import math
from collections.abc import Callable

from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import gamma, gammainc

from frictioncontact.errors import UserError
from frictioncontact.parameters import E_FULL, Surfaces

MODELS = ("exponential", "gaussian", "elastic")
TAIL = 14.0  # from a height on: beyond, the normal density is below 1e-17 of the integrals from there
SMALLEST_SEPARATION = 1e-3  # in units of R_q: below, mean planes touch and no asperity theory holds


def gaussian(s: float) -> float:
    return math.exp(-0.5 * s * s) / math.sqrt(2.0 * math.pi)


def height_integral(h: float, n: float, width: float = TAIL) -> float:
    """F_n(h): the integral of (s - h)^n gaussian(s) over a width of heights s from h on."""
    return _integral(lambda s: (s - h) ** n * gaussian(s), h, h + min(width, TAIL))


def _integral(function: Callable[[float], float], left: float, right: float) -> float:
    """Adaptive quadrature, in pieces that grow away from the left end: the density falls off from there."""
    corners, width = [left], 0.5
    while corners[-1] + 1.5 * width < right:
        corners.append(corners[-1] + width)
        width *= 1.6
    corners.append(right)
    pieces = (
        quad(function, a, b, epsabs=0.0, epsrel=1e-12, limit=200)[0]
        for a, b in zip(corners[:-1], corners[1:], strict=True)
    )
    return math.fsum(pieces)


def _parts(surfaces: Surfaces, d: float, E: float, model: str, power: float) -> tuple[float, float]:
    """Over the heights: (s - h)^power of what is elastic, and 2 (s - h) - w of what has yielded."""
    h, w = d / surfaces.R_q, surfaces.critical_interference(E) / surfaces.R_q
    if model == "elastic":
        return height_integral(h, power), 0.0
    if model == "gaussian":
        plastic = _integral(lambda s: (2.0 * (s - h) - w) * gaussian(s), h + w, h + w + TAIL)
        return height_integral(h, power, w), plastic
    decay, n = surfaces.lambda_, power + 1.0
    x, front = decay * w, surfaces.c * math.exp(-decay * h)
    return front * gamma(n) * gammainc(n, x) / decay**n, front * (2.0 + x) * math.exp(-x) / decay**2


def area(surfaces: Surfaces, d: float, E: float = E_FULL, model: str = "exponential") -> float:
    """A_r [m2], Eq. 18, 19, 22; model "elastic" takes Eq. 8 for every asperity."""
    return math.pi * surfaces.beta * surfaces.A_n * sum(_parts(surfaces, d, E, model, 1.0))


def stiffness(surfaces: Surfaces, d: float, E: float = E_FULL, model: str = "exponential") -> float:
    """sigma [N/m], Eq. 3."""
    return E * area(surfaces, d, E, model) ** 2 / d**3


def load(surfaces: Surfaces, d: float, E: float = E_FULL, model: str = "exponential") -> float:
    """Normal load [N]: Eq. 9 below omega_c and Eq. 16 above it, summed over the asperities."""
    R_q, count = surfaces.R_q, surfaces.eta * surfaces.A_n
    hertz = 4.0 / 3.0 * E * math.sqrt(surfaces.R) * R_q**1.5
    flow = math.pi * surfaces.R * R_q * surfaces.yield_pressure
    elastic, plastic = _parts(surfaces, d, E, model, 1.5)
    return count * (hertz * elastic + flow * plastic)


def separation(surfaces: Surfaces, wanted: float, E: float = E_FULL, model: str = "exponential") -> float:
    """d [m] at which the surfaces carry the wanted load [N]."""
    most_R_q = 36.0 / surfaces.lambda_ if model == "exponential" else 12.0
    nearest, farthest = SMALLEST_SEPARATION * surfaces.R_q, most_R_q * surfaces.R_q
    most, least = load(surfaces, nearest, E, model), load(surfaces, farthest, E, model)
    if not least <= wanted <= most:
        raise UserError(
            f"load = {wanted:g} N is out of reach: these surfaces carry {least:.3g} N "
            f"at d = {most_R_q:g} R_q and {most:.5g} N at d = {SMALLEST_SEPARATION:g} R_q"
        )
    return brentq(
        lambda d: math.log(load(surfaces, d, E, model) / wanted), nearest, farthest, xtol=1e-18, rtol=1e-12
    )
