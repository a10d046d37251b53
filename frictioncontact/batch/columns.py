"""Columns of values that a batch sets: brought to one shape before anything runs."""

from collections.abc import Mapping

import numpy as np

from ..errors import BatchError
from ..values import numbers_of, row_of


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


def lengths_of(value: object, where: str) -> np.ndarray:
    """Finite numbers, none below 0."""
    array = numbers_of(value, where)
    if (array < 0.0).any():
        row = int(np.argmax(array < 0.0))
        raise BatchError(f"{where}{row_of(array, row)}: {array.flat[row]:g} must be at least 0")
    return array


def _shape(shape: tuple[int, ...]) -> str:
    return " x ".join(map(str, shape)) or "1"
