"""A measured series in time, for example a loop of presliding and sliding, replayed in the FMU."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from frictioncontact.batch import simulate_many
from frictioncontact.batch.many import Outputs
from frictioncontact.doubts import WITH_STATIC_FRICTION
from frictioncontact.fmu import FrictionFmu
from frictioncontact.identification.data import Series
from frictioncontact.identification.experiment import TOLERANCE, Experiment, Nuisance
from frictioncontact.identification.parameter import Parameter
from frictioncontact.simulation import moving


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
