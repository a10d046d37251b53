"""Fits named parameters of the FMU to a CSV of measured friction: steady means, or a series in time."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from frictionlab.build import build_fmu
from frictionlab.command import add_fmu, add_output, command_line, finish
from frictionlab.fmu import FrictionFmu
from frictionlab.identify.bootstrap import bootstrap
from frictionlab.identify.data import FORCE, MEASURED, Measurements, Series, Stated, read
from frictionlab.identify.experiment import Experiment, Rows
from frictionlab.identify.fit import fit
from frictionlab.identify.parameter import Parameter, accepted, parameter
from frictionlab.identify.series import Record
from frictionlab.identify.show import show
from frictionlab.project import ROOT, UserError
from frictionlab.values import Variables, assignment, number

DESCRIPTION = """\
Fits any parameters of the FMU to measured friction by least squares. Says first, in words, whether the law
fits at all; then the values with 95 % intervals, linear and by profile likelihood, their correlations, and
what the data can't tell. Draws build/identify.png."""

EPILOG = """\
The CSV has one row per steady state, and every model value is the FMU's own F_t_mean over one vibration
period of the periodic state. Each column is a variable of the FMU with a unit that it may have, in brackets;
lines that begin with # are skipped:

  V [mm/s],vibration.V_1 [m/s],load [N],F_t_mean [N],F_t_mean.uncertainty [N]
  20,0.5,100,31.2,0.8

F_t_mean and V are needed. NAME.uncertainty, the standard uncertainty of a column, is optional. A column load
drives the FMU's load: contact.input = Load and friction.limit = Load follow from it unless --set says
otherwise. What is no column keeps the FMU's start value, or that of --set.

A column time [s] makes it a series instead, for example a loop of presliding and sliding, with F_t [N] and
either position [m] or V [m/s]; load, d and E may vary along it.

Without a file it fits data/table2.csv, the informative rows of the paper's Table 2: two parameters, three
rows. That is an identification, not a validation.

examples:
  scripts/identify
  scripts/identify mine.csv --fit contact.stiffnessScale --fit F_C=55 --set vibration.f=22e3
  scripts/identify mine.csv --fit contact.sigma=1e5..1e8 --set contact.model=Constant
  scripts/identify mine.csv --uncertain F_t_mean=0.5 --uncertain vibration.V_1=10% --bootstrap 1000"""

EXAMPLE = ROOT / "data" / "table2.csv"


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("identify", DESCRIPTION, EPILOG)
    parser.add_argument("csv", type=Path, nargs="?", default=EXAMPLE, help="measurements (data/table2.csv)")
    parser.add_argument(
        "--fit",
        action="append",
        metavar="NAME[=START|=LOW..HIGH]",
        help="parameter to fit, with a start value or a range to search, in SI units; again for each "
        "(contact.stiffnessScale and vibration.phase_d)",
    )
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="start value for all rows, in SI units",
    )
    parser.add_argument(
        "--uncertain",
        action="append",
        default=[],
        metavar="NAME=VALUE|PERCENT%%",
        help="standard uncertainty, in SI units or per cent: of the measured force, of a column (each row "
        "its own error), or of another variable (one error in all rows); again for each",
    )
    parser.add_argument(
        "--bootstrap", type=int, metavar="N", help="intervals by N refits of data with new noise, too"
    )
    parser.add_argument("--quick", action="store_true", help="no picture")
    add_fmu(parser)
    add_output(parser, ROOT / "build")
    return parser.parse_args(argv)


def main(argv: Sequence[str] | None = None) -> None:
    finish(run, arguments(argv))


def run(options: argparse.Namespace) -> None:
    with FrictionFmu(options.fmu or build_fmu()) as fmu:
        identify(fmu, options)


def identify(fmu: FrictionFmu, options: argparse.Namespace) -> None:
    if options.bootstrap is not None and options.bootstrap < 40:
        raise UserError(f"--bootstrap {options.bootstrap}: must be at least 40, to have a 2.5 % quantile")
    variables = Variables(fmu.description)
    constants = dict(variables.assigned(text, "--set") for text in options.set)
    rows = read(options.csv, fmu, constants, [_stated(fmu, text) for text in options.uncertain])
    named = options.fit or ["contact.stiffnessScale", "vibration.phase_d"]
    parameters = [_parameter(fmu, text, constants) for text in named]
    _check_names(parameters, rows, constants)
    experiment = experiment_of(fmu, rows, parameters)
    result = fit(experiment)
    spread = None if options.bootstrap is None else bootstrap(experiment, result, options.bootstrap)
    show(Console(), experiment, result, spread)
    if not options.quick:
        from frictionlab.identify import figures  # takes a second, which --quick saves

        options.output.mkdir(parents=True, exist_ok=True)
        path = options.output / "identify.png"
        figures.draw(experiment, result, path, path.with_suffix(".svg"))
        print(f"Written: {path} and .svg")


def experiment_of(
    fmu: FrictionFmu, rows: Measurements | Series, parameters: Sequence[Parameter]
) -> Experiment:
    return (Record if isinstance(rows, Series) else Rows)(fmu, rows, parameters)


def _stated(fmu: FrictionFmu, text: str) -> Stated:
    name, value = assignment(text, "--uncertain")
    if name not in (MEASURED, FORCE, *accepted(fmu)):
        raise UserError(f"--uncertain {text}: {name} is no variable that a file may hold")
    found = number(value.removesuffix("%"), f"--uncertain {name}")
    if found <= 0.0:
        raise UserError(f"--uncertain {text}: must be positive")
    relative = value.endswith("%")
    return Stated(name, found / 100.0 if relative else found, relative)


def _parameter(fmu: FrictionFmu, text: str, constants: dict[str, float | str]) -> Parameter:
    name, _, value = text.partition("=")
    where = f"--fit {text}"
    if ".." in value:
        low, high = (number(part, where) for part in value.split("..", 1))
        if not low < high:
            raise UserError(f"{where}: the range is empty")
        return parameter(fmu, name, None, (low, high), constants)
    return parameter(fmu, name, number(value, where) if value else None, None, constants)


def _check_names(
    parameters: Sequence[Parameter], rows: Measurements | Series, constants: dict[str, float | str]
) -> None:
    names = [p.name for p in parameters]
    uncertain = () if isinstance(rows, Series) else [one.name for one in rows.uncertain]
    for name in names:
        if names.count(name) > 1:
            raise UserError(f"--fit names {name} twice")
        if name in rows.names:
            raise UserError(f"{name} is a column of the measurements and can't be fitted too")
        if name in constants:
            raise UserError(f"{name} is given by --set and can't be fitted too")
        if name in uncertain:
            raise UserError(f"{name} is fitted, and so takes no --uncertain")


if __name__ == "__main__":
    main()
