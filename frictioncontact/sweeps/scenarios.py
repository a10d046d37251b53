"""What a sweep runs: the rows of a table that is never held whole, from a grid, at random, or of a CSV file.

A column is a variable of the FMU that can be set, its values in the units of the model description. Those of
an enumeration go by the names of its items. A row depends on its number alone, and is made where needed.
"""

from __future__ import annotations

import hashlib
import math
from array import array
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa

from frictioncontact.errors import UserError
from frictioncontact.values import Value, Variables, csv_rows, items_of, number, shown

MOST_SCENARIOS = 1_000_000_000
DRAWS = 4  # that one step of Philox's counter gives


@dataclass(frozen=True)
class Listed:
    """Numbers one by one."""

    numbers: np.ndarray

    def __len__(self) -> int:
        return len(self.numbers)

    def at(self, index: np.ndarray) -> np.ndarray:
        return self.numbers[index]

    def drawn(self, u: np.ndarray) -> np.ndarray:
        """u is evenly spread over [0, 1)."""
        return self.numbers[(u * len(self.numbers)).astype(np.intp)]


@dataclass(frozen=True)
class Range:
    """So many numbers from low to high, both included; of a random sweep any number between."""

    low: float
    high: float
    logarithmic: bool
    count: int

    def __len__(self) -> int:
        return self.count

    def at(self, index: np.ndarray) -> np.ndarray:
        return self.drawn(index / max(1, self.count - 1))

    def drawn(self, u: np.ndarray) -> np.ndarray:
        if self.logarithmic:
            values = np.exp((1.0 - u) * math.log(self.low) + u * math.log(self.high))
        else:
            values = (1.0 - u) * self.low + u * self.high
        inner = np.clip(values, self.low, self.high)
        return np.where(u <= 0.0, self.low, np.where(u < 1.0, inner, self.high))


@dataclass(frozen=True)
class Column:
    """One variable: scenario k has value (k // repeat) modulo their number, or draw k of a seed's stream."""

    values: Listed | Range
    items: Mapping[str, float] | None  # of an enumeration
    repeat: int = 1
    stream: tuple[int, int] | None = None  # seed, and number of the stream

    def rows(self, first: int, stop: int) -> np.ndarray:
        """Numbers of these scenarios."""
        if self.stream is None:
            return self.values.at(np.arange(first, stop) // self.repeat % len(self.values))
        return self.values.drawn(uniform(*self.stream, first, stop))

    def shown(self, rows: np.ndarray) -> pa.Array:
        """The same as results show them: items by name."""
        if self.items is None:
            return pa.array(rows)
        names = sorted(self.items, key=self.items.__getitem__)
        return pa.array(names).take(pa.array(np.searchsorted([self.items[name] for name in names], rows)))


def uniform(seed: int, stream: int, first: int, stop: int) -> np.ndarray:
    """Draws first to stop - 1 of a stream, over [0, 1): each has its value whatever is drawn with it.

    Philox counts instead of iterating (Salmon et al., SC 2011, doi:10.1145/2063384.2063405).
    """
    philox = np.random.Philox(np.random.SeedSequence(seed, spawn_key=(stream,)))
    philox.advance(first // DRAWS)
    skipped = first % DRAWS
    return np.random.Generator(philox).random(skipped + stop - first)[skipped:]


@dataclass(frozen=True)
class Scenarios:
    """So many scenarios of named columns."""

    count: int
    columns: dict[str, Column]

    def digest(self) -> str:
        """Equal for equal scenarios in the same order."""
        state = hashlib.sha256(str(self.count).encode())
        for name, column in self.columns.items():
            listed = column.values.numbers if isinstance(column.values, Listed) else None
            spread = column.values if listed is None else len(listed)
            state.update(repr((name, column.repeat, column.stream, spread)).encode())
            state.update(b"" if listed is None else listed.tobytes())
        return state.hexdigest()


def _values(variables: Variables, name: str, given: str | Iterable[Value], random: bool) -> Listed | Range:
    """Of "a,b,c", an iterable of values, "low:high:count[:log]" or, if random, "low:high[:log]"."""
    where = f"--vary {name}"
    items = items_of(variables.find(name, where))
    parts = given.split(":") if isinstance(given, str) else []
    if len(parts) < 2:
        texts = given.split(",") if isinstance(given, str) else map(str, given)
        values = [variables.value(name, text.strip(), where) for text in texts]
        if not values:
            raise UserError(f"{where}: has no values")
        return Listed(np.array(values if items is None else [items[value] for value in values], dtype=float))
    if items is not None:
        raise UserError(f"{where}: {shown(given)} is a range, but its values are names: {','.join(items)}")
    logarithmic = parts[-1] == "log"
    form = "low:high" if random else "low:high:count"
    if len(parts) - logarithmic != form.count(":") + 1:
        end = " (with --random)" if random else ""
        raise UserError(f"{where}: {shown(given)} is neither {form} nor {form}:log nor a,b,c{end}")
    low, high = number(parts[0], where), number(parts[1], where)
    if high < low:
        raise UserError(f"{where}: the range ends at {high:g}, before it begins at {low:g}")
    if logarithmic and low <= 0.0:
        raise UserError(f"{where}: a logarithmic range must begin above 0, not at {low:g}")
    return Range(low, high, logarithmic, 1 if random else _count(parts[2], where))


def _count(text: str, where: str) -> int:
    is_whole = text.isascii() and text.isdecimal() and len(text) <= len(str(MOST_SCENARIOS))
    if not is_whole or not 1 <= int(text) <= MOST_SCENARIOS:
        raise UserError(f"{where}: the count {shown(text)} is not a whole number from 1 to {MOST_SCENARIOS}")
    return int(text)


def drawn(
    variables: Variables, vary: Mapping[str, str | Iterable[Value]], count: int, seed: int
) -> Scenarios:
    """count rows, each value drawn by itself."""
    columns = {}
    for stream, (name, given) in enumerate(vary.items()):
        values = _values(variables, name, given, random=True)
        columns[name] = Column(values, items_of(variables.find(name, name)), stream=(seed, stream))
    return Scenarios(count, columns)


def grid(variables: Variables, vary: Mapping[str, str | Iterable[Value]]) -> Scenarios:
    """Every combination of the values; the last variable changes fastest."""
    axes = {name: _values(variables, name, given, random=False) for name, given in vary.items()}
    count = repeat = math.prod(map(len, axes.values()))
    if count > MOST_SCENARIOS:
        raise UserError(f"the grid has {count} scenarios; the most that a sweep runs is {MOST_SCENARIOS}")
    columns = {}
    for name, values in axes.items():
        repeat //= len(values)
        columns[name] = Column(values, items_of(variables.find(name, name)), repeat)
    return Scenarios(count, columns)


def from_csv(variables: Variables, path: Path) -> Scenarios:
    """A header with names of variables, then a scenario a row. Errors name row, from 1, and column."""
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
    listed = {name: Listed(np.array(column)) for name, column in zip(names, columns, strict=True)}
    known = dict(zip(names, items, strict=True))
    return Scenarios(len(columns[0]), {name: Column(values, known[name]) for name, values in listed.items()})


def with_fixed(variables: Variables, scenarios: Scenarios, fixed: Mapping[str, Value]) -> Scenarios:
    """The scenarios with columns of one value each."""
    columns = dict(scenarios.columns)
    for name, given in fixed.items():
        if name in columns:
            raise UserError(f"--set {name}: is given twice")
        items = items_of(variables.find(name, f"--set {name}"))
        value = variables.value(name, str(given), f"--set {name}")
        columns[name] = Column(Listed(np.array([value if items is None else items[value]])), items)
    return Scenarios(scenarios.count, columns)
