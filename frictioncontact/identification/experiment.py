"""The measurements and the FMU's answer to a set of parameters: what the fits ask for forces.

A point has a coordinate for each fitted parameter, and after them one for each nuisance: something else
that is not known exactly, in standard deviations where it was measured (then its own residual holds it to
what was measured), or in its unit where it is free. An instrument's nuisances lie between the forces of the
law and what it measured: sign * F(t - delay) + offset + drift * (t - first t). That of the amplitude is the
logarithm of a factor of vibration.V_1.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from frictioncontact.batch import simulate_many
from frictioncontact.batch.many import Outputs
from frictioncontact.errors import UserError, did_you_mean
from frictioncontact.fmu import FrictionError, FrictionFmu
from frictioncontact.identification.data import Measurements, Series
from frictioncontact.plausibility import WITH_STATIC_FRICTION
from frictioncontact.simulation import moving
from frictioncontact.tables import accepted
from frictioncontact.values import LARGEST

LEAST = {"d": 1e-12, "E": 1.0}  # m, Pa: the FMU asks for more than 0 where they are used

# The ranges where nothing is given. Of other parameters starts are sought within a factor of 3 of the usual
# value, and the fit stays within a factor of FARTHEST of it.
PHASES = ("vibration.phase_d", "vibration.phase_2")
RANGES = {
    "contact.stiffnessScale": (1e-9, 10.0),
    "contact.sigma": (1e3, 1e13),
    **dict.fromkeys(PHASES, (0.0, 2.0 * math.pi)),
}
NEAR, FARTHEST = 3.0, 1e6


@dataclass(frozen=True)
class Parameter:
    """The coordinate is the logarithm if the parameter must be positive, so that an interval is a factor.

    Else it is the value over the largest that is searched, or over 1 rad.
    """

    name: str
    unit: str
    low: float  # the fit stays from low to high
    high: float
    search: tuple[float, float]  # where starts are sought
    start: float | None
    logarithmic: bool

    @property
    def after(self) -> str:
        """The unit as it follows a number."""
        return "" if self.unit == "1" else f" {self.unit}"

    @property
    def periodic(self) -> bool:
        return self.name in PHASES

    @property
    def unit_of_coordinate(self) -> float:
        return 1.0 if self.periodic else max(map(abs, self.search)) or 1.0

    def to_coordinate(self, value: float) -> float:
        if self.logarithmic:
            return math.log(value) if value > 0.0 else -math.inf
        return value / self.unit_of_coordinate

    def to_value(self, coordinate: float) -> float:
        return float(self.values(np.float64(coordinate)))

    def values(self, coordinates: np.ndarray) -> np.ndarray:
        if self.logarithmic:
            return np.exp(np.minimum(coordinates, 700.0))
        return coordinates * self.unit_of_coordinate

    def wrapped(self, coordinate: float) -> float:
        return coordinate % (2.0 * math.pi) if self.periodic else coordinate


def parameter(
    fmu: FrictionFmu,
    name: str,
    start: float | None,
    search: tuple[float, float] | None,
    constants: Mapping[str, Any],
) -> Parameter:
    """A parameter by its name in the FMU, with bounds and unit from the model description.

    search is the range that it stays in; of a phase it says only where starts are sought. UserError where the
    name is none that can be fitted, or a value is out of bounds.
    """
    names = accepted(fmu.variables)
    if name not in names:
        raise UserError(
            f"{name} can't be fitted{did_you_mean(str(name), names) or ';'} these can: {', '.join(names)}"
        )
    variable = fmu.variables[name]
    low = LEAST.get(name, -LARGEST) if variable.min is None else float(variable.min)
    high = LARGEST if variable.max is None else float(variable.max)
    after = "" if variable.unit == "1" else f" {variable.unit}"
    for value in (*(search or ()), *([] if start is None else [start])):
        if not low <= value <= high:
            raise UserError(f"{name} = {value:g}{after} must be from {low:g} to {high:g}")
    logarithmic = low > 0.0
    search = search or (RANGES.get(name) if start is None else None)
    if search is not None:
        stays = search
    else:
        usual = float(constants.get(name, variable.start)) if start is None else start
        usual = usual or float(variable.nominal or 1.0)
        far = FARTHEST * abs(usual)
        search = max(low, min(usual / NEAR, usual * NEAR)), min(high, max(usual / NEAR, usual * NEAR))
        stays = max(low, usual / FARTHEST if logarithmic else -far), min(high, far)
    if name in PHASES:
        stays = -math.inf, math.inf
    return Parameter(name, variable.unit, *stays, search, start, logarithmic)


TOLERANCE = 1e-6  # of the FMU's solver: far below what differences of forces over DIFFERENCE need
TIGHT = 1e-10  # where a fit ends
DIFFERENCE = 1e-3  # of a coordinate
NUISANCE_DIFFERENCE = 1e-2  # of a nuisance's


INSTRUMENT = ("offset", "drift", "delay", "sign", "amplitude")
V_1 = "vibration.V_1"


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
        self.measured = [k for k, one in enumerate(self.nuisances) if one.measured]
        self._groups = self._shifted_together()

    def _of_instrument(self) -> list[Nuisance]:
        size, span = float(np.abs(self.force).max()), float(np.ptp(self.time)) or 1.0
        step = span / max(len(self.time) - 1, 1)
        scales = {"offset": 0.1 * size, "drift": 0.1 * size / span, "delay": step, "amplitude": 1.0}
        reach = {"delay": 0.25 * span / step, "amplitude": math.log(10.0)}
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
        return np.concatenate([self.force, np.zeros(len(self.measured))])

    @property
    def degrees(self) -> int:
        """Forces minus what is free."""
        free = len(self.nuisances) - len(self.measured)
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
        own = x[len(self.parameters) :][self.measured] - target[len(self.force) :]
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
        jacobian = np.zeros((rows + len(self.measured), len(x)))
        for difference, columns in zip(differences, self._groups, strict=True):
            for j in columns:
                row = self.nuisances[j - n].row if j >= n else None
                i = slice(rows) if row is None else row
                jacobian[i, j] = difference[i]
        for k, j in enumerate(self.measured):
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
        super().__init__(fmu, parameters, rows.force, rows.uncertainty, nuisances, rows.order, instrument)
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
        if "amplitude" in self.places:
            values[V_1] = self.value(values, V_1) * np.exp(self.nuisance(points, "amplitude"))
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


class Record(Experiment):
    """F_t along the record; inputs are linear between two samples, and a position is a parabola.

    The force that the record starts with is a nuisance: the first sample is as uncertain as any other. With
    a delay the velocity before the record is one, too.
    """

    word = "sample"

    rows: Series

    def __init__(
        self,
        fmu: FrictionFmu,
        series: Series,
        parameters: Sequence[Parameter],
        instrument: Sequence[str] = (),
    ) -> None:
        self.rows = series
        told = slice(None) if series.told is None else series.told
        force, time = series.force[told], series.time[told]
        uncertainty = None if series.uncertainty is None else list(series.uncertainty[told])
        sign = -1.0 if "sign" in instrument else 1.0
        first = [Nuisance(sign * float(force[0]), False)]
        first += [Nuisance(1.0, False)] if "delay" in instrument else []
        super().__init__(fmu, parameters, list(force), uncertainty, first, list(time), instrument)
        held = {name: float(values[0]) for name, values in series.inputs.items()}
        self._constants = {**series.constants, **held, "V": float(series.V[0])}
        inputs = series.inputs if series.position is not None else {"V": series.V, **series.inputs}
        self._inputs = moving(series.time, inputs, series.position)

    def model(self, points: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        found = np.full((len(points), len(self.force)), np.nan)
        if "delay" not in self.places:
            return self._model(points, tolerance, 0.0, 1.0)
        delays, before = self.nuisance(points, "delay"), points[:, [len(self.parameters) + 1]]
        pairs, place = np.unique(np.hstack([delays, before]), axis=0, return_inverse=True)
        for k, pair in enumerate(pairs.tolist()):
            here = place.ravel() == k
            found[here] = self._model(points[here], tolerance, *pair)
        return found

    def _model(self, points: np.ndarray, tolerance: float, delay: float, before: float) -> np.ndarray:
        """Of points of one delay [s]: the law's time is that of the record less the delay.

        before: the velocity before the record, over its first.
        """
        fitted = {p.name: p.values(points[:, k]) for k, p in enumerate(self.parameters)}
        found = np.full((len(points), len(self.force)), np.nan)
        begin = self.time[0] - delay
        deflections = self._deflections(fitted, points[:, len(self.parameters)], begin)
        good = np.isfinite(deflections)
        values = {
            **self._constants,
            **{name: values[good] for name, values in fitted.items()},
            "delta_0": deflections[good],
            "solver.tolerance": tolerance,
        }
        inputs, ends = self._inputs.preceded(before, begin), self.time[1:] - self.time[0]
        times = np.concatenate([[0.0], inputs.steps(ends)])
        held, rates = inputs.over(times[:-1], times[1:])
        # A step of no length gives the force at the first sample.
        steps = {
            "steps": np.diff(times, prepend=0.0),
            "inputs": {name: np.concatenate([each[:1], each]) for name, each in held.items()},
            "rates": {name: np.concatenate([[0.0], each]) for name, each in rates.items()},
        }
        forces = self._simulated(values, {"F_t": ("F_t", "samples")}, begin=begin, **steps)["F_t"]
        found[good] = forces[:, np.concatenate([[0], np.searchsorted(times, ends)])]
        found[np.isnan(found).any(axis=1)] = np.nan
        return found

    def _simulated(self, values: Mapping[str, Any], outputs: Outputs, **steps: Any) -> dict[str, np.ndarray]:
        """From the first sample on; what the FMU refuses is nan, and a problem."""
        answer = simulate_many(values, outputs, unit="s", errors="keep", fmu=self.fmu.path, **steps)
        refused = [reason for reason in answer["reason"] if reason is not None]
        self.problem = refused[0] if refused else self.problem
        return answer

    def _deflections(self, fitted: dict[str, np.ndarray], force: np.ndarray, begin: float) -> np.ndarray:
        """Of the bristle at begin [s], in m, for a force there [N] that can't exceed its bound."""
        values = {**self._constants, **fitted, "V": np.full(len(force), self._constants["V"])}
        now = self._simulated(values, ("sigma", "F_n"), duration=0.0, begin=begin)
        bound = self.limit(values, now["F_n"])
        if values.get("friction.model") in WITH_STATIC_FRICTION:
            bound = bound * self.value(values, "friction.staticRatio")
        return np.clip(force, -bound, bound) / now["sigma"]
