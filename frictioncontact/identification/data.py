"""Measurements from CSV files or frames: rows of means, or a series in time.

A column is named after a variable of the FMU: "V" in SI units, or with its unit in brackets, "V [mm/s]".
NAME.uncertainty is the standard uncertainty of the column NAME. A column "time" makes a series.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frictioncontact.columns import columns_of, numbers_below
from frictioncontact.errors import UserError, shown
from frictioncontact.fmu import FrictionFmu
from frictioncontact.values import csv_rows

if TYPE_CHECKING:
    import pandas as pd

MEASURED = "F_t_mean"
TIME, POSITION, FORCE = "time", "position", "F_t"
LOAD = "load"
SUFFIX = ".uncertainty"
FOLLOWS = {"contact.input": "Load", "friction.limit": "Load"}  # from a column or a constant load


@dataclass(frozen=True)
class Uncertain:
    """A condition that is not known exactly: in one row, or by the same amount in all."""

    name: str
    deviation: float  # standard uncertainty, in SI units
    row: int | None


@dataclass(frozen=True)
class Measurements:
    """conditions[k] are start values of the FMU for row k; all in SI units."""

    names: tuple[str, ...]  # the columns that are conditions
    conditions: list[dict[str, Any]]
    force: list[float]  # N
    uncertainty: list[float] | None  # N
    uncertain: tuple[Uncertain, ...] = ()


@dataclass(frozen=True)
class Series:
    """One record in time. Arrays are of the samples, in SI units."""

    time: np.ndarray
    V: np.ndarray  # m/s; of a position its central differences
    inputs: dict[str, np.ndarray]  # the other columns: load, d, E
    force: np.ndarray  # N
    constants: dict[str, Any]
    uncertainty: np.ndarray | None = None  # N
    position: np.ndarray | None = None

    @property
    def names(self) -> tuple[str, ...]:
        return ("V", *self.inputs)


@dataclass(frozen=True)
class Stated:
    """A standard uncertainty from the command line: a value in SI units, or a part of what it belongs to."""

    name: str
    value: float
    relative: bool

    def of(self, value: float) -> float:
        return self.value * abs(value) if self.relative else self.value


def read(
    source: Path | pd.DataFrame,
    fmu: FrictionFmu,
    constants: Mapping[str, Any],
    stated: Sequence[Stated] = (),
) -> Measurements | Series:
    """A CSV file, or a frame with the same headings; constants are start values that all rows share.

    No column may repeat one. UserError names the file, the row (counted from 1), its line and the column.
    """
    is_path = isinstance(source, Path)
    path = source if is_path else Path("data")
    lines = list(csv_rows(source)) if is_path else _lines(source)
    columns = columns_of(fmu, path, lines)
    names = [column.name for column in columns]
    is_series = TIME in names
    _check(path, names, constants, is_series)
    if not lines[1:]:
        raise UserError(f"{path}: no rows of numbers")
    positive = [name for name in names if name == LOAD or name.endswith(SUFFIX)]
    measured = numbers_below(path, columns, lines[1:], positive)
    shared = with_load(names, constants)
    if is_series:
        return _series(path, fmu, measured, shared, stated)
    return _rows(fmu, measured, shared, stated)


def _lines(frame: pd.DataFrame) -> list[tuple[int, list[str]]]:
    """A frame as lines of a CSV file."""
    if not hasattr(frame, "itertuples"):
        hint = "; it has one, .data" if hasattr(frame, "data") else ""
        raise UserError(f"data = {shown(frame)}: must be the path of a CSV file, or a pandas frame{hint}")
    cells = [[str(cell) for cell in row] for row in frame.itertuples(index=False)]
    return list(enumerate([[str(name) for name in frame.columns], *cells], 1))


def with_load(names: Sequence[str], constants: Mapping[str, Any]) -> dict[str, Any]:
    """The constants, with the load driving contact and limit where there is one and nothing else is said."""
    return {**(FOLLOWS if LOAD in names or LOAD in constants else {}), **constants}


def _check(path: Path, names: Sequence[str], constants: Mapping[str, Any], is_series: bool) -> None:
    for name in names:
        if name in constants:
            raise UserError(f"{path}: {name} is a column and also set as a constant")
        if name.endswith(SUFFIX) and name.removesuffix(SUFFIX) not in names:
            plain = name.removesuffix(SUFFIX)
            raise UserError(f"{path}: {name} belongs to a column {plain}, which is missing")
    measured = FORCE if is_series else MEASURED
    if measured not in names:
        raise UserError(f"{path}: column '{measured} [N]' is missing")
    if is_series and (POSITION in names) == ("V" in names):
        raise UserError(f"{path}: a series in time needs either 'position [m]' or 'V [m/s]'")
    if not is_series and "V" not in names and "V" not in constants:
        raise UserError(f"{path}: column 'V [m/s]' is missing, and no start value of V gives it")
    for name in (FORCE, POSITION) if not is_series else (MEASURED,):
        if name in names:
            where = "a series, with a column 'time [s]'" if not is_series else "rows of means, without time"
            raise UserError(f"{path}: {name} is for {where}")
    if LOAD in names and ("d" in names or "d" in constants):
        raise UserError(f"{path}: load and d both give the separation; keep one")


def _rows(
    fmu: FrictionFmu, measured: dict[str, list[float]], constants: dict[str, Any], stated: Sequence[Stated]
) -> Measurements:
    force = measured[MEASURED]
    names = tuple(name for name in measured if name != MEASURED and not name.endswith(SUFFIX))
    conditions = [{**constants, **{name: measured[name][k] for name in names}} for k in range(len(force))]
    uncertainty = measured.get(MEASURED + SUFFIX)
    uncertain = [
        Uncertain(name, deviation, row)
        for name in names
        for row, deviation in enumerate(measured.get(name + SUFFIX, []))
    ]
    for one in stated:
        if one.name == MEASURED:
            uncertainty = [one.of(value) for value in force]
            if 0.0 in uncertainty:
                row = uncertainty.index(0.0) + 1
                raise UserError(f"the uncertainty of {MEASURED}: row {row} measures 0 N, so give it in N")
        elif one.name == FORCE:
            raise UserError(f"the uncertainty of {FORCE}: rows of means take that of {MEASURED}")
        elif one.name in names:
            uncertain += [Uncertain(one.name, one.of(measured[one.name][k]), k) for k in range(len(force))]
        else:
            usual = float(constants.get(one.name, fmu.variables[one.name].start))
            uncertain.append(Uncertain(one.name, one.of(usual), None))
    uncertain = [one for one in uncertain if one.deviation > 0.0]
    if uncertain and uncertainty is None:
        raise UserError(
            f"the uncertainty of {uncertain[0].name} can't be weighed without that of {MEASURED}: "
            f"give a column '{MEASURED}{SUFFIX} [N]' or state it"
        )
    return Measurements(names, conditions, force, uncertainty, tuple(uncertain))


def _series(
    path: Path,
    fmu: FrictionFmu,
    measured: dict[str, list[float]],
    constants: dict[str, Any],
    stated: Sequence[Stated],
) -> Series:
    columns = {name: np.array(values) for name, values in measured.items()}
    time, force = columns.pop(TIME), columns.pop(FORCE)
    if len(time) < 3:
        raise UserError(f"{path}: a series needs at least 3 rows")
    backward = np.flatnonzero(np.diff(time) <= 0.0)
    if len(backward):
        raise UserError(f"{path}, row {backward[0] + 2}: time must grow from row to row")
    uncertainty = columns.pop(FORCE + SUFFIX, None)
    for one in stated:
        if one.name != FORCE:
            raise UserError(f"the uncertainty of {one.name}: a series takes the uncertainty of {FORCE} alone")
        uncertainty = np.array([one.of(value) for value in force])
        if not (uncertainty > 0.0).all():
            raise UserError(f"the uncertainty of {FORCE}: give it in N, since the force passes zero")
    position = columns.pop(POSITION, None)
    given = columns.pop("V", None)
    V = np.gradient(position, time, edge_order=2) if given is None else given
    for name in columns:
        if name.endswith(SUFFIX) or fmu.variables[name].causality != "input":
            raise UserError(
                f"{path}: column {name}: a series takes inputs of the FMU, d, E and load; "
                "give it as a start value"
            )
    return Series(time, V, columns, force, constants, uncertainty, position)
