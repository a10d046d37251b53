"""Columns of values that a batch sets: checked and brought to one shape before anything runs."""

from __future__ import annotations

import math
import numbers
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from .errors import BatchError

if TYPE_CHECKING:
    from fmpy.model_description import ScalarVariable

    from .unpacked import LoadedFmu

SETTABLE = ("input", "parameter")


def start_values(fmu: LoadedFmu, values: Mapping[str, object]) -> dict[str, np.ndarray]:
    """Each column as doubles of its own shape; an item of an enumeration becomes its number.

    BatchError names column and row (counted from 0; of an array of more dimensions its indices).
    """
    columns = {}
    for name, value in values.items():
        variable = fmu.variable(str(name), f"column {name}", SETTABLE)
        columns[name] = _numbers(variable, _cells(value, f"column {name}"), f"column {name}")
    return columns


def common_shape(columns: Mapping[str, np.ndarray], rows: int | None = None) -> tuple[int, ...]:
    """What the columns broadcast to: the rows of a frame, where there is one."""
    shape: tuple[int, ...] = () if rows is None else (rows,)
    for name, column in columns.items():
        try:
            wider = np.broadcast_shapes(shape, column.shape)
        except ValueError:
            wider = None
        if wider is None or (rows is not None and wider != (rows,)):
            those = f"{_shape(shape)} of those before it" if rows is None else f"{rows} rows of the frame"
            raise BatchError(f"column {name}: its {_shape(column.shape)} values do not go with the {those}")
        shape = wider
    return shape


def flat(array: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """One value where there is one for all, else all of them in the order of the shape."""
    if array.size == 1:
        return np.ascontiguousarray(array.reshape(1), dtype=float)
    return np.ascontiguousarray(np.broadcast_to(array, shape), dtype=float).reshape(-1)


def numbers_of(value: object, where: str, least: float = -math.inf) -> np.ndarray:
    """Finite numbers, none below the least."""
    array = _numbers(None, _cells(value, where), where)
    if (array < least).any():
        row = np.argmax(array < least)
        raise BatchError(f"{where}{_row(array, row)}: {array.flat[row]:g} must be at least {least:g}")
    return array


def _cells(value: object, where: str) -> np.ndarray:
    if isinstance(value, np.ma.MaskedArray) and value.mask.any():
        raise BatchError(f"{where}{_row(value.mask, int(np.argmax(value.mask)))}: is masked")
    try:
        return np.asarray(value)
    except ValueError:
        raise BatchError(f"{where}: its rows are not of one length") from None


def _shape(shape: tuple[int, ...]) -> str:
    return " x ".join(map(str, shape)) or "1"


def _row(array: np.ndarray, flat_index: int) -> str:
    if array.ndim == 0:
        return ""
    index = [int(i) for i in np.unravel_index(flat_index, array.shape)]
    return f", row {index[0] if len(index) == 1 else tuple(index)}"


def _numbers(variable: ScalarVariable | None, array: np.ndarray, where: str) -> np.ndarray:
    items = {}
    if variable is not None and variable.type == "Enumeration":
        items = {item.name: float(item.value) for item in variable.declaredType.items}
    if array.dtype.kind not in "fiu":
        known: dict[object, float] = {}
        numeric = np.empty(array.shape)
        for row, cell in enumerate(array.flat):
            try:
                number = known[cell]
            except (KeyError, TypeError):
                number = _number(cell, items, f"{where}{_row(array, row)}")
                known[cell] = number
            numeric.flat[row] = number
        array = numeric
    array = array.astype(float, copy=False)
    if array.ndim == 0 and _is_good(variable, float(array)):
        return array
    good = np.isfinite(array)
    if variable is not None and variable.type != "Real":
        with np.errstate(invalid="ignore"):
            good &= (array == np.rint(array)) & (np.abs(array) < 2**31)
    if not good.all():
        row = int(np.argmin(good))
        kind = "a finite number" if not math.isfinite(array.flat[row]) else "a whole number"
        hint = f" or one of {', '.join(items)}" if items else ""
        raise BatchError(f"{where}{_row(array, row)}: {array.flat[row]:g} is not {kind}{hint}")
    return array


def _is_good(variable: ScalarVariable | None, value: float) -> bool:
    is_whole = value.is_integer() and abs(value) < 2**31
    return is_whole or (math.isfinite(value) and (variable is None or variable.type == "Real"))


def _number(cell: object, items: Mapping[str, float], where: str) -> float:
    if isinstance(cell, str) and items:
        if cell not in items:
            raise BatchError(f"{where}: {cell[:40]!r} is not one of {', '.join(items)}")
        return items[cell]
    if isinstance(cell, numbers.Real) and not isinstance(cell, (bool, np.timedelta64)):
        try:
            return float(cell)
        except OverflowError:
            raise BatchError(f"{where}: is beyond the largest number") from None
    raise BatchError(f"{where}: {str(cell)[:40]!r} is not a number")
