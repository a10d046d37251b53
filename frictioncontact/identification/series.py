"""A measured series in time, for example a loop of presliding and sliding, replayed in the FMU."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from frictioncontact.batch import simulate_many
from frictioncontact.batch.prepare import Outputs
from frictioncontact.doubts import WITH_STATIC_FRICTION
from frictioncontact.fmu import FrictionFmu
from frictioncontact.identification.data import Series
from frictioncontact.identification.experiment import TOLERANCE, Experiment, Nuisance
from frictioncontact.identification.parameter import Parameter


class Record(Experiment):
    """F_t along the record; inputs are linear between two samples, and a position is a parabola.

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
        steps = np.diff(series.time)
        moving = {"V": series.V, **series.inputs}
        begins = {name: values[:-1] for name, values in moving.items()}
        rates = {name: np.diff(values) / steps for name, values in moving.items()}
        if series.position is not None:  # each step goes as far as the position, and not to and fro
            mean = np.diff(series.position) / steps
            half = np.clip(0.5 * np.diff(series.V), -np.abs(mean), np.abs(mean))
            begins["V"], rates["V"] = mean - half, 2.0 * half / steps
        # A step of no length gives the force at the first sample.
        self._steps = {
            "steps": np.concatenate([[0.0], steps]),
            "inputs": {name: np.concatenate([moving[name][:1], values]) for name, values in begins.items()},
            "rates": {name: np.concatenate([[0.0], values]) for name, values in rates.items()},
        }

    def forces(self, points: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        fitted = {p.name: p.values(points[:, k]) for k, p in enumerate(self.parameters)}
        found = np.full((len(points), len(self.force)), np.nan)
        deflections = self._deflections(fitted, points[:, len(self.parameters)])
        good = np.isfinite(deflections)
        values = {
            **self._constants,
            **{name: values[good] for name, values in fitted.items()},
            "delta_0": deflections[good],
            "solver.tolerance": tolerance,
        }
        found[good] = self._simulated(values, {"F_t": ("F_t", "samples")}, **self._steps)["F_t"]
        found[np.isnan(found).any(axis=1)] = np.nan
        return found

    def _simulated(self, values: Mapping[str, Any], outputs: Outputs, **steps: Any) -> dict[str, np.ndarray]:
        """From the first sample on; what the FMU refuses is nan, and a problem."""
        answer = simulate_many(
            values, outputs, begin=self.rows.time[0], unit="s", errors="keep", fmu=self.fmu.path, **steps
        )
        refused = [reason for reason in answer["reason"] if reason is not None]
        self.problem = refused[0] if refused else self.problem
        return answer

    def _deflections(self, fitted: dict[str, np.ndarray], force: np.ndarray) -> np.ndarray:
        """Of the bristle at the start [m], for a force there [N] that can't exceed its bound."""
        values = {**self._constants, **fitted, "V": np.full(len(force), self._constants["V"])}
        now = self._simulated(values, ("sigma", "F_n"), duration=0.0)
        bound = self.limit(values, now["F_n"])
        if values.get("friction.model") in WITH_STATIC_FRICTION:
            bound = bound * self.value(values, "friction.staticRatio")
        return np.clip(force, -bound, bound) / now["sigma"]
