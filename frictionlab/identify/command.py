"""Fits named parameters of the FMU to a CSV of measured mean friction forces."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from frictionlab.build import build_fmu
from frictionlab.command import add_fmu, add_output, command_line, finish
from frictionlab.fmu import FrictionFmu
from frictionlab.identify.data import Measurements, read
from frictionlab.identify.fit import Experiment, Fit, Parameter, fit, parameter
from frictionlab.parameters import E_FULL, SEPARATION
from frictionlab.project import ROOT, UserError
from frictionlab.values import Variables, number

DESCRIPTION = """\
Fits any parameters of the FMU to measured mean friction forces by least squares, every model value being the
FMU's own F_t_mean over one vibration period of the periodic state. Prints the values with 95 % intervals and
correlations, and says what the data can't tell. Draws build/identify.png."""

EPILOG = """\
The CSV has one row per steady state. Each column is a variable of the FMU with a unit that it may have, in
brackets; lines that begin with # are skipped:

  V [mm/s],vibration.V_1 [m/s],load [N],F_t_mean [N],F_t_mean.uncertainty [N]
  20,0.5,100,31.2,0.8

F_t_mean and V are needed. F_t_mean.uncertainty (standard uncertainty) is optional. load [N] may stand in for
d, which then is what scripts/gap gives. What is no column keeps the FMU's start value, or that of --set.

Without a file it fits data/table2.csv, the informative rows of the paper's Table 2: two parameters, three
rows. That is an identification, not a validation.

examples:
  scripts/identify
  scripts/identify mine.csv --fit contact.stiffnessScale --fit F_C=55 --set vibration.f=22e3
  scripts/identify mine.csv --fit contact.sigma=1e5..1e8 --set contact.model=Constant"""

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
    parser.add_argument("--quick", action="store_true", help="fewer starts of the search, no picture")
    add_fmu(parser)
    add_output(parser, ROOT / "build")
    return parser.parse_args(argv)


def main(argv: Sequence[str] | None = None) -> None:
    finish(run, arguments(argv))


def run(options: argparse.Namespace) -> None:
    with FrictionFmu(options.fmu or build_fmu()) as fmu:
        identify(fmu, options)


def identify(fmu: FrictionFmu, options: argparse.Namespace) -> None:
    variables = Variables(fmu.description)
    constants = dict(variables.assigned(text, "--set") for text in options.set)
    rows = read(options.csv, fmu, constants)
    named = options.fit or ["contact.stiffnessScale", "vibration.phase_d"]
    parameters = [_parameter(fmu, text, constants) for text in named]
    _check_names(parameters, rows, constants)
    with Experiment(fmu, rows, parameters) as experiment:
        result = fit(experiment, samples=64 if options.quick else 256, starts=4 if options.quick else 8)
        show(Console(), fmu, rows, result)
        if not options.quick:
            from frictionlab.identify import figures  # takes a second, which --quick saves

            options.output.mkdir(parents=True, exist_ok=True)
            path = options.output / "identify.png"
            figures.draw(experiment, result, path, path.with_suffix(".svg"))
            print(f"Written: {path} and .svg")


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
    parameters: Sequence[Parameter], rows: Measurements, constants: dict[str, float | str]
) -> None:
    names = [p.name for p in parameters]
    for name in names:
        if names.count(name) > 1:
            raise UserError(f"--fit names {name} twice")
        if name in rows.names:
            raise UserError(f"{name} is a column of the measurements and can't be fitted too")
        if name in constants:
            raise UserError(f"{name} is given by --set and can't be fitted too")


def show(console: Console, fmu: FrictionFmu, rows: Measurements, result: Fit) -> None:
    """Values and intervals, rows, correlations, warnings."""
    console.print(_values(result))
    console.print(_rows(rows, result))
    if len(result.parameters) > 1:
        console.print(_correlations(result))
    if math.isfinite(result.deviation):
        print(f"scatter of one row: {result.deviation:.3g} N ({result.degrees} degrees of freedom)")
    if any(p.name == "contact.stiffnessScale" for p in result.parameters):
        scale = result.values[[p.name for p in result.parameters].index("contact.stiffnessScale")]
        print(f"asperity stiffness at 14 um, scaled: {_stiffness(fmu, rows, scale):.5g} N/m")
    for warning in result.warnings:
        print(f"warning: {warning}")


def _stiffness(fmu: FrictionFmu, rows: Measurements, scale: float) -> float:
    """sigma [N/m] at the separation and modulus of Table 1, with what else the first row has."""
    plain = {"d": SEPARATION, "E": E_FULL, "vibration.a_d": 0.0, "contact.stiffnessScale": scale}
    with fmu.session({**rows.conditions[0], **plain}) as session:
        return session.get("sigma")


def _values(result: Fit) -> Table:
    table = Table(title="Fitted parameters", title_justify="left")
    for heading in ("parameter", "unit", "value", "95 % interval"):
        table.add_column(heading, justify="left" if heading == "parameter" else "right")
    for k, p in enumerate(result.parameters):
        value, (low, high) = result.values[k], result.interval(k)
        _add(table, p.name, p.unit, value, low, high)
        if p.unit == "rad":
            _add(table, "", "deg", *np.degrees([value, low, high]))
    return table


def _add(table: Table, name: str, unit: str, value: float, low: float, high: float) -> None:
    interval = "none" if math.isnan(low) else f"{low:.5g} .. {high:.5g}"
    table.add_row(name, unit, f"{value:.6g}", interval)


def _rows(rows: Measurements, result: Fit, most: int = 30) -> Table:
    table = Table(title="Mean friction force [N]", title_justify="left")
    for heading in ("row", "measured", "fitted", "difference", "kappa"):
        table.add_column(heading, justify="right")
    for k in range(min(len(rows), most)):
        table.add_row(
            str(k + 1),
            f"{rows.force[k]:.3f}",
            f"{result.model[k]:.3f}",
            f"{result.residuals[k]:+.3f}",
            f"{result.kappa[k]:.3g}",
        )
    if len(rows) > most:
        table.add_row("...", "", "", "", "")
    return table


def _correlations(result: Fit) -> Table:
    table = Table(title="Correlations", title_justify="left")
    table.add_column("")
    for p in result.parameters:
        table.add_column(p.name, justify="right")
    for p, row in zip(result.parameters, result.correlation, strict=True):
        table.add_row(p.name, *("none" if math.isnan(value) else f"{value:+.3f}" for value in row))
    return table


if __name__ == "__main__":
    main()
