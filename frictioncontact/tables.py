"""The one grammar of tables: a CSV file, a mapping or a pandas frame, with a heading over each column.

A heading is "NAME" in SI units, or has its unit: "NAME [UNIT]", "NAME (UNIT)", "NAME in UNIT". Other names
are those of an option: variable -> heading of the table. A file may have columns apart by commas, semicolons,
tabs or spaces, decimal commas, a preamble, and a row of units below the header.
"""

from __future__ import annotations

import csv
import gzip
import os
import re
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from frictioncontact.errors import UserError, did_you_mean, shown, warn
from frictioncontact.values import LARGEST, number, numbers_of, path_of

if TYPE_CHECKING:
    import pandas as pd
    from fmpy.model_description import ScalarVariable
    from pint import UnitRegistry

    Source = str | Path | Mapping[str, npt.ArrayLike] | pd.DataFrame

HEADING = re.compile(r"([^\[\]]+?)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\)|\s(?:in|/)\s+([^\[\],;\t]*))?", re.DOTALL)
COMMA, POINT = (re.compile(rf"[-+]?\d*{mark}\d*(?:e[-+]?\d+)?", re.IGNORECASE) for mark in (",", r"\."))
SEPARATORS = (";", "\t", ",", " ")
FIRST = 1000  # lines in which the header is
TIME, POSITION, ORDER = "time", "position", "order"
# Columns that are no inputs or parameters.
OWN = {TIME: "s", POSITION: "m", "F_t": "N", "F_t_mean": "N", ORDER: "1"}
SUFFIX = ".uncertainty"
# What logs call them, in small letters and without marks; F_t is F_t_mean without time and position.
LOGS = {
    TIME: "time t elapsedtime zeit",
    POSITION: "position pos disp displacement stroke weg x",
    "F_t": "force fx ft ff friction frictionforce tangentialforce kraft",
    "V": "v velocity vel speed",
    "load": "load normal normalforce normalload fn fz",
}
ALIASES = {word: name for name, words in LOGS.items() for word in words.split()}
EMPTY = ("", "nan", "na", "n/a", "-", "--", "null")  # cells without a value, in small letters


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
    heading: str
    factor: float  # from its unit to SI
    cells: Any = ()  # texts of a file, or what the mapping or frame holds


@dataclass(frozen=True)
class Table:
    where: str
    columns: dict[str, Column]
    lines: Sequence[int] | None = None  # of a file, of each row

    def place(self, name: str, row: int) -> str:
        """Of a cell, for errors; rows of a file count from 1."""
        if self.lines is None:
            return f"{self.where}: {name}, row {row}"
        heading = self.columns[name].heading
        return f"{self.where}, row {row + 1} (line {self.lines[row]}), column '{heading}'"

    def numbers(self, positive: Collection[str] = ()) -> dict[str, np.ndarray]:
        """The columns by name, in SI units, of one length; positive: those whose values must be."""
        found: dict[str, np.ndarray] = {}
        for name, column in self.columns.items():
            if self.lines is None:
                values = numbers_of(column.cells, f"{self.where}: {name}")
            else:
                values = np.array([number(text, self.place(name, k)) for k, text in enumerate(column.cells)])
            if values.ndim != 1:
                raise UserError(f"{self.where}: {name} is not a row of numbers")
            for other, those in found.items():
                if len(values) != len(those):
                    counts = f"{len(values)} values and {other} has {len(those)}"
                    raise UserError(f"{self.where}: {name} has {counts}")
            least = 0.0 if name in positive else -np.inf
            bad = (np.abs(values) > LARGEST) | (values <= least)
            if bad.any():
                row = int(np.argmax(bad))
                bounds = "positive" if abs(values[row]) <= LARGEST else f"from {-LARGEST:g} to {LARGEST:g}"
                raise UserError(f"{self.place(name, row)}: {column.cells[row]} must be {bounds}")
            found[name] = values * column.factor
        return found


def table(
    source: Source,
    where: str,
    units: Mapping[str, str],
    what: str,
    named: Mapping[str, str] | None = None,
    is_log: bool = False,
) -> Table:
    """A table whose columns are some of those with these units; UserError where a heading is wrong.

    what: what the names are, for errors. named: "NAME" or "NAME [UNIT]" -> heading of the table. is_log: a
    log as some instrument wrote it. What it calls otherwise is recognized, and what is not is left out; so
    are rows without a value. A warning tells each.
    """
    lines: list[int] | None = None
    if isinstance(source, (str, os.PathLike)):
        where, places, headings, cells, lines = _of_file(path_of(source, where), {*units, *_others(named)})
    elif isinstance(source, Mapping) or hasattr(source, "columns"):
        headings = [str(name) for name in source]
        places = [where] * len(headings)
        cells = [each if isinstance(source, Mapping) else each.array for _, each in source.items()]
    else:
        hint = "; it has one, .data" if hasattr(source, "data") else ""
        raise UserError(
            f"{where} = {shown(source)}: must be the path of a CSV file, a mapping of names to values, "
            f"or a pandas frame{hint}"
        )
    found: dict[str, Column] = {}
    others, said = _others(named), []
    if is_log:
        taken = _taken(headings, units, {name for name, _ in others.values()})
        said = [f"{where}: column {shown(heading)} is taken as {name}" for name, heading in taken.items()]
        others = _others(taken) | others
    for cell, place, values in zip(headings, places, cells, strict=True):
        name, unit = _parted(cell)
        if asked := others.pop(cell, None) or others.pop(name, None):
            name, unit = asked[0], asked[1] or unit
        if name in found:
            raise UserError(f"{place}: {name} is there twice")
        if name in units:
            size = 1.0 if unit is None else factor(unit, units[name], f"{place}: {name}")
            found[name] = Column(cell, size, values)
        elif is_log or named:
            hint = did_you_mean(name, units, likeness=0.7)
            said.append(f"{place}: column {shown(cell)} is not used{hint}")
        elif cell and not name:
            raise UserError(f"{place}: heading {cell!r} is not of the form 'name [unit]' or 'name'")
        elif cell:  # and not an index
            plain = ", ".join(name for name in units if SUFFIX not in name)
            hint = did_you_mean(name, units, likeness=0.7) or f"; these are: {plain}"
            raise UserError(f"{place}: {name} is no {what}{hint}")
    for missing, (name, _) in others.items():
        there = ", ".join(headings)
        raise UserError(f"column {name}: there is no heading {shown(missing)}; these are: {there}")
    if lines is not None and found:
        rows = list(zip(*(column.cells for column in found.values()), strict=True))
        empty = [any(cell.lower() in EMPTY for cell in row) for row in rows]
        if any(empty) and not is_log:
            k = empty.index(True)
            name = next(name for name, column in found.items() if column.cells[k].lower() in EMPTY)
            raise UserError(f"{Table(where, found, lines).place(name, k)}: no value")
        if any(empty):
            said.append(f"{where}: {sum(empty)} of {len(rows)} rows have no value and are left out")
            kept = [k for k, is_empty in enumerate(empty) if not is_empty]
            lines = [lines[k] for k in kept]
            found = {n: replace(one, cells=[one.cells[k] for k in kept]) for n, one in found.items()}
    warn(said)
    return Table(where, found, lines)


def _taken(headings: Sequence[str], units: Mapping[str, str], given: Collection[str]) -> dict[str, str]:
    """Name, or "NAME [UNIT]" -> the heading that is taken as it; UserError where two are."""
    names = {_parted(heading)[0] for heading in headings}
    found: dict[str, str] = {}
    for heading in headings:
        name, unit = _parted(heading)
        meant, after = _meant(name)
        if meant is None or name in units or meant in {*names, *given}:
            continue
        if twice := next((other for key, other in found.items() if _parted(key)[0] == meant), None):
            raise UserError(f"{shown(twice)} and {shown(heading)} look like {meant}; name one by an option")
        unit = unit or after
        found[meant if unit is None else f"{meant} [{unit}]"] = heading
    if not {TIME, POSITION} & {*names, *given, *(_parted(key)[0] for key in found)}:
        found = {re.sub("^F_t", "F_t_mean", key): heading for key, heading in found.items()}
    return {key: heading for key, heading in found.items() if _parted(key)[0] in units}


def _meant(name: str) -> tuple[str | None, str | None]:
    """What a log means by a heading, and the unit at its end, as in time_s."""
    for text, unit in ((name, None), name.rpartition("_")[::2]):
        meant = ALIASES.get(re.sub(r"[^a-z]", "", text.lower()))
        if meant is not None and (unit is None or is_unit(unit)):
            return meant, unit
    return None, None


def in_SI(values: Mapping[Any, Any], units: Mapping[str, str], where: str) -> dict[Any, Any]:
    """Values of any shape by name; those under a heading with a unit in SI units."""
    found: dict[Any, Any] = {}
    for heading, value in values.items():
        name, unit = _parted(str(heading))
        if unit is not None and name in units:
            size = factor(unit, units[name], f"{where} {name}")
            heading, value = name, numbers_of(value, f"{where} {name}") * size
        if heading in found:
            raise UserError(f"{where} {heading}: is there twice")
        found[heading] = value
    return found


def _others(named: Mapping[str, str] | None) -> dict[str, tuple[str, str | None]]:
    """Heading of the table -> name and unit that it stands for."""
    return {str(heading).strip(): _parted(name) for name, heading in (named or {}).items()}


def _parted(cell: str) -> tuple[str, str | None]:
    """Name and unit; no name where the heading is of another form."""
    name, *units = (HEADING.fullmatch(cell.strip()) or re.fullmatch("()", "")).groups()
    return name, next((unit.strip() for unit in units if unit is not None), None)


def _of_file(
    path: Path, known: Collection[str]
) -> tuple[str, list[str], list[str], list[list[str]], list[int]]:
    """Its name, the places of the headings, the headings, the cells of each column, the rows' lines."""
    lines = [(k, line) for k, line in enumerate(re.split("\r\n|\r|\n", _text(path)), 1) if line.strip()]
    try:
        header, separator = _header(lines, known)
        below = [line for line in lines if line[0] > header and line[1].lstrip()[0] != "#"]
        rows = [(k, cells) for k, line in below if any(cells := _cells(line, separator))]
        headings = _cells(dict(lines).get(header, ""), separator)
    except csv.Error as error:
        raise UserError(f"{path}: is not a CSV file: {error}") from None
    if not any(headings):
        raise UserError(f"{path}: no header row")
    words = [word for word in rows[0][1] if word] if rows else []
    if any(is_unit(word.strip("[]()")) for word in words) and all(
        re.match(r"[^\d+\-.,]", word) for word in words
    ):
        headings = [
            f"{name} [{unit.strip('[]()')}]" for name, unit in zip(headings, rows.pop(0)[1], strict=False)
        ]
        headings = [heading.removesuffix(" []") for heading in headings]
    for row, (k, cells) in enumerate(rows, 1):
        if any(cells[len(headings) :]):
            counts = f"{len(cells)} cells, but {len(headings)} columns; decimals have a point"
            raise UserError(f"{path}, row {row} (line {k}): {counts}")
        cells += [""] * (len(headings) - len(cells))
    columns = [[cells[k] for _, cells in rows] for k in range(len(headings))]
    places = [f"{path}, line {header}, column {k}" for k in range(1, len(headings) + 1)]
    return str(path), places, headings, _with_points(columns, separator, path), [k for k, _ in rows]


def _text(path: Path) -> str:
    try:
        content = path.read_bytes()
    except OSError as error:
        raise UserError(f"{path}: {error.strerror}") from None
    if content[:2] == b"\x1f\x8b":
        content = gzip.decompress(content)
    wide = content[:2] in (b"\xff\xfe", b"\xfe\xff")
    for encoding in ("utf-16",) if wide else ("utf-8-sig", "cp1252"):
        text = content.decode(encoding, errors="replace")
        if not set(text) & {"\0", "\ufffd"}:
            return text
    raise UserError(f"{path}: is not a CSV file: its bytes are no text")


def _header(lines: Sequence[tuple[int, str]], known: Collection[str]) -> tuple[int, str]:
    """The number of the line with the most known headings, and what separates its cells; else the first.

    A remark if no other line has one: numpy.savetxt writes such a header.
    """
    plain = [(k, line) for k, line in lines if line.lstrip()[0] != "#"]
    for candidates in (plain, lines):
        most, place = 0, (0, "")
        for k, line in candidates[:FIRST]:
            for separator in SEPARATORS:
                with suppress(csv.Error):  # of a preamble
                    cells = _cells(line, separator)
                    sure = [{cell, _parted(cell)[0]} & {*known} for cell in cells]
                    likely = [_meant(_parted(cell)[0])[0] for cell in cells]
                    count = sum(1.0 if a else 0.9 if b else 0.0 for a, b in zip(sure, likely, strict=True))
                    most, place = (count, (k, separator)) if count > most else (most, place)
        if most:
            return place
    k, line = next(iter(plain), (0, ""))
    return k, max(SEPARATORS[:3], key=line.count)


def _cells(line: str, separator: str) -> list[str]:
    line = re.sub(r"^\s*#+\s*", "", line)
    if separator == " ":
        return re.split(r"\s+(?![\[(]|[^\[(]*[\])])", line.strip())
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator, strict=True), [])]


def _with_points(columns: list[list[str]], separator: str, path: Path) -> list[list[str]]:
    """The cells with decimal points, where the file has decimal commas and they do not separate columns."""
    every = [cell for cells in columns for cell in cells if cell]
    if separator == "," or not any(COMMA.fullmatch(cell) for cell in every):
        return columns
    if both := next(filter(POINT.fullmatch, every), None):
        raise UserError(
            f"{path}: has decimal commas and decimal points, as in {shown(both)}; write one of them"
        )
    return [
        [cell.replace(",", ".") if COMMA.fullmatch(cell) else cell for cell in cells] for cells in columns
    ]


def factor(unit: str, si: str, where: str) -> float:
    """From a unit to the SI unit of the same kind; UserError where it is of another kind, or no unit."""
    if unit == si:
        return 1.0
    given, wanted = _root(unit), _root(si)
    if given is None or given[1] != wanted[1]:
        given = _root(unit.lower())  # a heading in capitals
    if given is None or given[1] != wanted[1]:
        raise UserError(f"{where} takes {f'a unit like {si}' if si != '1' else 'no unit'}, not {shown(unit)}")
    return given[0] / wanted[0]


def is_unit(text: str) -> bool:
    return _root(text) is not None


@cache
def _root(unit: str) -> Any:
    """Factor and unit in base units; None of what is no unit. rad/s is not Hz: radians stay."""
    powers = re.sub(r"(?<=[^\W\d])(-?\d)", r"**\1", unit)  # mm2, s-1
    registry = _registry()
    with suppress(Exception):  # pint raises whatever its parser comes to
        return registry.get_root_units(registry.parse_units(powers))


@cache
def _registry() -> UnitRegistry:
    import pint  # where a heading has a unit

    registry: UnitRegistry = pint.UnitRegistry()
    registry.define("newton_second = newton * second = Ns")
    return registry
