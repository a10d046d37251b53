"""What a sweep runs: the rows of a table that is never held whole, from a grid, at random, or of a CSV file.

A column is a variable of the FMU that can be set, its values in the units of the model description, those of
an enumeration by name. A row depends on its number alone, and is made where it is needed.
"""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from frictioncontact.errors import UserError, shown
from frictioncontact.tables import table
from frictioncontact.values import Value, Variables, check_whole, number

MAX_SCENARIOS = 1_000_000_000
MAX_VALUES = 10_000_000  # of one variable of a grid, which are held

Rows = Callable[[int, int], dict[str, np.ndarray]]  # the columns of scenarios first to stop - 1
Vary = Mapping[str, str | Sequence[Value]]


@dataclass(frozen=True)
class Scenarios:
    """How many rows, what makes them, and the values that they take: all, or the ends of a range."""

    count: int
    rows: Rows
    seen: Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Range:
    low: float
    high: float
    logarithmic: bool

    def spaced(self, count: int) -> np.ndarray:
        """So many, both ends included."""
        return (np.geomspace if self.logarithmic else np.linspace)(self.low, self.high, count)

    def at(self, u: np.ndarray) -> np.ndarray:
        """u is evenly spread over [0, 1)."""
        if self.logarithmic:
            values = np.exp((1.0 - u) * math.log(self.low) + u * math.log(self.high))
        else:
            values = self.low + u * (self.high - self.low)
        return np.clip(values, self.low, self.high)


def grid(variables: Variables, vary: Vary) -> Scenarios:
    """Every combination of the values; the last variable changes fastest."""
    axes = {}
    for name, given in vary.items():
        values, count = _values(variables, name, given, "low:high:count")
        axes[name] = values.spaced(_count(count, name)) if isinstance(values, Range) else values
    count = math.prod(map(len, axes.values()))
    if count > MAX_SCENARIOS:
        raise UserError(f"the grid has {count} scenarios; the most that a sweep runs is {MAX_SCENARIOS}")
    return Scenarios(count, partial(_grid_rows, axes), axes)


def _grid_rows(axes: Mapping[str, np.ndarray], first: int, stop: int) -> dict[str, np.ndarray]:
    places = np.unravel_index(np.arange(first, stop), [len(axis) for axis in axes.values()])
    return {name: axis[place] for (name, axis), place in zip(axes.items(), places, strict=True)}


def drawn(variables: Variables, vary: Vary, count: int, seed: int) -> Scenarios:
    """Each value drawn by itself."""
    check_whole(count, MAX_SCENARIOS, "random")
    values = {name: _values(variables, name, given, "low:high")[0] for name, given in vary.items()}
    ends = {name: each.spaced(2) if isinstance(each, Range) else each for name, each in values.items()}
    return Scenarios(count, partial(_drawn_rows, values, seed), ends)


def _drawn_rows(
    values: Mapping[str, np.ndarray | Range], seed: int, first: int, stop: int
) -> dict[str, np.ndarray]:
    """Every variable has a stream of its own, which PCG64 enters at any place."""
    rows = {}
    for stream, (name, those) in enumerate(values.items()):
        source = np.random.PCG64(np.random.SeedSequence(seed, spawn_key=(stream,))).advance(first)
        u = np.random.Generator(source).random(stop - first)
        rows[name] = those.at(u) if isinstance(those, Range) else those[(u * len(those)).astype(np.intp)]
    return rows


def from_csv(variables: Variables, path: Path) -> Scenarios:
    """A scenario a row, under headings as in tables.py."""
    read = table(path, "csv", variables.units(), "variable of the FMU")
    if not read.lines:
        raise UserError(f"{path}: has no row below the header")
    columns = {}
    for name, column in read.columns.items():
        values = [variables.text(name, text, read.place(name, k)) for k, text in enumerate(column.cells)]
        columns[name] = np.array(values) if variables.items[name] else np.array(values) * column.factor
    return Scenarios(len(read.lines), partial(_csv_rows, columns), columns)


def _csv_rows(columns: Mapping[str, np.ndarray], first: int, stop: int) -> dict[str, np.ndarray]:
    return {name: column[first:stop] for name, column in columns.items()}


def _values(
    variables: Variables, name: str, given: str | Sequence[Value], form: str
) -> tuple[np.ndarray | Range, str]:
    """Of "a,b,c", a sequence of values, or a range "low:high[:count][:log]", whose count it gives too."""
    where = f"vary {name}"
    items = variables.items[variables.find(name, where).name]
    parts = given.split(":") if isinstance(given, str) else []
    if len(parts) < 2:
        cells = given.split(",") if isinstance(given, str) else list(given)
        if all(isinstance(cell, str) for cell in cells):
            cells = [variables.text(name, cell.strip(), where) for cell in cells]
        listed = np.array([variables.value(name, cell, where) for cell in cells])
        if not len(listed):
            raise UserError(f"{where}: has no values")
        return listed, ""
    if items:
        raise UserError(f"{where}: {shown(given)} is a range, but its values are names: {','.join(items)}")
    logarithmic = parts[-1] == "log"
    if len(parts) - logarithmic != form.count(":") + 1:
        raise UserError(f"{where}: {shown(given)} is neither {form} nor {form}:log nor a,b,c")
    low, high = number(parts[0], where), number(parts[1], where)
    if not math.isfinite(high - low):
        raise UserError(f"{where}: from {low:g} to {high:g} is beyond the largest number")
    if high < low:
        raise UserError(f"{where}: the range ends at {high:g}, before it begins at {low:g}")
    if logarithmic and low <= 0.0:
        raise UserError(f"{where}: a logarithmic range must begin above 0, not at {low:g}")
    return Range(low, high, logarithmic), parts[2] if len(parts) > 2 else ""


def _count(text: str, name: str) -> int:
    if not re.fullmatch("[-+]?[0-9]{1,20}", text):
        raise UserError(f"vary {name}: the count {shown(text)} is not a whole number")
    count = int(text)
    check_whole(count, MAX_VALUES, f"vary {name}: the count")
    return count
