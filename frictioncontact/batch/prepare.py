"""The arguments of `simulate_many`, checked before anything runs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from ..errors import BatchError, shown
from ..tables import in_SI
from ..values import numbers_of, pairs, real
from .columns import common_shape, flat, lengths_of
from .run import Batch
from .runner import STATISTICS
from .unpacked import LoadedFmu

if TYPE_CHECKING:
    import pandas as pd

Statistic = Literal["end", "change", "mean", "min", "max", "samples"]
Output = str | tuple[str, Statistic]
Outputs = Sequence[str] | Mapping[str, Output]
Unit = Literal["period", "s"]
MOST_SAMPLES = 1_000_000


def prepared(
    fmu: LoadedFmu,
    values: Mapping[str, npt.ArrayLike] | pd.DataFrame,
    outputs: Outputs,
    settle: npt.ArrayLike | None,
    duration: npt.ArrayLike,
    samples: int,
    unit: Unit,
    settled: bool,
    inputs: Mapping[str, npt.ArrayLike] | None,
    rates: Mapping[str, npt.ArrayLike] | None,
    steps: npt.ArrayLike | None,
    begin: float,
) -> Batch:
    """The batch of `simulate_many`, checked."""
    lengths = None
    if steps is not None:
        lengths = _row(lengths_of(steps, "steps"), "steps")
        samples = len(lengths)
    if unit not in ("period", "s"):
        raise BatchError(f"unit = {unit!r}: must be 'period' or 's'")
    check_whole(samples, MOST_SAMPLES, "samples =")
    named = in_SI(_named(values), fmu.variables.units(), "column")
    if settle is None:
        settle = 0.0
        settled = settled or (unit == "period" and "initialState" not in named)
    named = _settled(named) if settled else named
    starts = {name: fmu.variables.numbers(name, value, f"column {name}") for name, value in named.items()}
    spans = {"settle": lengths_of(settle, "settle"), "duration": lengths_of(duration, "duration")}
    shape = common_shape(starts | spans, None if isinstance(values, Mapping) else len(values))
    try:
        columns = {name: flat(column, shape) for name, column in (starts | spans).items()}
    except (MemoryError, ValueError):  # more than can be addressed
        raise BatchError(f"no memory for {math.prod(shape)} scenarios") from None
    return Batch(
        fmu,
        shape,
        {name: columns[name] for name in starts},
        columns["settle"],
        columns["duration"],
        int(samples),
        _read(fmu, outputs),
        fmu.variables.all["vibration.f"].valueReference if unit == "period" else None,
        *_moving(fmu, pairs(inputs, "inputs"), pairs(rates, "rates"), int(samples)),
        lengths,
        real(begin, "begin"),
    )


def _moving(
    fmu: LoadedFmu, inputs: Mapping[str, npt.ArrayLike], rates: Mapping[str, npt.ArrayLike], samples: int
) -> tuple[tuple[int, ...], np.ndarray | None, np.ndarray | None]:
    """Value references, values before each step, and rates over it; no rate is 0."""
    for name in rates:
        if name not in inputs:
            raise BatchError(f"rate of {name}: inputs has no values of {name}")
    references, columns, slopes = [], [], []
    for name, values in inputs.items():
        references.append(fmu.variables.find(name, f"input {name}", ("input",)).valueReference)
        columns.append(_of_steps(values, f"input {name}", samples))
        slopes.append(_of_steps(rates.get(name, np.zeros(samples)), f"rate of {name}", samples))
    return (
        tuple(references),
        np.column_stack(columns) if columns else None,
        np.column_stack(slopes) if rates else None,
    )


def _of_steps(values: npt.ArrayLike, where: str, samples: int) -> np.ndarray:
    """A value for each step."""
    row = _row(numbers_of(values, where), where)
    if len(row) != samples:
        raise BatchError(f"{where}: {len(row)} values for {samples} steps")
    return row


def _row(array: np.ndarray, where: str) -> np.ndarray:
    if array.ndim != 1:
        raise BatchError(f"{where}: must be a row of numbers")
    return np.ascontiguousarray(array)


def check_whole(number: object, most: int, where: str) -> None:
    is_whole = isinstance(number, (int, np.integer)) and not isinstance(number, bool)
    if not is_whole or not 1 <= number <= most:
        raise BatchError(f"{where} {number}: must be a whole number from 1 to {most}")


def _named(values: Mapping[str, npt.ArrayLike] | pd.DataFrame) -> Mapping[str, npt.ArrayLike]:
    if isinstance(values, Mapping):
        return values
    if not hasattr(values, "columns"):
        raise BatchError("values: must be a mapping of names to values, or a pandas frame")
    if not values.columns.is_unique:
        name = values.columns[values.columns.duplicated()][0]
        raise BatchError(f"column {name}: is there twice")
    return {name: values[name].array for name in values.columns}


def _settled(named: Mapping[str, npt.ArrayLike]) -> Mapping[str, npt.ArrayLike]:
    if "initialState" in named:
        raise BatchError("column initialState: settled gives it already")
    return {**named, "initialState": "Settled"}


def _pair(output: Output, where: str) -> tuple[str, Statistic]:
    pair = (output, "end") if isinstance(output, str) else output
    if not isinstance(pair, (tuple, list)) or len(pair) != 2 or not isinstance(pair[0], str):
        raise BatchError(f"{where}: {str(output)[:40]} is neither a variable nor (variable, statistic)")
    return pair[0], pair[1]


def _read(fmu: LoadedFmu, outputs: Outputs) -> dict[str, tuple[int, Statistic]]:
    """Name of each result -> value reference and statistic."""
    if isinstance(outputs, str) or not isinstance(outputs, Iterable):
        raise BatchError(f"outputs = {outputs!r}: must be a sequence of names, or a mapping")
    if not isinstance(outputs, Mapping):
        outputs = {fmu.variables.readable(name, "outputs").name: name for name in outputs}
    read = {}
    for name, output in outputs.items():
        variable, statistic = _pair(output, f"output {name}")
        found = fmu.variables.readable(variable, f"output {name}")
        if statistic not in STATISTICS:
            raise BatchError(f"output {name}: {shown(statistic)} is not one of {', '.join(STATISTICS)}")
        if name == "reason":
            raise BatchError(f"output {name}: the name is taken")
        read[name] = found.valueReference, statistic
    return read
