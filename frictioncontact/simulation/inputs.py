"""Inputs that users give as samples in time, as the FMU takes them: a value and a rate for every step."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from frictioncontact.errors import UserError, did_you_mean, shown
from frictioncontact.values import LARGEST, numbers_of

if TYPE_CHECKING:
    import pandas as pd


FAR = 1e300  # s, before and after every sample


@dataclass(frozen=True)
class Samples:
    """Inputs that are linear between their samples, and held before the first and after the last.

    Two samples at one time are a jump.
    """

    time: np.ndarray  # s, never falling
    values: dict[str, np.ndarray]

    def steps(self, ends: np.ndarray) -> np.ndarray:
        """Times [s] from 0 at which a step has to end: the given ends, and the samples between them.

        A sample nearer to an end than 1e-9 of the shortest step counts as there.
        """
        near = 1e-9 * np.diff(ends, prepend=0.0).min()
        inner = np.unique(self.time[(self.time > near) & (self.time < ends[-1])])
        after = ends[np.searchsorted(ends, inner)]
        before = np.concatenate([[0.0], ends])[np.searchsorted(ends, inner)]
        return np.union1d(ends, inner[(after - inner > near) & (inner - before > near)])

    def over(self, begins: np.ndarray, ends: np.ndarray) -> tuple[dict[str, np.ndarray], ...]:
        """Value at the begin of each step and rate over it, per input, where no sample is inside a step."""
        time = np.concatenate([[-FAR], self.time, [FAR]])
        right = np.searchsorted(time, 0.5 * (begins + ends))
        left = right - 1
        values, rates = {}, {}
        for name, samples in self.values.items():
            padded = np.concatenate([samples[:1], samples, samples[-1:]])
            rates[name] = (padded[right] - padded[left]) / (time[right] - time[left])
            values[name] = padded[left] + rates[name] * (begins - time[left])
        return values, rates


def samples(table: Mapping[str, npt.ArrayLike] | pd.DataFrame, names: Sequence[str]) -> Samples:
    """The samples of a table with a column time [s] and any of the named inputs; UserError if it is wrong."""
    if not isinstance(table, Mapping) and not hasattr(table, "columns"):
        hint = "; pandas.read_csv reads a file" if isinstance(table, (str, os.PathLike)) else ""
        raise UserError(
            f"inputs = {shown(table)}: must be a mapping of names to samples, or a pandas frame{hint}"
        )
    columns = {str(name): table[name] for name in table}
    for name in columns:
        if name not in ("time", *names):
            hint = did_you_mean(name, names) or ";"
            raise UserError(f"inputs: {name} is no input of the FMU{hint} these are: {', '.join(names)}")
    if "time" not in columns or len(columns) < 2:
        raise UserError(f"inputs: needs a column time [s] and at least one of {', '.join(names)}")
    arrays = {name: _numbers(name, column) for name, column in columns.items()}
    time = arrays.pop("time")
    for name, array in arrays.items():
        if len(array) != len(time):
            raise UserError(f"inputs: {name} has {len(array)} values and time has {len(time)}")
    if not len(time):
        raise UserError("inputs: no samples")
    backward = np.flatnonzero(np.diff(time) < 0.0)
    if len(backward):
        k = int(backward[0])
        raise UserError(f"inputs: time falls from {time[k]:g} to {time[k + 1]:g} s at sample {k + 1}")
    return Samples(time, arrays)


def _numbers(name: str, column: npt.ArrayLike) -> np.ndarray:
    array = numbers_of(column, f"inputs: {name}")
    if array.ndim != 1:
        raise UserError(f"inputs: {name} is not a row of numbers")
    if (abs(array) > LARGEST).any():
        k = int(np.argmax(abs(array)))
        raise UserError(f"inputs: {name}, row {k}: {array[k]:g} must be from {-LARGEST:g} to {LARGEST:g}")
    return array
