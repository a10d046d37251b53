"""Separation for a normal load, and normal load for a separation: users know the load, the FMU takes d."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import fields

from rich.markup import escape
from rich.table import Table

from frictioncontact.command import command_line, finish, table_console
from frictioncontact.errors import UserError
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
  %(prog)s --load 40 120 240 --R_q 4e-6 --heights gaussian

At Table 1's surfaces the stiffness of Eq. 3 changes by a factor of 3 per micrometre: a load known to 5 %%
fixes d to 0.1 um, and sigma to 13 %%. Where that matters, fit contact.stiffnessScale with identify."""

HEIGHTS = {
    "exponential": "c exp(-lambda s), elastic-plastic: the paper's and the FMU's",
    "gaussian": "normal density, elastic-plastic (Chang-Etsion-Bogy)",
    "elastic": "normal density, elastic (Greenwood-Williamson)",
}
HELP = {
    "R_q": "standard deviation of the asperity heights [m]",
    "R": "mean radius of the summits [m]",
    "eta": "asperities per area [1/m2]",
    "A_n": "nominal area [m2]",
    "nu": "Poisson's ratio of the softer body",
    "Y": "yield strength of the softer body [Pa]",
    "c": "factor of the exponential density",
    "lambda_": "decay of the exponential density",
}


def positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive number")
    return value


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("frictioncontact gap", DESCRIPTION, EPILOG)
    asked = parser.add_mutually_exclusive_group()
    asked.add_argument("--load", type=positive, nargs="+", metavar="N", help="normal loads [N]")
    asked.add_argument("--separation", type=positive, nargs="+", metavar="M", help="separations d [m]")
    parser.add_argument("--E", type=positive, default=E_FULL, help="combined Young's modulus [Pa], Eq. 4")
    parser.add_argument(
        "--heights", choices=MODELS, default="exponential", help="height density and asperities"
    )
    parser.add_argument(
        "--quick", action="store_true", help="accepted like by all commands; nothing here is slow"
    )
    for field in fields(Surfaces):
        name = field.name.rstrip("_")
        parser.add_argument(
            f"--{name}",
            dest=field.name,
            type=positive,
            default=field.default,
            metavar="X",
            help=f"{HELP[field.name]}; Table 1: {field.default:g}",
        )
    return parser.parse_args(argv)


def main(argv: Sequence[str] | None = None) -> None:
    finish(run, arguments(argv))


def run(options: argparse.Namespace) -> None:
    if options.nu > 0.5:
        raise UserError(f"nu = {options.nu:g} must be at most 0.5")
    surfaces = Surfaces(**{field.name: getattr(options, field.name) for field in fields(Surfaces)})
    try:
        if options.load:
            gaps = [separation(surfaces, wanted, options.E, options.heights) for wanted in options.load]
        else:
            gaps = options.separation or [k * surfaces.R_q / 3.0 for k in range(3, 13)]
        table = as_text(surfaces, gaps, options.E, options.heights)
    except OverflowError as error:
        raise UserError(str(error)) from None
    print(f"heights: {HEIGHTS[options.heights]}")
    table_console().print(table)
    full = [d for d in gaps if area(surfaces, d, options.E, options.heights) > surfaces.A_n]
    if full:
        print(
            f"warning: up to d = {1e6 * max(full):.4f} um the real area A_r is larger than the nominal one, "
            "A_n: the asperities, which are summed one by one, would overlap"
        )
    if options.load and len(options.load) == 1:
        print(f"start values: d {gaps[0]:.9g}  E {options.E:.9g}")


def as_text(surfaces: Surfaces, gaps: Sequence[float], E: float, model: str) -> Table:
    """One line per separation."""
    text = Table()
    for heading in ("d [um]", "d / R_q", "load [N]", "A_r [mm2]", "A_r / A_n", "sigma [N/m]"):
        text.add_column(escape(heading), justify="right")
    for d in gaps:
        A_r = area(surfaces, d, E, model)
        text.add_row(
            f"{1e6 * d:.4f}",
            f"{d / surfaces.R_q:.3f}",
            f"{load(surfaces, d, E, model):.4g}",
            f"{1e6 * A_r:.4g}",
            f"{A_r / surfaces.A_n:.3g}",
            f"{stiffness(surfaces, d, E, model):.4g}",
        )
    return text


if __name__ == "__main__":
    main()
