"""Separation for a normal load, and normal load for a separation, from the heights of the asperities.

Three contacts over the same two surfaces, by the same integrals (paper, Eq. 6-19):

    exponential   density c exp(-lambda s), elastic-plastic asperities: the paper's, in closed form the FMU's
    gaussian      normal density, elastic-plastic asperities (Chang, Etsion, Bogy 1987)
    elastic       normal density, elastic asperities only (Greenwood, Williamson 1966)

s = z / R_q is the height, h = d / R_q the separation, w = omega_c / R_q the critical interference.
"""

import argparse
import math
from collections.abc import Callable, Sequence
from dataclasses import fields

from rich.table import Table
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import gamma, gammainc

from frictioncontact.command import add_set, as_table, command_line, table_console
from frictioncontact.errors import UserError
from frictioncontact.fmu import opened
from frictioncontact.parameters import E_FULL, Surfaces

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


DESCRIPTION = """\
Prints the separation d at which two rough surfaces carry a normal load, or the load that they carry at a
separation: Eq. 9 and 16 of the paper summed over the asperity heights. Without --load and --separation it
prints a table. All values in SI units, as in the FMU."""

EPILOG = """\
examples:
  %(prog)s --load 100                   d for 100 N, with Table 1's surfaces
  %(prog)s --separation 14e-6           load at 14 um
  %(prog)s --load 40 120 240 --set contact.R_q=4e-6 --heights gaussian

At Table 1's surfaces the stiffness of Eq. 3 changes by a factor of 3 per micrometre: a load known to 5 %%
fixes d to 0.1 um, and sigma to 13 %%. Where that matters, fit contact.stiffnessScale with identify."""

HEIGHTS = {
    "exponential": "c exp(-lambda s), elastic-plastic: the paper's and the FMU's",
    "gaussian": "normal density, elastic-plastic (Chang-Etsion-Bogy)",
    "elastic": "normal density, elastic (Greenwood-Williamson)",
}
# Variables of the FMU that describe the surfaces, and their names in `Surfaces`.
SURFACES = {f"contact.{field.name.rstrip('_')}": field.name for field in fields(Surfaces)}


def positive(where: str, value: float) -> None:
    if not 0.0 < value < math.inf:
        raise UserError(f"{where} {value:g}: must be a positive number")


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("frictioncontact gap", DESCRIPTION, EPILOG)
    asked = parser.add_mutually_exclusive_group()
    asked.add_argument("--load", type=float, nargs="+", metavar="N", help="normal loads [N]")
    asked.add_argument("--separation", type=float, nargs="+", metavar="M", help="separations d [m]")
    add_set(parser, f"of E, {', '.join(SURFACES)}")
    parser.add_argument(
        "--heights", choices=HEIGHTS, default="exponential", help="height density and asperities"
    )
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    given = opened(None).known.assigned(options.set)
    E = float(given.pop("E", E_FULL))
    for name, value in {"E": E, **given}.items():
        if name not in ("E", *SURFACES):
            raise UserError(f"--set {name}: must be one of E, {', '.join(SURFACES)}")
        if name != "contact.nu":
            positive(f"--set {name}", float(value))
    for option in ("load", "separation"):
        for value in getattr(options, option) or []:
            positive(f"--{option}", value)
    surfaces = Surfaces(**{SURFACES[name]: float(value) for name, value in given.items()})
    if not 0.0 <= surfaces.nu <= 0.5:
        raise UserError(f"--set contact.nu={surfaces.nu:g}: must be from 0 to 0.5")
    try:
        if options.load:
            gaps = [separation(surfaces, wanted, E, options.heights) for wanted in options.load]
        else:
            gaps = options.separation or [k * surfaces.R_q / 3.0 for k in range(3, 13)]
        table = as_text(surfaces, gaps, E, options.heights)
    except OverflowError as error:
        raise UserError(str(error)) from None
    print(f"heights: {HEIGHTS[options.heights]}")
    table_console().print(table)
    full = [d for d in gaps if area(surfaces, d, E, options.heights) > surfaces.A_n]
    if full:
        print(
            f"warning: up to d = {1e6 * max(full):.4f} um the real area A_r is larger than the nominal one, "
            "A_n: the asperities, which are summed one by one, would overlap"
        )
    if options.load and len(options.load) == 1:
        start = {"d": gaps[0], "E": E, **given}
        values = "  ".join(f"{name} {value:.9g}" for name, value in start.items())
        others = "no start values: the FMU's heights are exponential"
        print(f"start values: {values}" if options.heights == "exponential" else others)


def as_text(surfaces: Surfaces, gaps: Sequence[float], E: float, model: str) -> Table:
    """One line per separation."""
    headings = ("d [um]", "d / R_q", "load [N]", "A_r [mm2]", "A_r / A_n", "sigma [N/m]")
    rows = []
    for d in gaps:
        A_r = area(surfaces, d, E, model)
        rows.append(
            [
                f"{1e6 * d:.4f}",
                f"{d / surfaces.R_q:.3f}",
                f"{load(surfaces, d, E, model):.4g}",
                f"{1e6 * A_r:.4g}",
                f"{A_r / surfaces.A_n:.3g}",
                f"{stiffness(surfaces, d, E, model):.4g}",
            ]
        )
    return as_table(headings, rows, names=0)
