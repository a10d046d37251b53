"""What a sweep runs: scenarios as the rows of a table, from a grid, at random, or from a CSV file.

A column is a variable of the FMU that can be set, its values in the units of the model description; an
enumeration's values are the names of its items. Rows of a grid are made where they are needed.
"""

from __future__ import annotations

import hashlib
import math
from array import array
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from frictionlab.project import UserError
from frictionlab.values import Value, Variables, assignment, csv_rows, items_of, number, shown

MOST_SCENARIOS = 10_000_000


@dataclass(frozen=True)
class Column:
    """The values of one variable in all scenarios: numbers, and names where they are items of an enumeration.

    Scenario i has the value with the number picks[i], or else (i // repeat) modulo the number of values.
    """

    numbers: np.ndarray
    names: np.ndarray | None = None
    repeat: int = 1
    picks: np.ndarray | None = None

    def rows(self, first: int, stop: int) -> np.ndarray:
        """Numbers of these scenarios."""
        return self.numbers[self._index(first, stop)]

    def shown(self, first: int, stop: int) -> np.ndarray:
        """The same as results show them: enumerations by name."""
        return (self.numbers if self.names is None else self.names)[self._index(first, stop)]

    def _index(self, first: int, stop: int) -> np.ndarray | slice:
        if self.picks is not None:
            return self.picks[first:stop]
        if self.repeat == 1 and stop <= len(self.numbers):
            return slice(first, stop)
        return np.arange(first, stop) // self.repeat % len(self.numbers)

    def content(self) -> Iterable[bytes]:
        """Equal for equal columns."""
        yield repr((self.repeat, None if self.names is None else list(self.names))).encode()
        yield self.numbers.tobytes()
        yield b"" if self.picks is None else self.picks.tobytes()


def _column(
    variables: Variables,
    name: str,
    values: Sequence[Value],
    repeat: int = 1,
    picks: np.ndarray | None = None,
) -> Column:
    items = items_of(variables.find(name, name))
    numbers = np.array(values if items is None else [items[value] for value in values], dtype=float)
    return Column(numbers, None if items is None else np.array(values, dtype=object), repeat, picks)


@dataclass(frozen=True)
class Scenarios:
    """So many scenarios of named columns."""

    count: int
    columns: dict[str, Column] = field(repr=False)

    def rows(self, first: int, stop: int) -> dict[str, np.ndarray]:
        """Numbers of each column; one where all scenarios share it."""
        return {
            name: column.numbers if len(column.numbers) == 1 else column.rows(first, stop)
            for name, column in self.columns.items()
        }

    def shown(self, first: int, stop: int) -> dict[str, np.ndarray]:
        return {name: column.shown(first, stop) for name, column in self.columns.items()}

    def digest(self) -> str:
        """Equal for equal scenarios in the same order."""
        state = hashlib.sha256(str(self.count).encode())
        for name, column in self.columns.items():
            state.update(name.encode())
            for part in column.content():
                state.update(part)
        return state.hexdigest()


def _bounds(parts: Sequence[str], where: str) -> tuple[float, float, bool]:
    """Lower and upper end of a range, and whether it is logarithmic."""
    low, high = number(parts[0], where), number(parts[1], where)
    logarithmic = parts[-1] == "log"
    if high < low:
        raise UserError(f"{where}: the range ends at {high:g}, before it begins at {low:g}")
    if logarithmic and low <= 0.0:
        raise UserError(f"{where}: a logarithmic range must begin above 0, not at {low:g}")
    return low, high, logarithmic


def grid_values(variables: Variables, text: str) -> tuple[str, list[Value]]:
    """Of "NAME=a,b,c", "NAME=low:high:count" or "NAME=low:high:count:log"."""
    name, rest = assignment(text, "--vary")
    where = f"--vary {name}"
    variables.find(name, where)
    parts = rest.split(":")
    if len(parts) == 1:
        return name, [variables.value(name, item.strip(), where) for item in rest.split(",")]
    if len(parts) not in (3, 4) or (len(parts) == 4 and parts[3] != "log"):
        raise UserError(f"{where}: {shown(rest)} is neither low:high:count nor low:high:count:log nor a,b,c")
    low, high, logarithmic = _bounds(parts, where)
    is_whole = parts[2].isascii() and parts[2].isdecimal()
    if not is_whole or len(parts[2]) > 9 or not 1 <= int(parts[2]) <= MOST_SCENARIOS:
        raise UserError(
            f"{where}: the count {shown(parts[2])} is not a whole number from 1 to {MOST_SCENARIOS}"
        )
    spaced = np.geomspace if logarithmic else np.linspace
    return name, [float(value) for value in spaced(low, high, int(parts[2]))]


def grid(variables: Variables, texts: Iterable[str]) -> Scenarios:
    """Every combination of the values; the last variable changes fastest."""
    axes = dict(_once(grid_values(variables, text) for text in texts))
    count = math.prod(len(values) for values in axes.values())
    if count > MOST_SCENARIOS:
        raise UserError(f"the grid has {count} scenarios; the most that a sweep runs is {MOST_SCENARIOS}")
    columns, repeat = {}, count
    for name, values in axes.items():
        repeat //= len(values)
        columns[name] = _column(variables, name, values, repeat)
    return Scenarios(count, columns)


def _once(columns: Iterable[tuple[str, object]]) -> Iterable[tuple[str, object]]:
    seen = set()
    for name, values in columns:
        if name in seen:
            raise UserError(f"--vary {name}: is given twice")
        seen.add(name)
        yield name, values


def random(variables: Variables, texts: Iterable[str], count: int, seed: int) -> Scenarios:
    """count rows, each value drawn by itself from "NAME=low:high", "NAME=low:high:log" or "NAME=a,b,c"."""
    if count > MOST_SCENARIOS:
        raise UserError(f"--random {count}: the most that a sweep runs is {MOST_SCENARIOS}")
    generator = np.random.default_rng(seed)

    def column(text: str) -> tuple[str, Column]:
        name, rest = assignment(text, "--vary")
        where = f"--vary {name}"
        variables.find(name, where)
        parts = rest.split(":")
        if len(parts) == 1:
            values = [variables.value(name, item.strip(), where) for item in rest.split(",")]
            picks = generator.integers(0, len(values), count)
            return name, _column(variables, name, values, picks=picks.astype(np.int32))
        if len(parts) > 3 or (len(parts) == 3 and parts[2] != "log"):
            raise UserError(
                f"{where}: {shown(rest)} is neither low:high nor low:high:log nor a,b,c (with --random)"
            )
        low, high, logarithmic = _bounds(parts, where)
        if logarithmic:
            return name, Column(np.exp(generator.uniform(math.log(low), math.log(high), count)))
        return name, Column(generator.uniform(low, high, count))

    return Scenarios(count, dict(_once(column(text) for text in texts)))


def from_csv(variables: Variables, path: Path) -> Scenarios:
    """A header with names of variables, then one scenario a row.

    Errors name row (the header is 1) and column.
    """
    rows = csv_rows(path)
    _, names = next(rows, (1, []))
    if not names:
        raise UserError(f"{path}: is empty; row 1 must name the variables")
    for place, name in enumerate(names, 1):
        variables.find(name, f"{path}: row 1, column {place}")
        if name in names[: place - 1]:
            raise UserError(f"{path}: row 1, column {place}: {name} is there twice")
    items = [items_of(variables.find(name, str(path))) for name in names]
    columns = [array("d") for _ in names]
    for row, cells in rows:
        if len(cells) != len(names):
            raise UserError(f"{path}: row {row}: has {len(cells)} cells where the header has {len(names)}")
        for name, cell, known, column in zip(names, cells, items, columns, strict=True):
            value = variables.value(name, cell, f"{path}: row {row}, column {name}")
            column.append(value if known is None else known[value])
        if len(columns[0]) > MOST_SCENARIOS:
            raise UserError(f"{path}: has more than {MOST_SCENARIOS} rows, the most that a sweep runs")
    if not columns[0]:
        raise UserError(f"{path}: has no row below the header")
    return Scenarios(
        len(columns[0]),
        {
            name: _column_of_numbers(variables, name, np.array(column), known)
            for name, column, known in zip(names, columns, items, strict=True)
        },
    )


def _column_of_numbers(
    variables: Variables, name: str, numbers: np.ndarray, items: Mapping[str, float] | None
) -> Column:
    if items is None:
        return Column(numbers)
    by_number = {value: item for item, value in items.items()}
    used, picks = np.unique(numbers, return_inverse=True)
    return _column(variables, name, [by_number[value] for value in used], picks=picks.astype(np.int32))


def with_fixed(variables: Variables, scenarios: Scenarios, texts: Iterable[str]) -> Scenarios:
    """The scenarios with columns for "NAME=VALUE", the same in all rows."""
    columns = dict(scenarios.columns)
    for text in texts:
        name, value = variables.assigned(text, "--set")
        if name in columns:
            raise UserError(f"--set {name}: is given twice")
        columns[name] = _column(variables, name, [value])
    return Scenarios(scenarios.count, columns)
