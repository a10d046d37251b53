"""A measured series in time, for example a loop of presliding and sliding, replayed in the FMU."""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import c_double, c_uint

import numpy as np

from frictionlab.batch import simulate_many
from frictionlab.fmu import FrictionError, FrictionFmu
from frictionlab.identify.data import Series
from frictionlab.identify.experiment import TOLERANCE, Experiment, Nuisance, value_is
from frictionlab.identify.parameter import Parameter


class Record(Experiment):
    """F_t along the record; the velocity is held over each step, as inputs are between two samples.

    The force that the record starts with is a nuisance: the first sample is as uncertain as any other.
    """

    word = "sample"

    def __init__(self, fmu: FrictionFmu, series: Series, parameters: Sequence[Parameter]) -> None:
        self.rows = series
        uncertainty = None if series.uncertainty is None else list(series.uncertainty)
        super().__init__(
            fmu, parameters, list(series.force), uncertainty, [Nuisance(float(series.force[0]), False)]
        )
        first = {name: float(values[0]) for name, values in series.inputs.items()}
        self._constants = {**series.constants, **first, "V": float(series.V[0])}

    def forces(self, points: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        fitted = {p.name: p.values(points[:, k]) for k, p in enumerate(self.parameters)}
        found = np.full((len(points), len(self.force)), np.nan)
        deflections = self._deflections(fitted, points[:, len(self.parameters)])
        for k in np.flatnonzero(np.isfinite(deflections)):
            values = {name: float(column[k]) for name, column in fitted.items()}
            try:
                found[k] = self._replay(
                    {**self._constants, **values, "delta_0": float(deflections[k])}, tolerance
                )
            except FrictionError as error:
                self.problem = str(error)
        return found

    def _deflections(self, fitted: dict[str, np.ndarray], force: np.ndarray) -> np.ndarray:
        """Of the bristle at the start [m], for a force there [N] that can't exceed the limit."""
        values = {**self._constants, **fitted, "V": np.full(len(force), self._constants["V"])}
        now = simulate_many(
            self.fmu.path, values, ("sigma", "F_n"), settle=0.0, duration=0.0, unit="s", errors="keep"
        )
        refused = [reason for reason in now["reason"] if reason is not None]
        self.problem = refused[0] if refused else self.problem

        def value(name: str) -> np.ndarray:
            return np.asarray(values.get(name, float(self.fmu.variables[name].start)))

        by_load = value_is(values.get("friction.limit"), "Load", len(force))
        limit = np.where(by_load, value("friction.mu") * now["F_n"], value("F_C"))
        return np.clip(force, -limit, limit) / now["sigma"]

    def _replay(self, start_values: dict[str, float | str], tolerance: float) -> np.ndarray:
        """F_t [N] at the samples, by the FMU's functions directly: a record is many short steps."""
        series = self.rows
        names = ["V", *series.inputs]
        inputs = np.column_stack(
            [series.V, *(0.5 * (values[1:] + values[:-1]) for values in series.inputs.values())]
        )
        friction = np.empty(len(series.time))
        with self.fmu.session({**start_values, "solver.tolerance": tolerance}) as session:
            library, component = session.slave.dll, session.slave.component
            references = (c_uint * len(names))(*(self.fmu.variables[n].valueReference for n in names))
            force, cell = (c_uint * 1)(self.fmu.variables["F_t"].valueReference), (c_double * 1)()
            friction[0] = session.get("F_t")
            cells = (c_double * len(names))()
            t = 0.0
            for k, (h, values) in enumerate(zip(np.diff(series.time), inputs, strict=True)):
                cells[:] = list(values)
                status = library.fmi2SetReal(component, references, len(names), cells)
                status |= library.fmi2DoStep(component, t, float(h), 1)
                status |= library.fmi2GetReal(component, force, 1, cell)
                if status > 1:
                    raise FrictionError(f"sample {k + 2}: {'; '.join(session.messages) or 'refused'}")
                t += float(h)
                friction[k + 1] = cell[0]
        return friction

    def kappa(self, point: np.ndarray) -> None:
        return None
