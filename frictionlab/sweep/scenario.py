"""What a sweep reads of a scenario: the FMU brought to its periodic state, and one period sampled.

This module and `batch` travel to the workers of a cluster with the work (`sweep.shipping`); Python 3.11
or newer, fmpy and numpy must be there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import fmpy
import numpy as np

from ..batch.prepare import Output, prepared
from ..batch.runner import runner_of
from ..batch.unpacked import loaded_fmu
from ..project import UserError

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
    "seconds": "s, time that the scenario took on its worker",
}
OUTPUTS: dict[str, Output] = {
    "F_mean": ("F_t_mean", "mean"),
    "reduction": "F_C",  # and what it is made of
    "F_min": ("F_t", "min"),
    "F_max": ("F_t", "max"),
    "sigma_mean": ("sigma", "mean"),
    "A_r_mean": ("A_r", "mean"),
    "W_period": ("W_f", "change"),
    "evaluations": "solver.evaluations",
}


@dataclass(frozen=True)
class Work:
    """What a worker needs to run scenarios, but for their values."""

    fmu: bytes  # the file
    runner: bytes  # the batch runner's shared library
    platform: str  # that it is for
    settle: float  # periods of the vibration that bring a scenario to its periodic state
    samples: int  # in the period after that


@dataclass(frozen=True)
class Results:
    """Of consecutive scenarios: the columns of RESULTS, NaN where a scenario has a reason instead."""

    columns: dict[str, np.ndarray]
    reasons: dict[int, str] = field(default_factory=dict)  # row -> why it was refused


def run_chunk(work: Work, values: Mapping[str, np.ndarray]) -> Results:
    """The results of scenarios: of every variable a value for each, or one for all."""
    if fmpy.platform != work.platform:
        raise UserError(f"the worker is of platform {fmpy.platform}, the sweep of {work.platform}")
    fmu = loaded_fmu(work.fmu, runner_of(work.runner))
    batch = prepared(fmu, values, OUTPUTS, settle=work.settle, samples=work.samples, times=True)
    columns = batch.run(threads=1, raises=False, progress=lambda finished, refused: None)
    reasons = columns.pop("reason")
    columns["reduction"] = 100.0 * (1.0 - columns["F_mean"] / columns["reduction"])
    return Results(
        {name: np.atleast_1d(columns[name]) for name in RESULTS},
        {int(row): reasons[row] for row in np.flatnonzero(reasons != None)},  # noqa: E711
    )
