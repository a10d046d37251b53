"""The measurements and the FMU's answer to a set of parameters: what the fits ask for forces.

A point has a coordinate for each fitted parameter, and after them one for each nuisance: something else
that is not known exactly, in standard deviations where it was measured (then its own residual holds it to
what was measured), or in its unit where it is free. An instrument's nuisances lie between the forces of the
law and what it measured: sign * F(t - delay) + offset + drift * (t - first t).
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from frictioncontact.batch import simulate_many
from frictioncontact.fmu import FrictionError, FrictionFmu
from frictioncontact.identification.data import Measurements, Series
from frictioncontact.identification.parameter import Parameter
from frictioncontact.values import LARGEST

TOLERANCE = 1e-6  # of the FMU's solver: far below what differences of forces over DIFFERENCE need
TIGHT = 1e-10  # where a fit ends
DIFFERENCE = 1e-3  # of a coordinate
NUISANCE_DIFFERENCE = 1e-2  # of a nuisance's


INSTRUMENT = ("offset", "drift", "delay", "sign")


@dataclass(frozen=True)
class Nuisance:
    start: float
    measured: bool  # has a residual of its own
    row: int | None = None  # the only row that depends on it
    name: str = ""  # of one of the instrument
    scale: float = 1.0  # of one of the instrument: its value [SI] at a coordinate of 1
    reach: float = math.inf  # largest coordinate


class Experiment(ABC):
    """Forces of points, their residuals and derivatives."""

    word = "row"  # what one measured force is called
    rows: Measurements | Series

    def __init__(
        self,
        fmu: FrictionFmu,
        parameters: Sequence[Parameter],
        force: Sequence[float],
        uncertainty: Sequence[float] | None,
        nuisances: Sequence[Nuisance] = (),
        time: Sequence[float] | None = None,
        instrument: Sequence[str] = (),
    ) -> None:
        """time [s]: of each force; the number of each row where there is none."""
        self.fmu, self.parameters, self.instrument = fmu, tuple(parameters), tuple(instrument)
        self.force = np.array(force)
        self.time = np.arange(1.0, len(force) + 1.0) if time is None else np.array(time)
        self.sign = -1.0 if "sign" in instrument else 1.0
        self.nuisances = (*nuisances, *self._of_instrument())
        n = len(self.parameters)
        self.places = {one.name: n + k for k, one in enumerate(self.nuisances) if one.name}
        self.known = uncertainty is not None
        self.weight = 1.0 / np.array(uncertainty) if self.known else np.ones(len(self.force))
        reach = [one.reach for one in self.nuisances]
        self.low = np.array([p.to_coordinate(p.low) for p in self.parameters] + [-v for v in reach])
        self.high = np.array([p.to_coordinate(p.high) for p in self.parameters] + reach)
        self.problem = "no start value works"  # the FMU's last refusal
        self._measured = [k for k, one in enumerate(self.nuisances) if one.measured]
        self._groups = self._shifted_together()

    def _of_instrument(self) -> list[Nuisance]:
        size, span = float(np.abs(self.force).max()), float(np.ptp(self.time)) or 1.0
        step = span / max(len(self.time) - 1, 1)
        scales = {"offset": 0.1 * size, "drift": 0.1 * size / span, "delay": step}
        reach = {"delay": 0.25 * span / step}
        asked = [(name, scales[name]) for name in self.instrument if name != "sign"]
        return [Nuisance(0.0, False, None, name, scale, reach.get(name, math.inf)) for name, scale in asked]

    @property
    def elapsed(self) -> np.ndarray:
        """From the first sample or row [s, or rows]."""
        return self.time - self.time[0]

    def nuisance(self, points: np.ndarray, name: str) -> np.ndarray | float:
        """Value of one of the instrument at each point, as a column; 0 where it is not asked for."""
        if name not in self.places:
            return 0.0
        k = self.places[name]
        return points[:, [k]] * self.nuisances[k - len(self.parameters)].scale

    def forces(self, points: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        """What would be measured, [point, row] in N; nan where the FMU refuses, and self.problem says why."""
        found = self.sign * self.model(points, tolerance)
        return found + self.nuisance(points, "offset") + self.nuisance(points, "drift") * self.elapsed

    @abstractmethod
    def model(self, points: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        """The forces of the law, as above."""

    def like(self, rows: Measurements | Series, instrument: Sequence[str]) -> Self:
        """The same with other rows and nuisances of the instrument."""
        return type(self)(self.fmu, rows, self.parameters, instrument)  # type: ignore[call-arg, arg-type]

    def value(self, values: Mapping[str, Any], name: str) -> np.ndarray:
        """Of a variable in scenes with these start values."""
        return np.asarray(values.get(name, float(self.fmu.variables[name].start)))

    def limit(self, values: Mapping[str, Any], F_n: np.ndarray) -> np.ndarray:
        """Of the friction [N] in scenes with these start values."""
        by_load = np.asarray(values.get("friction.limit")) == "Load"
        return np.where(by_load, self.value(values, "friction.mu") * F_n, self.value(values, "F_C"))

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

    def misfits(self, points: np.ndarray, target: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        """(forces - target) weighed, [point, row]; nan, and a problem, where their squares would overflow."""
        forces = self.forces(points, tolerance)
        with np.errstate(over="ignore"):
            found = (forces - target[: len(self.force)]) * self.weight
        far = np.argwhere(np.abs(found) > LARGEST)
        if len(far):
            k, row = far[0]
            self.problem = (
                f"{self.word} {row + 1}: the FMU gives {forces[k, row]:g} N and {target[row]:g} N was "
                f"measured, more than {LARGEST:g} standard uncertainties away"
            )
            found[np.abs(found) > LARGEST] = np.nan
        return found

    def residuals(self, x: np.ndarray, target: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        """Of forces and of measured nuisances at a point, in standard deviations where they are stated."""
        own = x[len(self.parameters) :][self._measured] - target[len(self.force) :]
        return np.concatenate([self.misfits(x[None, :], target, tolerance)[0], own])

    def slopes(self, x: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        """Derivatives of the residuals, [residual, coordinate], by differences to both sides in one batch.

        To one side where the FMU refuses the other, and zero where it refuses both.
        """
        rows, n = len(self.force), len(self.parameters)
        shifts = np.zeros((len(self._groups), len(x)))
        for shift, columns in zip(shifts, self._groups, strict=True):
            shift[columns] = DIFFERENCE if columns[0] < n else NUISANCE_DIFFERENCE
        forces = self.forces(np.concatenate([x[None, :], x + shifts, x - shifts]), tolerance)
        here, up, down = forces[0], forces[1 : 1 + len(shifts)], forces[1 + len(shifts) :]
        up, down = up - here, here - down
        up, down = np.where(np.isnan(up), down, up), np.where(np.isnan(down), up, down)
        differences = np.nan_to_num(0.5 * (up + down)) / shifts.max(axis=1, keepdims=True) * self.weight
        jacobian = np.zeros((rows + len(self._measured), len(x)))
        for difference, columns in zip(differences, self._groups, strict=True):
            for j in columns:
                row = self.nuisances[j - n].row if j >= n else None
                i = slice(rows) if row is None else row
                jacobian[i, j] = difference[i]
        for k, j in enumerate(self._measured):
            jacobian[rows + k, n + j] = 1.0
        return jacobian

    def _shifted_together(self) -> list[list[int]]:
        """Groups of coordinates for the differences: each alone, but one nuisance of every row together."""
        n = len(self.parameters)
        alone = [[k] for k in range(n)]
        by_row: dict[int, list[int]] = {}
        for k, one in enumerate(self.nuisances):
            if one.row is None:
                alone.append([n + k])
            else:
                by_row.setdefault(one.row, []).append(n + k)
        most = max(map(len, by_row.values()), default=0)
        return alone + [[of[k] for of in by_row.values() if k < len(of)] for k in range(most)]


class Rows(Experiment):
    """Rows of means, each in its periodic state: F_t_settled."""

    rows: Measurements

    def __init__(
        self,
        fmu: FrictionFmu,
        rows: Measurements,
        parameters: Sequence[Parameter],
        instrument: Sequence[str] = (),
    ) -> None:
        self.rows = rows
        nuisances = [Nuisance(0.0, True, u.row) for u in rows.uncertain]
        super().__init__(fmu, parameters, rows.force, rows.uncertainty, nuisances, instrument=instrument)
        names = {name for condition in rows.conditions for name in condition}
        self._conditions = {
            name: np.array([condition[name] for condition in rows.conditions]) for name in names
        }

    def _values(self, points: np.ndarray) -> dict[str, np.ndarray]:
        """Start values of the FMU, broadcasting to [point, row]."""
        values: dict[str, np.ndarray] = dict(self._conditions)
        for k, one in enumerate(self.rows.uncertain):
            change = np.zeros((len(points), len(self.force)))
            rows = slice(None) if one.row is None else slice(one.row, one.row + 1)
            change[:, rows] = one.deviation * points[:, [len(self.parameters) + k]]
            values[one.name] = values.get(one.name, float(self.fmu.variables[one.name].start)) + change
        for k, p in enumerate(self.parameters):
            values[p.name] = p.values(points[:, [k]])
        values["V"] = np.broadcast_to(values["V"], (len(points), len(self.force)))
        return values

    def model(self, points: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        values = {**self._values(points), "solver.tolerance": tolerance}
        found = simulate_many(
            values, ("F_t_settled",), settle=0.0, duration=0.0, errors="keep", fmu=self.fmu.path
        )
        refused = np.argwhere(np.isnan(found["F_t_settled"]))
        if len(refused):
            k, row = refused[0]
            self.problem = f"row {row + 1}: {found['reason'][k, row]}"
        return found["F_t_settled"]
