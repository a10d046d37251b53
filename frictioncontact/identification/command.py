"""Fits named parameters of the FMU to a CSV of measured friction: steady means, or a series in time."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from frictioncontact import command as shared
from frictioncontact import resources
from frictioncontact.fmu import opened
from frictioncontact.identification.api import DEFAULT, identify
from frictioncontact.identification.experiment import INSTRUMENT
from frictioncontact.identification.show import show
from frictioncontact.values import assignments

DESCRIPTION = """\
Fits any parameters of the FMU to measured friction by least squares. Says first, in words, whether the law
fits at all; then the values with 95 % intervals, linear and by profile likelihood, their correlations, and
what the data can't tell. Draws identify.png."""

EPILOG = """\
The CSV has one row per steady state, and every model value is the FMU's own F_t_settled, the mean over the
periodic state. Each column is a variable of the FMU, with its unit in brackets or else in SI units. Commas,
semicolons or tabs, decimal commas, a preamble and remarks (#) are understood:

  V [mm/s],vibration.V_1 [m/s],load [N],F_t_mean [N],F_t_mean.uncertainty [N]
  20,0.5,100,31.2,0.8

F_t_mean and V are needed. NAME.uncertainty, the standard uncertainty of a column, is optional. A column load
drives the FMU's load: contact.input = Load and friction.limit = Load follow from it unless --set says
otherwise. What is no column keeps the FMU's start value, or that of --set.

A column time makes it a series instead, for example a loop of presliding and sliding, with F_t and either
position or V; load, d and E may vary along it. What simulate writes with --outputs V F_t is such a file.
Logs are read as they are: a warning tells what a heading is taken as, and what is left out.

If the law does not fit, faults of the instrument, other amplitudes of the vibration and other laws are tried,
and those with which it fits are named; if it fits, those with which it fits as well.

Without a file it fits the informative rows of the paper's Table 2: two parameters, three
rows. That is an identification, not a validation.

examples:
  %(prog)s
  %(prog)s mine.csv --fit contact.stiffnessScale --fit F_C=55 --set vibration.f=22e3
  %(prog)s mine.csv --fit contact.sigma=1e5..1e8 --set contact.model=Constant
  %(prog)s rig.csv --column "position=x [um]" --column F_t=force --nuisance offset --nuisance delay
  %(prog)s mine.csv --uncertain F_t_mean=0.5 --uncertain vibration.V_1=10%%"""

EXAMPLE = resources.data() / "table2.csv"


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = shared.command_line("frictioncontact identify", DESCRIPTION, EPILOG)
    parser.add_argument("csv", type=Path, nargs="?", default=EXAMPLE, help="measurements (data/table2.csv)")
    parser.add_argument(
        "--fit", action="append", metavar="NAME[=START|=LOW..HIGH]",
        help="parameter to fit, with a start value or a range that it stays in, in SI units; again for each "
        "(contact.stiffnessScale and vibration.phase_d)",
    )  # fmt: skip
    shared.add_set(parser, "of all rows")
    parser.add_argument(
        "--uncertain", action="append", default=[], metavar="NAME=VALUE|PERCENT%",
        help="standard uncertainty, in SI units or per cent: of the measured force, of a column (each row "
        "its own error), or of another variable (one error in all rows); again for each",
    )  # fmt: skip
    parser.add_argument(
        "--nuisance", action="append", default=[], metavar="NAME",
        help=f"fault of the instrument to fit beside the parameters: {', '.join(INSTRUMENT)}; again for each",
    )  # fmt: skip
    shared.add_column(parser)
    parser.add_argument("--quick", action="store_true", help="no picture")
    shared.add_fmu(parser)
    shared.add_output(parser, resources.output())
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    with shared.progress_bar() as bar:
        found = identify(
            options.csv,
            options.fit or DEFAULT,
            start=opened(options.fmu).known.assigned(options.set),
            uncertain=assignments(options.uncertain, "--uncertain"),
            nuisance=options.nuisance,
            columns=assignments(options.column, "--column"),
            fmu=options.fmu,
            tell=shared.teller(bar),
        )
    show(shared.table_console(), found.experiment, found.fit)
    if not options.quick and shared.can_draw():
        from frictioncontact import style
        from frictioncontact.identification import figures  # takes a second, which --quick saves

        path = options.output / "identify.png"
        style.save(figures.picture(found.experiment, found.fit), path, path.with_suffix(".svg"))
        print(f"Written: {path} and .svg")
