"""Measurements from CSV files or frames: rows of means, or a series in time.

A column is named after a variable of the FMU, as tables.py says. NAME.uncertainty is the standard uncertainty
of the column NAME. A column "time" makes a series.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import make_smoothing_spline
from scipy.optimize import brentq

from frictioncontact.errors import UserError, warn
from frictioncontact.fmu import FrictionFmu
from frictioncontact.tables import ORDER, OWN, POSITION, SUFFIX, TIME, accepted, table

if TYPE_CHECKING:
    from frictioncontact.tables import Source

MEASURED, FORCE = "F_t_mean", "F_t"
LOAD = "load"
TIMED = ("V_1", "V_2", "a_d", "sigma_1", "sigma_2", "V_S")  # why a law needs the time
FAR = 0.1  # m: a loop of presliding and sliding is shorter
SMALL = 0.03  # of a step: a scatter of a position that does not matter, or the curve of an exact one
MEDIAN = 0.6745  # of the size of normal noise with a standard deviation of 1
FOLLOWS = {"contact.input": "Load", "friction.limit": "Load"}  # from a column or a constant load


@dataclass(frozen=True)
class Uncertain:
    """A condition that is not known exactly: in one row, or by the same amount in all."""

    name: str
    deviation: float  # standard uncertainty, in SI units
    row: int | None


@dataclass(frozen=True)
class Measurements:
    """conditions[k] are start values of the FMU for row k; all in SI units."""

    names: tuple[str, ...]  # the columns that are conditions
    conditions: list[dict[str, Any]]
    force: list[float]  # N
    uncertainty: list[float] | None  # N
    uncertain: tuple[Uncertain, ...] = ()
    order: list[float] | None = None  # in which they were measured, where a column says it

    def column(self, name: str) -> np.ndarray:
        return np.array([float(row.get(name, 0.0)) for row in self.conditions])

    def changed(self, change: Callable[[dict[str, Any]], dict[str, Any]]) -> Measurements:
        """With other conditions."""
        return replace(self, conditions=[{**row, **change(row)} for row in self.conditions])


@dataclass(frozen=True)
class Series:
    """One record in time. Arrays are of the samples, in SI units."""

    time: np.ndarray
    V: np.ndarray  # m/s; of a position its central differences
    inputs: dict[str, np.ndarray]  # the other columns: load, d, E
    force: np.ndarray  # N
    constants: dict[str, Any]
    uncertainty: np.ndarray | None = None  # N
    position: np.ndarray | None = None
    told: np.ndarray | None = None  # the samples whose force is fitted; None: all
    scatter: float = 0.0  # m, of the measured position, which is smoothed by as much
    is_timed: bool = True  # or each row counts as a second, of a law that needs no time

    @property
    def names(self) -> tuple[str, ...]:
        return ("V", *self.inputs)

    def column(self, name: str) -> np.ndarray:
        return np.array([float(self.constants.get(name, 0.0))])

    def moved(self, position: np.ndarray) -> Series:
        """With another position."""
        return replace(self, position=position, V=np.gradient(position, self.time, edge_order=2))

    def changed(self, change: Callable[[dict[str, Any]], dict[str, Any]]) -> Series:
        """With other constants."""
        return replace(self, constants={**self.constants, **change(self.constants)})


@dataclass(frozen=True)
class Stated:
    """A standard uncertainty from the command line: a value in SI units, or a part of what it belongs to."""

    name: str
    value: float
    relative: bool

    def of(self, value: float) -> float:
        return self.value * abs(value) if self.relative else self.value


def read(
    source: Source,
    fmu: FrictionFmu,
    constants: Mapping[str, Any],
    stated: Sequence[Stated] = (),
    columns: Mapping[str, str] | None = None,
) -> Measurements | Series:
    """A table; constants are start values that all rows share, columns the headings of those of other names.

    No column may repeat one. UserError names the file, the row (counted from 1), its line and the column.
    """
    units = {**OWN, **accepted(fmu.variables)}
    units |= {f"{name}{SUFFIX}": unit for name, unit in units.items()}
    found = table(source, "data", units, "variable of a table of measurements", columns, is_log=True)
    names, where = list(found.columns), found.where
    is_series = TIME in names or POSITION in names
    _check(where, names, constants, is_series)
    positive = [name for name in names if (name == LOAD and not is_series) or name.endswith(SUFFIX)]
    measured = found.numbers(positive)
    if is_series and LOAD in names and (open_ := measured[LOAD] <= 0.0).any():
        warn([f"{where}: {open_.sum()} of {len(open_)} rows have no load and are left out"])
        measured = {name: values[~open_] for name, values in measured.items()}
    if not len(measured[names[0]]):
        raise UserError(f"{where}: no rows of numbers")
    shared = with_load(names, constants)
    if is_series:
        return _series(where, fmu, measured, shared, stated)
    return _rows(fmu, {name: values.tolist() for name, values in measured.items()}, shared, stated)


def with_load(names: Sequence[str], constants: Mapping[str, Any]) -> dict[str, Any]:
    """The constants, with the load driving contact and limit where there is one and nothing else is said."""
    return {**(FOLLOWS if LOAD in names or LOAD in constants else {}), **constants}


def _check(path: str, names: Sequence[str], constants: Mapping[str, Any], is_series: bool) -> None:
    for name in names:
        if name in constants:
            raise UserError(f"{path}: {name} is a column and also set as a constant")
        if name.endswith(SUFFIX) and name.removesuffix(SUFFIX) not in names:
            plain = name.removesuffix(SUFFIX)
            raise UserError(f"{path}: {name} belongs to a column {plain}, which is missing")
    measured = FORCE if is_series else MEASURED
    if measured not in names:
        raise UserError(f"{path}: column '{measured} [N]' is missing")
    needs = [n for n, value in constants.items() if n.rpartition(".")[2] in TIMED and value]
    if is_series and TIME not in names and needs:
        raise UserError(f"{path}: column 'time [s]' is missing, and {needs[0]} needs it")
    if is_series and (POSITION in names) == ("V" in names):
        raise UserError(f"{path}: a series in time needs either 'position [m]' or 'V [m/s]'")
    if not is_series and "V" not in names and "V" not in constants:
        raise UserError(f"{path}: column 'V [m/s]' is missing, and no start value of V gives it")
    other = MEASURED if is_series else FORCE
    if other in names:
        where = "rows of means, without time" if is_series else "a series, with a column 'time [s]'"
        raise UserError(f"{path}: {other} is for {where}")
    if LOAD in names and ("d" in names or "d" in constants):
        raise UserError(f"{path}: load and d both give the separation; keep one")


def _rows(
    fmu: FrictionFmu, measured: dict[str, list[float]], constants: dict[str, Any], stated: Sequence[Stated]
) -> Measurements:
    force, order = measured[MEASURED], measured.pop(ORDER, None)
    names = tuple(name for name in measured if name != MEASURED and not name.endswith(SUFFIX))
    conditions = [{**constants, **{name: measured[name][k] for name in names}} for k in range(len(force))]
    uncertainty = measured.get(MEASURED + SUFFIX)
    uncertain = [
        Uncertain(name, deviation, row)
        for name in names
        for row, deviation in enumerate(measured.get(name + SUFFIX, []))
    ]
    for one in stated:
        if one.name == MEASURED:
            uncertainty = [one.of(value) for value in force]
            if 0.0 in uncertainty:
                row = uncertainty.index(0.0) + 1
                raise UserError(f"the uncertainty of {MEASURED}: row {row} measures 0 N, so give it in N")
        elif one.name == FORCE:
            raise UserError(f"the uncertainty of {FORCE}: rows of means take that of {MEASURED}")
        elif one.name in names:
            uncertain += [Uncertain(one.name, one.of(measured[one.name][k]), k) for k in range(len(force))]
        else:
            usual = float(constants.get(one.name, fmu.variables[one.name].start))
            uncertain.append(Uncertain(one.name, one.of(usual), None))
    uncertain = [one for one in uncertain if one.deviation > 0.0]
    if uncertain and uncertainty is None:
        raise UserError(
            f"the uncertainty of {uncertain[0].name} can't be weighed without that of {MEASURED}: "
            f"give a column '{MEASURED}{SUFFIX} [N]' or state it"
        )
    return Measurements(names, conditions, force, uncertainty, tuple(uncertain), order)


def _series(
    path: str,
    fmu: FrictionFmu,
    columns: dict[str, np.ndarray],
    constants: dict[str, Any],
    stated: Sequence[Stated],
) -> Series:
    is_timed = TIME in columns
    if is_timed:
        columns = _in_order(path, columns)
    else:
        columns[TIME] = np.arange(1.0 * len(columns[FORCE]))
        warn([f"{path}: no time: a delay, a drift and hum are not seen, and each row counts as 1 s"])
    time, force = columns.pop(TIME), columns.pop(FORCE)
    if len(time) < 3:
        raise UserError(f"{path}: a series needs at least 3 rows")
    if np.ptp(columns.get(POSITION, 0.0)) > FAR:
        span = f"{np.ptp(columns[POSITION]):.3g} m, an unlikely magnitude"
        warn([f"{path}: position spans {span}; a unit follows the name, as in 'position [um]'"])
    uncertainty = columns.pop(FORCE + SUFFIX, None)
    for one in stated:
        if one.name != FORCE:
            raise UserError(f"the uncertainty of {one.name}: a series takes the uncertainty of {FORCE} alone")
        uncertainty = np.array([one.of(value) for value in force])
        if not (uncertainty > 0.0).all():
            raise UserError(f"the uncertainty of {FORCE}: give it in N, since the force passes zero")
    position, scatter = columns.pop(POSITION, None), 0.0
    if position is not None:
        position, scatter = smoothed(time, position)
    given = columns.pop("V", None)
    V = np.gradient(position, time, edge_order=2) if given is None else given
    for name in columns:
        if name.endswith(SUFFIX) or fmu.variables[name].causality != "input":
            raise UserError(
                f"{path}: column {name}: a series takes inputs of the FMU, d, E and load; "
                "give it as a start value"
            )
    told = _told(V) if constants.get("friction.model") == "Coulomb" else None
    return Series(time, V, columns, force, constants, uncertainty, position, told, scatter, is_timed)


def _in_order(path: str, columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Sorted by time, with the mean of rows of one time."""
    steps = np.diff(columns[TIME])
    if (steps > 0.0).all():
        return columns
    times, place, count = np.unique(columns[TIME], return_inverse=True, return_counts=True)
    same = f"; {np.sum(count > 1)} times are there more than once, and averaged" if (count > 1).any() else ""
    warn([f"{path}: time falls or stands at {np.sum(steps <= 0.0)} rows, which are sorted{same}"])
    return {name: np.bincount(place, each) / count for name, each in columns.items()} | {TIME: times}


def _told(V: np.ndarray) -> np.ndarray:
    """Samples whose Coulomb friction a record tells: not those beside a reversal, of either sign."""
    turns = np.flatnonzero(V[1:] * V[:-1] <= 0.0)
    told = np.ones(len(V), dtype=bool)
    told[turns] = told[turns + 1] = False
    return told


def scatter(time: np.ndarray, position: np.ndarray) -> float:
    """Standard deviation [m] of the noise: of four samples each, what no parabola explains."""
    times = np.stack([time[k : len(time) - 3 + k] for k in range(4)])
    positions = np.stack([position[k : len(time) - 3 + k] for k in range(4)])
    gaps = times[:, None] - times[None, :] + np.eye(4)[:, :, None]
    weights = 1.0 / np.prod(gaps, axis=1)
    miss = np.sum(weights * positions, axis=0) / np.sqrt(np.sum(weights**2, axis=0))
    return float(np.median(np.abs(miss))) / MEDIAN


def smoothed(time: np.ndarray, position: np.ndarray) -> tuple[np.ndarray, float]:
    """The smoothest spline as far from the position as its scatter, and that [m], 0 if it is small."""
    noise = scatter(time, position) if len(time) > 8 else 0.0
    if noise <= SMALL * float(np.std(np.diff(position))):
        return position, 0.0
    place, height = (time - time[0]) / (time[-1] - time[0]), position / noise

    def curve(stiffness: float) -> np.ndarray:
        return make_smoothing_spline(place, height, lam=math.exp(stiffness))(place)

    def excess(stiffness: float) -> float:
        return float(np.mean((curve(stiffness) - height) ** 2)) - 1.0

    return noise * curve(brentq(excess, -60.0, 60.0, xtol=0.1)), noise
