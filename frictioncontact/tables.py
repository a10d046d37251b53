"""The one grammar of tables: a CSV file, a mapping or a pandas frame, with a heading over each column.

A heading is "NAME" in SI units, or has its unit: "NAME [UNIT]", "NAME (UNIT)", "NAME in UNIT". Other names
are those of an option: variable -> heading of the table. A file may have columns apart by commas, semicolons,
tabs or spaces, decimal commas, a preamble, and a row of units below the header.
"""

from __future__ import annotations

import csv
import os
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from frictioncontact.errors import UserError, did_you_mean, shown, warn
from frictioncontact.units import factor, is_unit
from frictioncontact.values import LARGEST, number, numbers_of, path_of

if TYPE_CHECKING:
    import pandas as pd
    from fmpy.model_description import ScalarVariable

    Source = str | Path | Mapping[str, npt.ArrayLike] | pd.DataFrame

HEADING = re.compile(r"([^\[\]]+?)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\)|\s(?:in|/)\s+([^\[\],;\t]*))?")
DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d+(?:e[-+]?\d+)?", re.IGNORECASE)
DECIMAL_POINT = re.compile(r"[-+]?\d*\.\d*(?:e[-+]?\d+)?", re.IGNORECASE)
SEPARATORS = (";", "\t", ",", " ")
TIME, POSITION = "time", "position"
MEASURED = {"F_t": "N", "F_t_mean": "N"}
OWN = {TIME: "s", POSITION: "m", **MEASURED}  # columns that are no inputs or parameters of the FMU
SUFFIX = ".uncertainty"


def accepted(variables: Mapping[str, ScalarVariable]) -> dict[str, str]:
    """Variables that a measured column may hold, or a fit vary, with their units."""
    return {
        name: variable.unit or "1"
        for name, variable in variables.items()
        if variable.type == "Real"
        and variable.causality in ("input", "parameter")
        and not name.startswith("solver.")
        and name not in ("delta_0", "delta_y_0")
    }


@dataclass(frozen=True)
class Column:
    name: str
    heading: str
    factor: float  # from the column's unit to SI
    cells: Any  # texts of a file, or what the mapping or frame holds


@dataclass(frozen=True)
class Table:
    where: str
    columns: dict[str, Column]
    lines: Sequence[int] | None = None  # of a file, of each row

    def place(self, column: Column, row: int) -> str:
        """Of a cell, for errors; rows of a file count from 1."""
        if self.lines is None:
            return f"{self.where}: {column.name}, row {row}"
        return f"{self.where}, row {row + 1} (line {self.lines[row]}), column '{column.heading}'"

    def numbers(self, positive: Collection[str] = ()) -> dict[str, np.ndarray]:
        """The columns by name, in SI units, of one length; positive: those whose values must be."""
        found = {name: self._numbers(column) for name, column in self.columns.items()}
        first = next(iter(found), "")
        for name, values in found.items():
            if len(values) != len(found[first]):
                counts = f"{len(values)} values and {first} has {len(found[first])}"
                raise UserError(f"{self.where}: {name} has {counts}")
            bad = (np.abs(values) > LARGEST) | ((values <= 0.0) if name in positive else False)
            if bad.any():
                row = int(np.argmax(bad))
                bounds = "positive" if abs(values[row]) <= LARGEST else f"from {-LARGEST:g} to {LARGEST:g}"
                where = self.place(self.columns[name], row)
                raise UserError(f"{where}: {self.columns[name].cells[row]} must be {bounds}")
        return {name: values * self.columns[name].factor for name, values in found.items()}

    def _numbers(self, column: Column) -> np.ndarray:
        if self.lines is not None:
            return np.array([number(text, self.place(column, k)) for k, text in enumerate(column.cells)])
        array = numbers_of(column.cells, f"{self.where}: {column.name}")
        if array.ndim != 1:
            raise UserError(f"{self.where}: {column.name} is not a row of numbers")
        return array


def table(
    source: Source, where: str, units: Mapping[str, str], what: str, named: Mapping[str, str] | None = None
) -> Table:
    """A table whose columns are some of those with these units; UserError where a heading is wrong.

    what: what the names are, for errors. named: "NAME" or "NAME [UNIT]" -> heading of the table; then other
    columns are left out, with a warning.
    """
    if isinstance(source, (str, os.PathLike)):
        return _of_file(path_of(source, where), units, what, named)
    if not isinstance(source, Mapping) and not hasattr(source, "columns"):
        hint = "; it has one, .data" if hasattr(source, "data") else ""
        raise UserError(
            f"{where} = {shown(source)}: must be the path of a CSV file, a mapping of names to values, "
            f"or a pandas frame{hint}"
        )
    headings = [str(name) for name in source]
    columns = headed(headings, [where] * len(headings), units, what, named)
    cells = list(source.values()) if isinstance(source, Mapping) else [column.array for _, column in source.items()]
    return Table(where, {c.name: replace(c, cells=cells[k]) for k, c in columns.items()})


def headed(
    headings: Sequence[str],
    places: Sequence[str],
    units: Mapping[str, str],
    what: str,
    named: Mapping[str, str] | None = None,
) -> dict[int, Column]:
    """Number of each column that has a name -> the column, without cells; places: of headings, for errors."""
    others = _others(named)
    found: dict[int, Column] = {}
    idle: list[str] = []
    for k, (cell, place) in enumerate(zip(headings, places, strict=True)):
        name, unit = _parted(cell)
        asked = others.pop(cell, None) or others.pop(name, None)
        name, unit = (asked[0], asked[1] or unit) if asked else (name, unit)
        if name not in units:
            if not cell:
                continue  # an index
            if named:
                idle.append(f"{place}: column {shown(cell)} is not used")
                continue
            if not name:
                raise UserError(f"{place}: heading {cell!r} is not of the form 'name [unit]' or 'name'")
            hint = did_you_mean(name, units, likeness=0.7) or f"; these are: {', '.join(name for name in units if SUFFIX not in name)}"
            raise UserError(f"{place}: {name} is no {what}{hint}")
        if name in [column.name for column in found.values()]:
            raise UserError(f"{place}: {name} is there twice")
        scale = 1.0 if unit is None else factor(unit, units[name], f"{place}: {name}")
        found[k] = Column(name, cell, scale, ())
    for missing, (name, _) in others.items():
        raise UserError(f"column {name}: there is no heading {shown(missing)}; these are: {', '.join(headings)}")
    warn(idle)
    return found


def in_SI(values: Mapping[Any, Any], units: Mapping[str, str], where: str) -> dict[Any, Any]:
    """Values of any shape by name; those under a heading with a unit in SI units."""
    found: dict[Any, Any] = {}
    for heading, value in values.items():
        name, unit = _parted(heading) if isinstance(heading, str) else (heading, None)
        if unit is None or name not in units:
            name = heading
        else:
            value = numbers_of(value, f"{where} {name}") * factor(unit, units[name], f"{where} {name}")
        if name in found:
            raise UserError(f"{where} {name}: is there twice")
        found[name] = value
    return found


def _others(named: Mapping[str, str] | None) -> dict[str, tuple[str, str | None]]:
    """Heading of the table -> name and unit that it stands for."""
    return {str(heading).strip(): _parted(name) for name, heading in (named or {}).items()}


def _parted(cell: str) -> tuple[str, str | None]:
    """Name and unit; no name where the heading is of another form."""
    match = HEADING.fullmatch(cell.strip())
    if not match:
        return "", None
    return match[1], next((unit.strip() for unit in match.groups()[1:] if unit is not None), None)


def _of_file(path: Path, units: Mapping[str, str], what: str, named: Mapping[str, str] | None) -> Table:
    lines = [(k, line) for k, line in enumerate(re.split("\r\n|\r|\n", _text(path)), 1) if line.strip()]
    known = {*units, *_others(named)}
    try:
        header, separator = _header(lines, known)
        rows = [(k, _cells(line, separator)) for k, line in lines if line.lstrip()[0] != "#" or k == header]
    except csv.Error as error:
        raise UserError(f"{path}: is not a CSV file: {error}") from None
    rows = [(k, cells) for k, cells in rows if k >= header and any(cells)]
    if not rows:
        raise UserError(f"{path}: no header row")
    headings, below = rows[0][1], rows[1:]
    while len(headings) > 1 and not headings[-1]:
        headings.pop()
    if below and _are_units(below[0][1]):
        units_row = below.pop(0)[1]
        headings = [f"{name} [{unit.strip('[]()')}]" if unit else name for name, unit in zip(headings, units_row, strict=False)]
    places = [f"{path}, line {header}, column {k}" for k in range(1, len(headings) + 1)]
    columns = headed(headings, places, units, what, named)
    for row, (k, cells) in enumerate(below, 1):
        _fill(cells, len(headings), columns, f"{path}, row {row} (line {k})")
    filled = _with_points([cells for _, cells in below], separator, path)
    made = {c.name: replace(c, cells=[cells[k] for cells in filled]) for k, c in columns.items()}
    return Table(str(path), made, [k for k, _ in below])


def _text(path: Path) -> str:
    try:
        content = path.read_bytes()
    except OSError as error:
        raise UserError(f"{path}: {error.strerror}") from None
    wide = content[:2] in (b"\xff\xfe", b"\xfe\xff")
    for encoding in ("utf-16",) if wide else ("utf-8-sig", "cp1252"):
        try:
            text = content.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text
    raise UserError(f"{path}: is not a CSV file: its bytes are no text")


def _header(lines: Sequence[tuple[int, str]], known: Collection[str]) -> tuple[int, str]:
    """The number of the first line with a known heading, and what separates its cells.

    A remark if no other line has one: numpy.savetxt writes such a header.
    """
    plain = [(k, line) for k, line in lines if line.lstrip()[0] != "#"]
    for k, line in [*plain, *lines]:
        found = []
        for separator in SEPARATORS:
            cells = _cells(line, separator)
            found.append(sum(cell in known or _parted(cell)[0] in known for cell in cells))
        if any(found):
            return k, SEPARATORS[int(np.argmax(found))]
    return plain[0][0] if plain else 0, max(SEPARATORS[:3], key=lambda one: plain[0][1].count(one) if plain else 0)


def _cells(line: str, separator: str) -> list[str]:
    line = re.sub(r"^\s*#+\s*", "", line)
    if separator == " ":
        return re.split(r"\s+(?![\[(]|[^\[(]*[\])])", line.strip())
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator, strict=True))]


def _are_units(cells: Sequence[str]) -> bool:
    """Whether a row below the header has the units of the columns."""
    words = [cell for cell in cells if cell]
    return all(re.match(r"[^\d+\-.,]", word) and is_unit(word.strip("[]()")) for word in words)


def _fill(cells: list[str], count: int, columns: Mapping[int, Column], where: str) -> None:
    """So many cells; UserError where they are more, or where one that is needed is missing."""
    while len(cells) > count and not cells[-1]:
        cells.pop()
    if len(cells) > count:
        raise UserError(f"{where}: {len(cells)} cells, but {count} columns; decimals have a point")
    cells += [""] * (count - len(cells))
    for k, column in columns.items():
        if not cells[k]:
            raise UserError(f"{where}, column '{column.heading}': no value")


def _with_points(rows: list[list[str]], separator: str, path: Path) -> list[list[str]]:
    """The cells with decimal points, where the file has decimal commas and they do not separate columns."""
    every = [cell for cells in rows for cell in cells]
    if separator == "," or not any(DECIMAL_COMMA.fullmatch(cell) for cell in every):
        return rows
    if both := next((cell for cell in every if DECIMAL_POINT.fullmatch(cell)), None):
        raise UserError(f"{path}: has decimal commas and decimal points, as in {shown(both)}; write one of them")
    return [[cell.replace(",", ".") if DECIMAL_COMMA.fullmatch(cell) else cell for cell in cells] for cells in rows]
