"""Inputs that users give as samples in time, as the FMU takes them: a value and a rate for every step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frictioncontact.errors import UserError, warn
from frictioncontact.tables import OWN, POSITION, SUFFIX, TIME
from frictioncontact.tables import table as read

if TYPE_CHECKING:
    from frictioncontact.tables import Source
    from frictioncontact.values import Variables

FAR = 1e300  # s, before and after every sample


@dataclass(frozen=True)
class Samples:
    """Inputs that are linear between their samples, and held before the first and after the last.

    Two samples at one time are a jump.
    """

    time: np.ndarray  # s, never falling
    values: dict[str, np.ndarray]

    def preceded(self, part: float, zero: float) -> Samples:
        """The same, with a velocity before the first sample that is a part of its own; times from zero on."""
        values = {name: np.concatenate([each[:1], each]) for name, each in self.values.items()}
        values["V"][0] *= part
        return Samples(np.concatenate([self.time[:1], self.time]) - zero, values)

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


def moving(time: np.ndarray, values: Mapping[str, np.ndarray], position: np.ndarray | None = None) -> Samples:
    """Samples of the inputs; of a position its velocity, which between two samples is linear.

    Each piece goes as far as the position, and not to and fro.
    """
    if position is None:
        return Samples(time, dict(values))
    steps = np.diff(time)
    mean, V = np.diff(position) / steps, np.gradient(position, time, edge_order=min(2, len(steps)))
    half = np.clip(0.5 * np.diff(V), -np.abs(mean), np.abs(mean))
    pieces = {name: np.repeat(each, 2)[1:-1] for name, each in values.items()}
    return Samples(
        np.repeat(time, 2)[1:-1], {**pieces, "V": np.column_stack([mean - half, mean + half]).ravel()}
    )


def samples(
    source: Source, known: Variables, stop: float | None = None, columns: Mapping[str, str] | None = None
) -> Samples:
    """The samples of a table with a column time and any inputs, or position; UserError if it is wrong.

    What was measured is left out. stop [s]: warns of samples beyond it. columns: headings of other names.
    """
    units = known.units(("input",))
    names = ", ".join(units)
    measured = {f"{name}{SUFFIX}": unit for name, unit in OWN.items()}
    table = read(source, "inputs", {**units, **OWN, **measured}, "input of the FMU", columns)
    found = {name: each for name, each in table.numbers().items() if name in (*units, TIME, POSITION)}
    where = table.where
    if TIME not in found or len(found) < 2:
        raise UserError(f"{where}: needs a column time [s] and at least one of {names}, {POSITION}")
    time, position = found.pop(TIME), found.pop(POSITION, None)
    if not len(time):
        raise UserError(f"{where}: no samples")
    backward = np.flatnonzero(np.diff(time) < 0.0)
    if len(backward):
        k = int(backward[0])
        raise UserError(f"{where}: time falls from {time[k]:g} to {time[k + 1]:g} s at sample {k + 1}")
    beyond = 0 if stop is None else int(np.sum(time > stop * (1.0 + 1e-9)))
    if beyond:
        late = f"{beyond} of {len(time)} samples are after stop = {stop:g} s"
        warn([f"{where}: {late}; the last is at {time[-1]:g} s"])
    if position is None:
        return Samples(time, found)
    if "V" in found or len(time) < 2 or (np.diff(time) <= 0.0).any():
        raise UserError(f"{where}: position needs two samples, a time that grows, and no V beside it")
    pieces = moving(time, found, position)
    ends = {name: np.concatenate([each[:1], each, each[-1:]]) for name, each in pieces.values.items()}
    ends["V"][[0, -1]] = 0.0  # it rests outside of its samples
    return Samples(np.concatenate([time[:1], pieces.time, time[-1:]]), ends)
