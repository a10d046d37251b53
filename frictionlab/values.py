"""Values that users write: NAME=VALUE, numbers, the cells of CSV files."""

from __future__ import annotations

import csv
import difflib
import math
from collections.abc import Iterator
from pathlib import Path

from fmpy.model_description import ModelDescription, ScalarVariable

from frictionlab.project import UserError

Value = float | str
SHOWN = 40  # characters of a wrong value in a message


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
            raise UserError(f"{where}: {name} is an {self._all[name].causality} of the FMU and can't be set")
        close = difflib.get_close_matches(name[:SHOWN], self.settable, 1, 0.5)
        by_case = [known for known in self.settable if known.lower() == name.lower()]
        hint = f"; did you mean {(by_case or close)[0]}?" if by_case or close else ""
        named = name if len(name) <= SHOWN else shown(name)
        raise UserError(f"{where}: {named or 'a variable without a name'} is no variable of the FMU{hint}")

    def value(self, name: str, text: str, where: str) -> Value:
        """The value that a text stands for, as the named variable takes it. Bounds are left to the FMU."""
        items = items_of(self.find(name, where))
        if items is None:
            return number(text, where)
        if text not in items:
            raise UserError(f"{where}: {shown(text)} is not one of {', '.join(items)}")
        return text

    def assigned(self, text: str, option: str) -> tuple[str, Value]:
        """Name and value of "NAME=VALUE"."""
        name, rest = assignment(text, option)
        return name, self.value(name, rest, f"{option} {name}")
