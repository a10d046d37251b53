"""The measurements and the FMU's answer to a set of parameters: what the fits ask for forces.

A point has a coordinate for each fitted parameter, and after them one for each nuisance: something else
that is not known exactly, in standard deviations where it was measured (then its own residual holds it to
what was measured), or in its unit where it is free.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from frictionlab.batch import simulate_many
from frictionlab.fmu import FrictionError, FrictionFmu
from frictionlab.identify.data import Measurements
from frictionlab.identify.parameter import Parameter

TOLERANCE = 1e-9  # of the FMU's solver: finite differences need a smooth force
DIFFERENCE = 1e-5  # of a coordinate


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

    def at(self, x: np.ndarray, targets: np.ndarray) -> np.ndarray:
        rows = len(self.force)
        own = x[:, len(self.parameters) :][:, self._measured] - targets[:, rows:]
        return np.hstack([(self.forces(x) - targets[:, :rows]) * self.weight, own])

    def derivatives(
        self, x: np.ndarray, r: np.ndarray, targets: np.ndarray, central: bool = False
    ) -> np.ndarray:
        """By differences to one side, or to both; nuisances of single rows are shifted together."""
        rows, n = len(self.force), len(self.parameters)
        shifts = self._shifts()
        sides = (1.0, -1.0) if central else (1.0,)
        points = [x + side * DIFFERENCE * shift for side in sides for shift in shifts]
        answers = self.forces(np.concatenate(points)).reshape(len(sides), len(shifts), len(x), rows)
        here = r[:, :rows] / self.weight + targets[:, :rows]
        each = np.array([(answers[k] - here) * (side / DIFFERENCE) for k, side in enumerate(sides)])
        given = np.isfinite(each)  # on a side where the FMU refuses there is no slope
        slopes = np.sum(each, axis=0, where=given) / np.maximum(np.sum(given, axis=0), 1) * self.weight
        jacobian = np.zeros((len(x), r.shape[1], x.shape[1]))
        for slope, shift in zip(slopes, shifts, strict=True):
            for j in np.flatnonzero(shift):
                row = self.nuisances[j - n].row if j >= n else None
                chosen = slice(0, rows) if row is None else slice(row, row + 1)
                jacobian[:, chosen, j] = slope[:, chosen]
        for k, j in enumerate(self._measured):
            jacobian[:, rows + k, n + j] = 1.0
        return jacobian

    def _shifts(self) -> np.ndarray:
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
            shift[group] = 1.0
        return shifts


class Rows(Experiment):
    """Rows of means, each in its periodic state: F_t_mean of initialState = Settled."""

    def __init__(self, fmu: FrictionFmu, rows: Measurements, parameters: Sequence[Parameter]) -> None:
        self.rows = rows
        nuisances = [Nuisance(0.0, True, u.row) for u in rows.uncertain]
        super().__init__(fmu, parameters, rows.force, rows.uncertainty, nuisances)
        names = {name for condition in rows.conditions for name in condition}
        self._conditions = {
            name: np.array([condition[name] for condition in rows.conditions]) for name in names
        }

    def _values(self, points: np.ndarray) -> dict[str, np.ndarray]:
        """Start values of the FMU, [point, row] or broadcasting to it."""
        values = dict(self._conditions)
        for k, one in enumerate(self.rows.uncertain):
            shift = one.deviation * points[:, [len(self.parameters) + k]]
            rows = np.arange(len(self.force)) if one.row is None else [one.row]
            change = np.zeros((len(points), len(self.force)))
            change[:, rows] = shift
            base = values.get(one.name, float(self.fmu.variables[one.name].start))
            values[one.name] = base + change
        for k, p in enumerate(self.parameters):
            values[p.name] = p.values(points[:, [k]])
        return values

    def forces(self, points: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        values = {**self._values(points), "solver.tolerance": tolerance}
        shape = (len(points), len(self.force))
        values["V"] = np.broadcast_to(values["V"], shape)
        found = simulate_many(self.fmu.path, values, settled=True, errors="keep")
        refused = np.argwhere(found["reason"] != None)  # noqa: E711  elementwise
        if len(refused):
            k, row = refused[0]
            self.problem = f"row {row + 1}: {found['reason'][k, row]}"
        return found["F_t_mean"]

    def kappa(self, point: np.ndarray) -> np.ndarray:
        shape = (1, len(self.force))
        values = {**self._values(point[None, :]), "vibration.a_d": 0.0}

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
