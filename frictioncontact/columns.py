"""Tables with headings: "NAME [UNIT]", with the factor of the unit to SI, or "NAME" in SI units."""

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

from fmpy.model_description import ScalarVariable

from frictioncontact.errors import UserError, did_you_mean
from frictioncontact.fmu import FrictionFmu
from frictioncontact.values import LARGEST, Variables, number

HEADING = re.compile(r"\s*([^\[\]]+?)\s*(?:\[\s*([^\[\]]*?)\s*\]\s*)?")
FORCES = {"N": 1.0, "mN": 1e-3, "kN": 1e3}
MEASURED = ("F_t", "F_t_mean")
OWN = {  # columns that are no inputs or parameters of the FMU
    "F_t_mean": FORCES,
    "F_t": FORCES,
    "time": {"s": 1.0, "ms": 1e-3},
    "position": {"m": 1.0, "mm": 1e-3, "um": 1e-6},
}


@dataclass(frozen=True)
class Column:
    heading: str
    name: str
    factor: float  # from the column's unit to SI


def accepted(fmu: FrictionFmu) -> list[str]:
    """Variables that a column may hold, or a fit vary."""
    return [
        name
        for name, variable in fmu.variables.items()
        if variable.type == "Real"
        and variable.causality in ("input", "parameter")
        and not name.startswith("solver.")
        and name not in ("delta_0", "delta_y_0")
    ]


def units(variable: ScalarVariable, known: Variables) -> dict[str, float]:
    """The units that a variable may be given in, each with its factor to SI."""
    factors = known.factors.items()
    displayed = {display: 1.0 / factor for (unit, display), factor in factors if unit == variable.unit}
    return {variable.unit or "1": 1.0} | displayed | (FORCES if variable.unit == "N" else {})


def heading(cell: str, where: str) -> tuple[str, str | None]:
    """Name and unit of a column; UserError if it is of another form."""
    match = HEADING.fullmatch(cell)
    if not match:
        raise UserError(f"{where}: heading {cell!r} is not of the form 'name [unit]' or 'name'")
    name, unit = match.groups()
    return name, unit


def factor(name: str, unit: str | None, known: Mapping[str, float], where: str) -> float:
    """From a column's unit to SI; UserError if it is none of the known."""
    if unit is not None and unit not in known:
        raise UserError(f"{where}: {name} is in {' or '.join(known)}, not in {unit!r}")
    return 1.0 if unit is None else known[unit]


def columns_of(fmu: FrictionFmu, path: Path, lines: Sequence[tuple[int, list[str]]]) -> list[Column]:
    """Those of the header, the first of the lines (their numbers and cells); UserError where one is wrong."""
    if not lines:
        raise UserError(f"{path}: no header row")
    line, header = lines[0]
    columns = [_column(fmu, f"{path}, line {line}, column {k}", cell) for k, cell in enumerate(header, 1)]
    names = [column.name for column in columns]
    for name in names:
        if names.count(name) > 1:
            raise UserError(f"{path}: column {name} is there twice")
    return columns


def numbers_below(
    path: Path,
    columns: Sequence[Column],
    lines: Sequence[tuple[int, list[str]]],
    positive: Collection[str] = (),
) -> dict[str, list[float]]:
    """The rows after the header, by name, in SI units.

    positive: the columns whose values must be. UserError names the row, from 1, its line and the column.
    """
    found: dict[str, list[float]] = {column.name: [] for column in columns}
    for row, (line, cells) in enumerate(lines, 1):
        at = f"{path}, row {row} (line {line})"
        if len(cells) > len(columns):
            raise UserError(f"{at}: {len(cells)} cells, but {len(columns)} columns; decimals have a point")
        for column, cell in zip_longest(columns, cells, fillvalue=""):
            where = f"{at}, column '{column.heading}'"
            if not cell:
                raise UserError(f"{where}: no value")
            value = number(cell, where)
            if abs(value) > LARGEST:
                raise UserError(f"{where}: {cell} must be from {-LARGEST:g} to {LARGEST:g}")
            if column.name in positive and value <= 0.0:
                raise UserError(f"{where}: {cell} must be positive")
            found[column.name].append(value * column.factor)
    return found


def _column(fmu: FrictionFmu, where: str, cell: str) -> Column:
    name, unit = heading(cell, where)
    plain = name.removesuffix(".uncertainty")
    if plain in OWN:
        known = OWN[plain]
    elif plain in accepted(fmu):
        known = units(fmu.variables[plain], fmu.known)
    else:
        others = [*OWN, *accepted(fmu)]
        raise UserError(
            f"{where}: there is no variable {name!r}{did_you_mean(plain, others) or ';'} columns may be "
            f"{', '.join(others)}, and NAME.uncertainty of each"
        )
    return Column(cell.strip(), name, factor(name, unit, known, where))
