"""Headings of tables: "NAME [UNIT]", with the factor of the unit to SI, or "NAME" in SI units."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from frictioncontact.errors import UserError, did_you_mean
from frictioncontact.fmu import FrictionFmu

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
    index: int
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


def units(fmu: FrictionFmu, name: str) -> dict[str, float]:
    """The units that a variable may be given in, each with its factor to SI."""
    variable = fmu.variables[name]
    factors = fmu.known.factors.items()
    known = {display: 1.0 / factor for (unit, display), factor in factors if unit == variable.unit}
    return {variable.unit: 1.0} | known | (FORCES if variable.unit == "N" else {})


def columns_of(fmu: FrictionFmu, path: Path, line: int, header: Sequence[str]) -> list[Column]:
    return [_column(fmu, path, line, index, cell) for index, cell in enumerate(header)]


def _column(fmu: FrictionFmu, path: Path, line: int, index: int, cell: str) -> Column:
    where = f"{path}, line {line}, column {index + 1}"
    match = HEADING.fullmatch(cell)
    if not match:
        raise UserError(f"{where}: heading {cell!r} is not of the form 'name [unit]' or 'name'")
    name, unit = match.groups()
    plain = name.removesuffix(".uncertainty")
    if plain in OWN:
        known = OWN[plain]
    elif plain in accepted(fmu):
        known = units(fmu, plain)
    else:
        others = [*OWN, *accepted(fmu)]
        raise UserError(
            f"{where}: there is no variable {name!r}{did_you_mean(plain, others) or ';'} columns may be "
            f"{', '.join(others)}, and NAME.uncertainty of each"
        )
    if unit is not None and unit not in known:
        raise UserError(f"{where}: {name} is in {' or '.join(known)}, not in {unit!r}")
    return Column(index, cell.strip(), name, known[unit] if unit is not None else 1.0)
