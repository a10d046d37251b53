"""The measurements and the FMU's answer to a set of parameters: what the fits ask for forces.

A point has a coordinate for each fitted parameter, and after them one for each nuisance: something else
that is not known exactly, in standard deviations where it was measured (then its own residual holds it to
what was measured), or in its unit where it is free.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from frictionlab.batch import simulate_many
from frictionlab.batch.columns import flat
from frictionlab.batch.many import built_runner, processors
from frictionlab.batch.prepare import prepared
from frictionlab.batch.run import Batch
from frictionlab.batch.runner import runner
from frictionlab.batch.unpacked import loaded_fmu
from frictionlab.fmu import FrictionError, FrictionFmu
from frictionlab.identify.data import Measurements
from frictionlab.identify.parameter import Parameter

TOLERANCE = 1e-6  # of the FMU's solver: far below what differences of forces over DIFFERENCE need
TIGHT = 1e-10  # where a fit ends
DIFFERENCE = 1e-3  # of a coordinate
NUISANCE_DIFFERENCE = 1e-2  # of a nuisance's


@dataclass(frozen=True)
class Nuisance:
    start: float
    measured: bool  # has a residual of its own
    row: int | None = None  # the only row that depends on it


class Experiment(ABC):
    """Forces of points, their residuals and derivatives."""

    word = "row"  # what one measured force is called

    def __init__(
        self,
        fmu: FrictionFmu,
        parameters: Sequence[Parameter],
        force: Sequence[float],
        uncertainty: Sequence[float] | None,
        nuisances: Sequence[Nuisance] = (),
    ) -> None:
        self.fmu, self.parameters, self.nuisances = fmu, tuple(parameters), tuple(nuisances)
        self.force = np.array(force)
        self.known = uncertainty is not None
        self.weight = 1.0 / np.array(uncertainty) if self.known else np.ones(len(self.force))
        free = [math.inf] * len(self.nuisances)
        self.low = np.array([p.to_coordinate(p.low) for p in self.parameters] + [-v for v in free])
        self.high = np.array([p.to_coordinate(p.high) for p in self.parameters] + free)
        self.problem = "no start value works"  # the FMU's last refusal
        self._measured = [k for k, one in enumerate(self.nuisances) if one.measured]
        self._shifts = self._all_shifts()
        self._places = self._all_places()
        self._lead = np.argmax(self._shifts > 0.0, axis=1)  # a coordinate that each moves
        self._lengths = self._shifts.max(axis=1)

    @abstractmethod
    def forces(self, points: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        """[point, row] in N; nan in a row of points that the FMU refuses, and then self.problem says why."""

    @abstractmethod
    def kappa(self, point: np.ndarray) -> np.ndarray | None:
        """sigma V_1 / (2 pi f F) of every row, F the limit, at the mean separation; None of a series."""

    @property
    def target(self) -> np.ndarray:
        """What was measured: forces [N], and zero for every nuisance that was."""
        return np.concatenate([self.force, np.zeros(len(self._measured))])

    @property
    def degrees(self) -> int:
        """Forces minus what is free."""
        free = len(self.nuisances) - len(self._measured)
        return len(self.force) - len(self.parameters) - free

    def start(self, coordinates: Sequence[float]) -> np.ndarray:
        """The point of these parameters with the nuisances where they start."""
        return np.concatenate([coordinates, [one.start for one in self.nuisances]])

    def means(self, coordinates: Sequence[float]) -> np.ndarray:
        """Forces [N] at the parameters' coordinates. FrictionError with the FMU's refusal."""
        found = self.forces(self.start(coordinates)[None, :])[0]
        if np.isnan(found).any():
            raise FrictionError(self.problem)
        return found

    def at(self, x: np.ndarray, targets: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        """Residuals of points, [point, residual]: of forces and of measured nuisances."""
        return self._residuals(x, self.forces(x, tolerance), targets)

    def _residuals(self, x: np.ndarray, forces: np.ndarray, targets: np.ndarray) -> np.ndarray:
        rows = len(self.force)
        own = x[:, len(self.parameters) :][:, self._measured] - targets[:, rows:]
        return np.hstack([(forces - targets[:, :rows]) * self.weight, own])

    def with_slopes(
        self, x: np.ndarray, targets: np.ndarray, tolerance: float = TOLERANCE, central: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """Residuals and their derivatives, [point, residual, coordinate], from one batch.

        By differences to one side, or to both; nuisances of single rows are shifted together.
        """
        inward = np.where(x + DIFFERENCE > self.high, -1.0, 1.0)
        here, slopes = self._slopes(x, inward, tolerance)
        if central:
            back = self._slopes(x, -inward, tolerance)[1]
            slopes = 0.5 * (np.where(np.isnan(slopes), back, slopes) + np.where(np.isnan(back), slopes, back))
        slopes = np.where(np.isnan(slopes), 0.0, slopes * self.weight)  # none where the FMU refuses
        r = self._residuals(x, here, targets)
        jacobian = np.zeros((*r.shape, x.shape[1]))
        shift, row, column = self._places
        jacobian[:, row, column] = slopes[shift, :, row].T
        n = len(self.parameters)
        for k, j in enumerate(self._measured):
            jacobian[:, len(self.force) + k, n + j] = 1.0
        return r, jacobian

    def _slopes(self, x: np.ndarray, side: np.ndarray, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
        """Forces, and their differences [shift, point, row] over each shift to a side."""
        shifts = side * self._shifts[:, None]  # [shift, point, coordinate]
        forces = self.forces(np.concatenate([x, (x + shifts).reshape(-1, x.shape[1])]), tolerance)
        forces = forces.reshape(1 + len(shifts), len(x), len(self.force))
        lengths = (side[:, self._lead] * self._lengths).T
        return forces[0], (forces[1:] - forces[0]) / lengths[:, :, None]

    def _all_places(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Shift, row and column of each derivative of a force that may differ from zero."""
        n, found = len(self.parameters), []
        for k, j in np.argwhere(self._shifts > 0.0):
            row = self.nuisances[j - n].row if j >= n else None
            found += [(k, i, j) for i in (range(len(self.force)) if row is None else [row])]
        shift, row, column = np.array(found).T
        return shift, row, column

    def _all_shifts(self) -> np.ndarray:
        """Each moves one coordinate, or one of every row."""
        n = len(self.parameters)
        groups: list[list[int]] = [[k] for k in range(n)]
        places: dict[int, int] = {}  # row -> how many of its nuisances have a group
        shared: list[list[int]] = []
        for k, one in enumerate(self.nuisances):
            if one.row is None:
                groups.append([n + k])
                continue
            place = places[one.row] = places.get(one.row, -1) + 1
            if place == len(shared):
                shared.append([])
            shared[place].append(n + k)
        shifts = np.zeros((len(groups) + len(shared), n + len(self.nuisances)))
        for shift, group in zip(shifts, groups + shared, strict=True):
            shift[group] = DIFFERENCE if group[0] < n else NUISANCE_DIFFERENCE
        return shifts


class Rows(Experiment):
    """Rows of means, each in its periodic state: F_t_mean of initialState = Settled."""

    def __init__(self, fmu: FrictionFmu, rows: Measurements, parameters: Sequence[Parameter]) -> None:
        self.rows = rows
        nuisances = [Nuisance(0.0, True, u.row) for u in rows.uncertain]
        super().__init__(fmu, parameters, rows.force, rows.uncertainty, nuisances)
        names = {name for condition in rows.conditions for name in condition}
        self._repeats, self._repeated = 0, {}  # the columns of so many points
        self._conditions = {
            name: np.array([condition[name] for condition in rows.conditions]) for name in names
        }

    def _moving(self, points: np.ndarray) -> dict[str, np.ndarray]:
        """Start values of the FMU that differ from point to point, broadcasting to [point, row]."""
        values: dict[str, np.ndarray] = {}
        for k, one in enumerate(self.rows.uncertain):
            change = np.zeros((len(points), len(self.force)))
            rows = slice(None) if one.row is None else slice(one.row, one.row + 1)
            change[:, rows] = one.deviation * points[:, [len(self.parameters) + k]]
            usual = self._conditions.get(one.name, float(self.fmu.variables[one.name].start))
            values[one.name] = values.get(one.name, usual) + change
        for k, p in enumerate(self.parameters):
            values[p.name] = p.values(points[:, [k]])
        return values

    @cached_property
    def _batch(self) -> Batch:
        """Of one point. Those of more have the same columns, longer: what is asked often is checked once."""
        point = self.start([p.to_coordinate(p.search[0]) for p in self.parameters])[None, :]
        values = {**self._conditions, **self._moving(point), "solver.tolerance": TOLERANCE}
        values["V"] = np.broadcast_to(values["V"], (1, len(self.force)))
        fmu = loaded_fmu(self.fmu.path, runner(built_runner()))
        return prepared(fmu, values, ("F_t_mean",), settled=True)

    def forces(self, points: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        shape = (len(points), len(self.force))
        if len(points) > self._repeats:
            self._repeats = 2 * len(points)
            self._repeated = {
                name: column if column.size == 1 else np.tile(column, self._repeats)
                for name, column in self._batch.starts.items()
            }
        starts = {name: column[: len(points) * len(self.force)] for name, column in self._repeated.items()}
        starts |= {name: flat(values, shape) for name, values in self._moving(points).items()}
        starts["solver.tolerance"] = np.array([tolerance])
        found = replace(self._batch, shape=shape, starts=starts).run(processors(), False)
        refused = np.argwhere(np.isnan(found["F_t_mean"]))
        if len(refused):
            k, row = refused[0]
            self.problem = f"row {row + 1}: {found['reason'][k, row]}"
        return found["F_t_mean"]

    def kappa(self, point: np.ndarray) -> np.ndarray:
        shape = (1, len(self.force))
        values = {**self._conditions, **self._moving(point[None, :]), "vibration.a_d": 0.0}

        def value(name: str) -> np.ndarray:
            return np.broadcast_to(values.get(name, float(self.fmu.variables[name].start)), shape)[0]

        values["V"] = np.broadcast_to(value("V"), shape)
        found = simulate_many(self.fmu.path, values, ("sigma", "F_n"), settle=0.0, duration=0.0)
        by_load = value_is(values.get("friction.limit"), "Load", len(self.force))
        limit = np.where(by_load, value("friction.mu") * found["F_n"][0], value("F_C"))
        return found["sigma"][0] * value("vibration.V_1") / (2.0 * math.pi * value("vibration.f") * limit)


def value_is(column: object, item: str, count: int) -> np.ndarray:
    """Where a column of an enumeration, or one value, is the item."""
    return np.broadcast_to(np.asarray(column) == item, (count,))
