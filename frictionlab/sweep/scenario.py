"""One scenario of a sweep: the FMU brought to its periodic state and sampled over one period of vibration.

This module and `fmu` travel to the workers of a cluster with the work (`shipping`); Python 3.11
or newer, fmpy and numpy must be there.
"""

from __future__ import annotations

import atexit
import hashlib
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..fmu import FrictionError, FrictionFmu, Value

# Column of the results -> unit and meaning.
RESULTS = {
    "F_mean": "N, time mean of F_t over a period of the vibration",
    "reduction": "percent, how far F_mean lies below F_C",
    "F_min": "N, least sample of F_t in the period",
    "F_max": "N, greatest sample of F_t in the period",
    "sigma_mean": "N/m, mean sample of the contact stiffness",
    "A_r_mean": "m2, mean sample of the real contact area",
    "W_period": "J, work against friction in the period",
    "evaluations": "1, evaluations of the right-hand side",
    "seconds": "s, processor time that the scenario took on its worker",
}


@dataclass(frozen=True)
class Sampling:
    """How a scenario is brought to its periodic state and read."""

    settle: float  # periods of the vibration
    samples: int  # in the period after that

    def __post_init__(self) -> None:
        if not self.settle >= 0.0 or self.samples < 1:
            raise ValueError(f"settle = {self.settle}, samples = {self.samples}: must be at least 0 and 1")


_loaded: dict[str, FrictionFmu] = {}


def load(content: bytes) -> FrictionFmu:
    """The FMU of these bytes, unzipped once in each process."""
    digest = hashlib.sha256(content).hexdigest()
    if digest not in _loaded:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "FrictionContact.fmu"
            path.write_bytes(content)
            _loaded[digest] = FrictionFmu(path)
        atexit.register(_loaded[digest].close)
    return _loaded[digest]


def evaluate(fmu: FrictionFmu, values: Mapping[str, Value], sampling: Sampling) -> dict[str, float]:
    """The columns of RESULTS for one scenario. FrictionError if the FMU refuses it."""
    begin = time.process_time()
    with fmu.session(values) as session:
        period, F_C = 1.0 / session.get("vibration.f"), session.get("F_C")
        session.step(sampling.settle * period)
        work = session.get("W_f")
        rows = np.empty((sampling.samples, 4))
        for k in range(sampling.samples):
            session.step(period / sampling.samples)
            rows[k] = session.read(("F_t_mean", "F_t", "sigma", "A_r"))
        work = session.get("W_f") - work
        evaluations = session.get("solver.evaluations")
    mean, force = rows[:, 0].mean(), rows[:, 1]
    return {
        "F_mean": float(mean),
        "reduction": float(100.0 * (1.0 - mean / F_C)),
        "F_min": float(force.min()),
        "F_max": float(force.max()),
        "sigma_mean": float(rows[:, 2].mean()),
        "A_r_mean": float(rows[:, 3].mean()),
        "W_period": work,
        "evaluations": evaluations,
        "seconds": time.process_time() - begin,
    }


def run_chunk(
    content: bytes, numbered: Sequence[tuple[int, Mapping[str, Value]]], sampling: Sampling
) -> list[dict[str, Value]]:
    """Scenarios with their numbers; what failed has its reason in place of results."""
    fmu = load(content)
    rows: list[dict[str, Value]] = []
    for index, values in numbered:
        try:
            rows.append({"scenario": index, **values, **evaluate(fmu, values, sampling)})
        except FrictionError as error:
            rows.append({"scenario": index, **values, "reason": str(error)})
    return rows
