"""A measured series in time, for example a loop of presliding and sliding, replayed in the FMU."""

from collections.abc import Mapping, Sequence

import numpy as np

from frictioncontact.batch import simulate_many
from frictioncontact.fmu import FrictionFmu
from frictioncontact.identification.data import Series
from frictioncontact.identification.experiment import TOLERANCE, Experiment, Nuisance
from frictioncontact.identification.parameter import Parameter


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
        # A step of no length gives the force at the first sample.
        self._steps = np.concatenate([[0.0], np.diff(series.time)])
        self._inputs = {"V": np.concatenate([series.V[:1], series.V])}
        for name, values in series.inputs.items():
            self._inputs[name] = np.concatenate([values[:1], 0.5 * (values[1:] + values[:-1])])

    def forces(self, points: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
        fitted = {p.name: p.values(points[:, k]) for k, p in enumerate(self.parameters)}
        found = np.full((len(points), len(self.force)), np.nan)
        deflections = self._deflections(fitted, points[:, len(self.parameters)])
        good = np.isfinite(deflections)
        answer = simulate_many(
            {
                **self._constants,
                **{name: values[good] for name, values in fitted.items()},
                "delta_0": deflections[good],
                "solver.tolerance": tolerance,
            },
            {"F_t": ("F_t", "samples")},
            inputs=self._inputs,
            steps=self._steps,
            unit="s",
            errors="keep",
            fmu=self.fmu.path,
        )
        self._keep_problem(answer)
        found[good] = answer["F_t"]
        found[np.isnan(found).any(axis=1)] = np.nan
        return found

    def _keep_problem(self, answer: Mapping[str, np.ndarray]) -> None:
        refused = [reason for reason in answer["reason"] if reason is not None]
        self.problem = refused[0] if refused else self.problem

    def _deflections(self, fitted: dict[str, np.ndarray], force: np.ndarray) -> np.ndarray:
        """Of the bristle at the start [m], for a force there [N] that can't exceed the limit."""
        values = {**self._constants, **fitted, "V": np.full(len(force), self._constants["V"])}
        now = simulate_many(
            values, ("sigma", "F_n"), settle=0.0, duration=0.0, unit="s", errors="keep", fmu=self.fmu.path
        )
        self._keep_problem(now)
        limit = self.limit(values, now["F_n"])
        return np.clip(force, -limit, limit) / now["sigma"]
