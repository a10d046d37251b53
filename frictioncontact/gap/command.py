"""Separation for a normal load, and normal load for a separation: users know the load, the FMU takes d."""

import argparse
import math
from collections.abc import Sequence
from dataclasses import fields

from rich.table import Table

from frictioncontact.command import add_set, as_table, command_line, table_console
from frictioncontact.errors import UserError
from frictioncontact.fmu import opened
from frictioncontact.gap.heights import MODELS, area, load, separation, stiffness
from frictioncontact.parameters import E_FULL, Surfaces

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
        "--heights", choices=MODELS, default="exponential", help="height density and asperities"
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
