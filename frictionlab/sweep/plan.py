"""What a sweep runs: scenarios as the rows of a table, from a grid, at random, or from a CSV file.

A column is a variable of the FMU that can be set, its values in the units of the model description; an
enumeration's values are the names of its items.
"""

from __future__ import annotations

import csv
import difflib
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from fmpy.model_description import ModelDescription, ScalarVariable, read_model_description

Value = float | str
MOST_SCENARIOS = 10_000_000


class PlanError(ValueError):
    """The sweep that was asked for can't be run; the text is one line that says why."""


class Variables:
    """The FMU's variables that a scenario can set."""

    def __init__(self, fmu: Path) -> None:
        description: ModelDescription = read_model_description(str(fmu), validate=False)
        self._all = {variable.name: variable for variable in description.modelVariables}
        self.settable = [v.name for v in description.modelVariables if v.causality in ("input", "parameter")]

    def find(self, name: str, where: str) -> ScalarVariable:
        if name in self.settable:
            return self._all[name]
        if name in self._all:
            raise PlanError(f"{where}: {name} is an {self._all[name].causality} of the FMU and can't be set")
        close = difflib.get_close_matches(name, self.settable, 1, 0.5)
        by_case = [known for known in self.settable if known.lower() == name.lower()]
        hint = f"; did you mean {(by_case or close)[0]}?" if by_case or close else ""
        raise PlanError(f"{where}: {name or 'a variable without a name'} is no variable of the FMU{hint}")

    def value(self, name: str, text: str, where: str) -> Value:
        """The value that a text stands for, as the named variable takes it. Bounds are left to the FMU."""
        variable = self.find(name, where)
        if variable.type == "Enumeration":
            items = [item.name for item in variable.declaredType.items]
            if text not in items:
                raise PlanError(f"{where}: {text!r} is not one of {', '.join(items)}")
            return text
        return number(text, where)


def number(text: str, where: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise PlanError(f"{where}: {text!r} is not a number") from None
    if not math.isfinite(value):
        raise PlanError(f"{where}: {text!r} is not a finite number")
    return value


def assignment(text: str, option: str) -> tuple[str, str]:
    name, equals, rest = text.partition("=")
    if not equals or not rest:
        raise PlanError(f"{option} {text}: is not of the form NAME=VALUE")
    return name.strip(), rest.strip()


def _bounds(parts: Sequence[str], where: str) -> tuple[float, float, bool]:
    """Lower and upper end of a range, and whether it is logarithmic."""
    low, high = number(parts[0], where), number(parts[1], where)
    logarithmic = parts[-1] == "log"
    if high < low:
        raise PlanError(f"{where}: the range ends at {high:g}, before it begins at {low:g}")
    if logarithmic and low <= 0.0:
        raise PlanError(f"{where}: a logarithmic range must begin above 0, not at {low:g}")
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
        raise PlanError(f"{where}: {rest!r} is neither low:high:count nor low:high:count:log nor a,b,c")
    low, high, logarithmic = _bounds(parts, where)
    if not parts[2].isdigit() or not 1 <= int(parts[2]) <= MOST_SCENARIOS:
        raise PlanError(f"{where}: the count {parts[2]!r} is not a whole number from 1 to {MOST_SCENARIOS}")
    spaced = np.geomspace if logarithmic else np.linspace
    return name, [float(value) for value in spaced(low, high, int(parts[2]))]


def grid(variables: Variables, texts: Iterable[str]) -> pd.DataFrame:
    """Every combination of the values; the last variable changes fastest."""
    axes = dict(_once(grid_values(variables, text) for text in texts))
    count = math.prod(len(values) for values in axes.values())
    if count > MOST_SCENARIOS:
        raise PlanError(f"the grid has {count} scenarios; the most that a sweep runs is {MOST_SCENARIOS}")
    return pd.MultiIndex.from_product(axes.values(), names=list(axes)).to_frame(index=False)


def _once(columns: Iterable[tuple[str, object]]) -> Iterable[tuple[str, object]]:
    seen = set()
    for name, values in columns:
        if name in seen:
            raise PlanError(f"--vary {name}: is given twice")
        seen.add(name)
        yield name, values


def random(variables: Variables, texts: Iterable[str], count: int, seed: int) -> pd.DataFrame:
    """count rows, each value drawn by itself from "NAME=low:high", "NAME=low:high:log" or "NAME=a,b,c"."""
    generator = np.random.default_rng(seed)

    def column(text: str) -> tuple[str, object]:
        name, rest = assignment(text, "--vary")
        where = f"--vary {name}"
        variables.find(name, where)
        parts = rest.split(":")
        if len(parts) == 1:
            values = [variables.value(name, item.strip(), where) for item in rest.split(",")]
            return name, generator.choice(np.array(values, dtype=object), count)
        if len(parts) > 3 or (len(parts) == 3 and parts[2] != "log"):
            raise PlanError(
                f"{where}: {rest!r} is neither low:high nor low:high:log nor a,b,c (with --random)"
            )
        low, high, logarithmic = _bounds(parts, where)
        if logarithmic:
            return name, np.exp(generator.uniform(math.log(low), math.log(high), count))
        return name, generator.uniform(low, high, count)

    return pd.DataFrame(dict(_once(column(text) for text in texts))).infer_objects()


def from_csv(variables: Variables, path: Path) -> pd.DataFrame:
    """A header with names of variables, then one scenario a row.

    Errors name row (the header is 1) and column.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            rows = list(csv.reader(file, strict=True))
    except OSError as error:
        raise PlanError(f"{path}: {error.strerror}") from None
    except (csv.Error, UnicodeDecodeError) as error:
        raise PlanError(f"{path}: is not a CSV file: {error}") from None
    if not rows or not rows[0]:
        raise PlanError(f"{path}: is empty; row 1 must name the variables")
    names = [name.strip() for name in rows[0]]
    for number_of_column, name in enumerate(names, 1):
        variables.find(name, f"{path}: row 1, column {number_of_column}")
        if name in names[: number_of_column - 1]:
            raise PlanError(f"{path}: row 1, column {number_of_column}: {name} is there twice")
    table = []
    for row, cells in enumerate(rows[1:], 2):
        if not cells:
            continue
        if len(cells) != len(names):
            raise PlanError(f"{path}: row {row}: has {len(cells)} cells where the header has {len(names)}")
        table.append(
            [
                variables.value(name, cell.strip(), f"{path}: row {row}, column {name}")
                for name, cell in zip(names, cells, strict=True)
            ]
        )
    if not table:
        raise PlanError(f"{path}: has no row below the header")
    return pd.DataFrame(table, columns=names)


def with_fixed(variables: Variables, scenarios: pd.DataFrame, texts: Iterable[str]) -> pd.DataFrame:
    """The scenarios with columns for "NAME=VALUE", the same in all rows."""
    fixed: dict[str, Value] = {}
    for text in texts:
        name, rest = assignment(text, "--set")
        if name in fixed or name in scenarios:
            raise PlanError(f"--set {name}: is given twice")
        fixed[name] = variables.value(name, rest, f"--set {name}")
    return scenarios.assign(**fixed)


def records(scenarios: pd.DataFrame) -> list[Mapping[str, Value]]:
    return scenarios.to_dict("records")
