"""Is this a value of that variable? The one answer, for Python, command lines and CSV files."""

import math
import numbers
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from fmpy.model_description import ModelDescription, ScalarVariable

from frictioncontact.errors import UserError, indefinite, shown, unknown_variable

Value = float | str
SETTABLE = ("input", "parameter")
LARGEST = 1e50  # of a table: differences and squares are finite; and of a value without a bound


def _plain(text: str) -> float:
    """A number without what Python alone takes for digits; ValueError if it is none."""
    if "_" in text or not text.isascii():
        raise ValueError(text)
    return float(text)


def number(text: str, where: str) -> float:
    """A finite number."""
    try:
        value = _plain(text)
    except ValueError:
        raise UserError(f"{where}: {shown(text)} is not a number{_hint(text)}") from None
    if not math.isfinite(value):
        raise UserError(f"{where}: {shown(text)} is not a finite number")
    return value


def _hint(text: str) -> str:
    """What to write instead of a decimal comma, or of a number with a unit."""
    text = text.strip("'")
    if re.fullmatch(r"[-+]?\d*,\d+(e[-+]?\d+)?", text, re.IGNORECASE):
        return f"; write {text.replace(',', '.')}"
    return "; write the number alone, in SI units" if re.match(r"[-+]?[\d.]+ ?[a-zA-Z%]", text) else ""


def real(value: Any, where: str) -> float:
    """A number from Python code, which may be NaN or infinite."""
    try:
        if not isinstance(value, (str, bool, np.bool_)):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise UserError(f"{where} = {shown(value)} is not a number")


def check_whole(value: Any, most: int, where: str) -> int:
    is_whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not is_whole or not 1 <= value <= most:
        raise UserError(f"{where} {value}: must be a whole number from 1 to {most}")
    return int(value)


def path_of(value: Any, where: str) -> Path:
    """A path from Python code."""
    if not isinstance(value, (str, os.PathLike)) or "\0" in str(value):
        raise UserError(f"{where} = {shown(value)}: is no path")
    return Path(value)


def pairs(values: Any, where: str) -> Mapping[Any, Any]:
    """Values by name, from Python code; None is no values."""
    if values is None:
        return {}
    if not isinstance(values, Mapping):
        hint = "; it has one, .start" if hasattr(values, "start") else ""
        raise UserError(f"{where} = {shown(values)}: must be a mapping of names to values{hint}")
    return values


def assignments(texts: Sequence[str], option: str) -> dict[str, str]:
    """Names and values of several NAME=VALUE, as an option takes them."""
    values: dict[str, str] = {}
    for text in texts:
        name, _, value = (part.strip() for part in text.partition("="))
        if not name or not value:
            raise UserError(f"{option} {text}: is not of the form NAME=VALUE")
        if name in values:
            raise UserError(f"{option} {name}: is given twice")
        values[name] = value
    return values


def numbers_of(value: object, where: str, items: Mapping[str, float] | None = None) -> np.ndarray:
    """Finite doubles of the value's own shape; of an enumeration the numbers of its items.

    The value is a number, an item's name, or an array of them. UserError names the place and the row, counted
    from 0; of an array of more dimensions its indices.
    """
    array = _cells(value, where)
    if array.dtype.kind not in "fiu":
        array = _each(array, where, items or {})
    array = array.astype(float, copy=False)
    if array.ndim == 0 and not items and math.isfinite(array):
        return array
    good = np.isin(array, list(items.values())) if items else np.isfinite(array)
    if not good.all():
        row = int(np.argmin(good))
        raise UserError(
            f"{where}{row_of(array, row)}: {_wanted(f'{array.flat[row]:g}', items or {}, 'finite number')}"
        )
    return array


def _cells(value: object, where: str) -> np.ndarray:
    if isinstance(value, np.ma.MaskedArray) and value.mask.any():
        raise UserError(f"{where}{row_of(value.mask, int(np.argmax(value.mask)))}: is masked")
    try:
        return np.asarray(value)
    except ValueError:
        raise UserError(f"{where}: its rows are not of one length") from None


def _each(array: np.ndarray, where: str, items: Mapping[str, float]) -> np.ndarray:
    """The doubles of an array whose cells are not all numbers."""
    numeric, known = np.empty(array.shape), dict[object, float]()
    for row, cell in enumerate(array.flat):
        try:
            if cell not in known:
                known[cell] = _number(cell, items)
            numeric.flat[row] = known[cell]
        except TypeError:  # neither number nor text
            raise UserError(f"{where}{row_of(array, row)}: {_wanted(shown(cell), items, 'number')}") from None
        except OverflowError:
            raise UserError(f"{where}{row_of(array, row)}: {shown(cell)} is not a finite number") from None
    return numeric


def _number(cell: object, items: Mapping[str, float]) -> float:
    if isinstance(cell, str) and cell in items:
        return items[cell]
    if isinstance(cell, numbers.Real) and not isinstance(cell, (bool, np.timedelta64)):
        return float(cell)
    raise TypeError


def row_of(array: np.ndarray, flat_index: int) -> str:
    """ ", row 3" of an array's cell, as errors name it; nothing of a single value."""
    if array.ndim == 0:
        return ""
    index = [int(i) for i in np.unravel_index(flat_index, array.shape)]
    return f", row {index[0] if len(index) == 1 else tuple(index)}"


def _wanted(given: str, items: Mapping[str, float], kind: str) -> str:
    """What is wrong with a value."""
    if not items:
        return f"{given} is not a {kind}{_hint(given)}"
    return f"{given} is not one of {', '.join(items)}, nor a number from 1 to {len(items)}"


class Variables:
    """The variables of the FMU."""

    def __init__(self, description: ModelDescription) -> None:
        self.all = {variable.name: variable for variable in description.modelVariables}
        self.settable = [name for name, variable in self.all.items() if variable.causality in SETTABLE]
        self.inputs = [name for name, variable in self.all.items() if variable.causality == "input"]
        self.items = {  # of an enumeration: names and numbers; of a Real none
            name: {item.name: float(item.value) for item in variable.declaredType.items}
            if variable.type == "Enumeration"
            else {}
            for name, variable in self.all.items()
        }
        self.factors = {  # of a unit and another that it is shown in
            (unit.name, display.name): display.factor
            for unit in description.unitDefinitions
            for display in unit.displayUnits
        }

    def units(self, causalities: Sequence[str] = SETTABLE) -> dict[str, str]:
        """Those of the variables of a causality."""
        return {n: each.unit or "1" for n, each in self.all.items() if each.causality in causalities}

    def find(self, name: object, where: str, causalities: Sequence[str] = SETTABLE) -> ScalarVariable:
        """The variable of this name that can be set."""
        found = self.all.get(name) if isinstance(name, str) else None
        if found is not None and found.causality in causalities:
            return found
        names = [each for each, other in self.all.items() if other.causality in causalities]
        if found is None:
            raise UserError(f"{where}: {unknown_variable(str(name), names)}")
        those = " and can't be set" if causalities == SETTABLE else f", not one of {', '.join(names)}"
        raise UserError(f"{where}: {name} is {indefinite(found.causality)} of the FMU{those}")

    def readable(self, name: object, where: str) -> ScalarVariable:
        """The Real of this name."""
        found = self.all.get(name) if isinstance(name, str) else None
        if found is None:
            raise UserError(f"{where}: {unknown_variable(str(name), self.all)}")
        if found.type != "Real":
            raise UserError(f"{where}: {name} is of type {found.type}; only Real is read")
        return found

    def numbers(self, name: object, value: object, where: str) -> np.ndarray:
        """The doubles that a value or an array of values stands for."""
        return numbers_of(value, where, self.items[self.find(name, where).name])

    def number(self, name: object, value: object, where: str) -> float:
        """The double that one value stands for. Bounds are left to the FMU."""
        found = self.numbers(name, value, where)
        if found.ndim:
            raise UserError(f"{where}: {shown(value)} is not one value")
        return float(found)

    def value(self, name: object, value: object, where: str) -> Value:
        """One value: a number, or of an enumeration the item's name."""
        return self.named(str(name), self.number(name, value, where))

    def named(self, name: str, number: float) -> Value:
        """The number; of an enumeration the item's name."""
        return next((item for item, each in self.items[name].items() if each == number), number)

    def values(self, given: Any, where: str) -> dict[str, Value]:
        """A mapping from Python code, as values."""
        return {
            name: self.value(name, value, f"{where}: {name}" if name in self.settable else where)
            for name, value in pairs(given, where).items()
        }

    def text(self, name: str, text: str, where: str) -> Value:
        """The value that a text stands for."""
        try:
            number: Value = _plain(text)
        except ValueError:
            number = text
        return self.value(name, number, where)

    def assigned(self, texts: Sequence[str], option: str = "--set") -> dict[str, Value]:
        """The values of several NAME=VALUE of an option."""
        pairs = assignments(texts, option).items()
        return {name: self.text(name, text, f"{option} {name}") for name, text in pairs}

    def starts(self) -> dict[str, Value]:
        """Start values of all that can be set."""
        return {name: self.named(name, float(self.all[name].start)) for name in self.settable}
