"""Values that users write: NAME=VALUE, numbers, the cells of CSV files."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from fmpy.model_description import ModelDescription, ScalarVariable

from frictioncontact.errors import SHOWN, UserError, indefinite, unknown_variable

Value = float | str


def shown(text: str) -> str:
    """Quoted, and cut where it is long."""
    return repr(text if len(text) <= SHOWN else text[:SHOWN] + "...")


def number(text: str, where: str) -> float:
    """A finite number."""
    try:
        value = float(text)
    except ValueError:
        raise UserError(f"{where}: {shown(text)} is not a number") from None
    if not math.isfinite(value):
        raise UserError(f"{where}: {shown(text)} is not a finite number")
    return value


def real(value: Any, where: str) -> float:
    """A number from Python code, which may be NaN or infinite."""
    try:
        if not isinstance(value, str) and not is_bool(value):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise UserError(f"{where} = {shown(str(value))} is not a number")


def path_of(value: Any, where: str) -> Path:
    """A path from Python code."""
    if not isinstance(value, (str, os.PathLike)) or "\0" in str(value):
        raise UserError(f"{where} = {shown(str(value))}: is no path")
    return Path(value)


def is_bool(value: object) -> bool:
    """Python takes it for 0 or 1; where a number is meant, it is a mistake."""
    return isinstance(value, (bool, np.bool_))


def pairs(values: Any, where: str) -> Mapping[Any, Any]:
    """Values by name, from Python code; None is no values."""
    if values is None:
        return {}
    if not isinstance(values, Mapping):
        raise UserError(f"{where} = {shown(str(values))}: must be a mapping of names to values")
    return values


def assignment(text: str, option: str = "") -> tuple[str, str]:
    """Name and value of "NAME=VALUE", as the option takes it."""
    name, equals, rest = text.partition("=")
    if not equals or not rest:
        raise UserError(f"{option} {text}".lstrip() + ": is not of the form NAME=VALUE")
    return name.strip(), rest.strip()


def csv_rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Line number and stripped cells of each row; blank lines and those that begin with # are left out."""
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            reader = csv.reader(file, strict=True)
            for cells in reader:
                if any(cells) and not cells[0].lstrip().startswith("#"):
                    yield reader.line_num, [cell.strip() for cell in cells]
    except OSError as error:
        raise UserError(f"{path}: {error.strerror}") from None
    except (csv.Error, UnicodeDecodeError) as error:
        raise UserError(f"{path}: is not a CSV file in UTF-8: {error}") from None


def items_of(variable: ScalarVariable) -> dict[str, float] | None:
    """Names and numbers of the items of an enumeration."""
    if variable.type != "Enumeration":
        return None
    return {item.name: float(item.value) for item in variable.declaredType.items}


class Variables:
    """The FMU's variables that a user can set."""

    def __init__(self, description: ModelDescription) -> None:
        self._all = {variable.name: variable for variable in description.modelVariables}
        self.settable = [v.name for v in description.modelVariables if v.causality in ("input", "parameter")]

    def find(self, name: str, where: str) -> ScalarVariable:
        if name in self.settable:
            return self._all[name]
        if name in self._all:
            raise UserError(
                f"{where}: {name} is {indefinite(self._all[name].causality)} of the FMU and can't be set"
            )
        raise UserError(f"{where}: {unknown_variable(name, self.settable)}")

    def readable(self, name: str, where: str) -> ScalarVariable:
        """The Real of this name."""
        if name not in self._all:
            raise UserError(f"{where}: {unknown_variable(name, self._all)}")
        if self._all[name].type != "Real":
            raise UserError(f"{where}: {name} is of type {self._all[name].type}; only Real is read")
        return self._all[name]

    def value(self, name: str, text: str, where: str) -> Value:
        """The value that a text stands for, as the named variable takes it. Bounds are left to the FMU."""
        items = items_of(self.find(name, where))
        if items is None:
            return number(text, where)
        if text not in items:
            raise UserError(f"{where}: {shown(text)} is not one of {', '.join(items)}")
        return text

    def given(self, name: str, value: object, where: str) -> Value:
        """A value from Python code: a number, or for an enumeration the name of an item or its number."""
        items = items_of(self.find(name, where))
        if isinstance(value, str) and items is not None:
            return self.value(name, value, f"{where}: {name}")
        try:
            number = float(value)  # type: ignore[arg-type]
        except (TypeError, ValueError, OverflowError):
            number = math.nan
        if isinstance(value, str) or is_bool(value) or not math.isfinite(number):
            raise UserError(f"{where}: {name} = {shown(str(value))} is not a finite number")
        if items is not None and number not in items.values():
            raise UserError(f"{where}: {name} = {number:g} is not one of {', '.join(items)}")
        return number

    def named(self, name: str, value: Value) -> Value:
        """The value; for an enumeration the name of the item that a number stands for."""
        items = items_of(self.find(name, name))
        if items is None or isinstance(value, str):
            return value
        return next(item for item, number in items.items() if number == value)

    def starts(self) -> dict[str, Value]:
        """Start values of all that can be set."""
        return {name: self.named(name, float(self._all[name].start)) for name in self.settable}

    def assigned(self, text: str, option: str) -> tuple[str, Value]:
        """Name and value of "NAME=VALUE"."""
        name, rest = assignment(text, option)
        return name, self.value(name, rest, f"{option} {name}")
