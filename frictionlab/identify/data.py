"""Measurements for scripts/identify: one CSV row is one steady state, its mean friction and its conditions.

A column is named after a variable of the FMU with its unit in brackets, "V [mm/s]". F_t_mean is the measured
mean; F_t_mean.uncertainty its standard uncertainty, if known; load may stand in for the separation d.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from frictionlab.contact.heights import separation
from frictionlab.fmu import FrictionFmu
from frictionlab.parameters import E_FULL, Surfaces
from frictionlab.project import UserError
from frictionlab.values import csv_rows, number

MEASURED = "F_t_mean"
UNCERTAINTY = "F_t_mean.uncertainty"
LOAD = "load"
HEADING = re.compile(r"\s*([^\[\]]+?)\s*\[\s*([^\[\]]*?)\s*\]\s*")


@dataclass(frozen=True)
class Measurements:
    """conditions[k] are start values of the FMU for row k; all in SI units."""

    names: tuple[str, ...]  # the columns that are conditions
    conditions: list[dict[str, Any]]
    force: list[float]  # N
    uncertainty: list[float] | None  # N

    def __len__(self) -> int:
        return len(self.force)


@dataclass(frozen=True)
class _Column:
    index: int
    heading: str
    name: str
    factor: float  # from the column's unit to SI


def units(fmu: FrictionFmu, name: str) -> dict[str, float]:
    """The units that a variable may be given in, each with its factor to SI."""
    variable = fmu.variables[name]
    known = {variable.unit: 1.0}
    for unit in fmu.description.unitDefinitions:
        if unit.name == variable.unit:
            known |= {display.name: 1.0 / display.factor for display in unit.displayUnits}
    return known


def accepted(fmu: FrictionFmu) -> list[str]:
    """Variables that a column may hold."""
    return [
        name
        for name, variable in fmu.variables.items()
        if variable.type == "Real"
        and variable.causality in ("input", "parameter")
        and not name.startswith("solver.")
        and name != "delta_0"
    ]


def read(path: Path, fmu: FrictionFmu, constants: Mapping[str, Any]) -> Measurements:
    """The rows of a CSV file; constants are start values that all rows share and no column may repeat."""
    lines = list(csv_rows(path))
    if not lines:
        raise UserError(f"{path}: no header row")
    header_line, header = lines[0]
    columns = [_column(fmu, path, header_line, k, cell) for k, cell in enumerate(header)]
    _check_columns(path, columns, constants)
    measured = {column.name: [] for column in columns}
    for row, (line, cells) in enumerate(lines[1:], 1):
        for column in columns:
            measured[column.name].append(_value(path, row, line, column, cells, len(header)))
    names = tuple(name for name in measured if name not in (MEASURED, UNCERTAINTY))
    conditions = [
        {**constants, **{name: measured[name][k] for name in names}} for k in range(len(measured[MEASURED]))
    ]
    if LOAD in names:
        names = tuple("d" if name == LOAD else name for name in names)
        _loads_to_separations(path, conditions)
    return Measurements(names, conditions, measured[MEASURED], measured.get(UNCERTAINTY))


def _column(fmu: FrictionFmu, path: Path, line: int, index: int, cell: str) -> _Column:
    where = f"{path}, line {line}, column {index + 1}"
    match = HEADING.fullmatch(cell)
    if not match:
        raise UserError(f"{where}: heading {cell!r} is not of the form 'name [unit]', for example 'V [m/s]'")
    name, unit = match.groups()
    if name in (MEASURED, UNCERTAINTY, LOAD):
        known = {"N": 1.0, "mN": 1e-3, "kN": 1e3}
    elif name in accepted(fmu):
        known = units(fmu, name)
    else:
        others = ", ".join([MEASURED, UNCERTAINTY, LOAD, *accepted(fmu)])
        raise UserError(f"{where}: there is no variable {name!r}; columns may be {others}")
    if unit not in known:
        raise UserError(f"{where}: {name} is in {' or '.join(known)}, not in {unit!r}")
    return _Column(index, cell.strip(), name, known[unit])


def _check_columns(path: Path, columns: Sequence[_Column], constants: Mapping[str, Any]) -> None:
    names = [column.name for column in columns]
    for name in names:
        if names.count(name) > 1:
            raise UserError(f"{path}: column {name} is there twice")
        if name in constants:
            raise UserError(f"{path}: {name} is a column and also set as a constant")
    if MEASURED not in names:
        raise UserError(f"{path}: column '{MEASURED} [N]' is missing")
    if "V" not in names and "V" not in constants:
        raise UserError(f"{path}: column 'V [m/s]' is missing, and no --set V=... gives it")
    if LOAD in names and ("d" in names or "d" in constants):
        raise UserError(f"{path}: load and d both give the separation; keep one")


def _value(path: Path, row: int, line: int, column: _Column, cells: Sequence[str], width: int) -> float:
    where = f"{path}, row {row} (line {line}), column '{column.heading}'"
    if len(cells) > width:
        raise UserError(f"{path}, row {row} (line {line}): {len(cells)} cells, but {width} columns")
    if column.index >= len(cells) or not cells[column.index].strip():
        raise UserError(f"{where}: no value")
    text = cells[column.index].strip()
    value = number(text, where)
    if column.name in (UNCERTAINTY, LOAD) and value <= 0.0:
        raise UserError(f"{where}: {text} must be positive")
    return value * column.factor


def _loads_to_separations(path: Path, conditions: list[dict[str, Any]]) -> None:
    for row, condition in enumerate(conditions, 1):
        given = {
            field.name: float(condition[f"contact.{field.name.rstrip('_')}"])
            for field in fields(Surfaces)
            if f"contact.{field.name.rstrip('_')}" in condition
        }
        try:
            d = separation(Surfaces(**given), condition.pop(LOAD), float(condition.get("E", E_FULL)))
        except UserError as error:
            raise UserError(f"{path}, row {row}, column 'load': {error}") from None
        condition["d"] = d
