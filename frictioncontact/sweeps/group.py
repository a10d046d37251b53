"""What a worker does with a group of scenarios: runs them and makes the Parquet files of their rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from frictioncontact.batch import simulate_many
from frictioncontact.batch.many import Output
from frictioncontact.batch.run import Progress
from frictioncontact.errors import quiet
from frictioncontact.periodic import STILL, reduction
from frictioncontact.sweeps.scenarios import Rows
from frictioncontact.values import Value

if TYPE_CHECKING:
    import pyarrow as pa

Group = tuple[int, int]  # first scenario, and the one after the last

# Column of the results -> what is read, unit and meaning.
RESULTS: dict[str, tuple[Output, str]] = {
    "F_mean": ("F_t_settled", "N, time mean of F_t in the settled state, over all periods that it lasts"),
    "reduction": ("F_t_settled", "percent, how far F_mean lies below the same scene's without vibration"),
    "F_min": (("F_t", "min"), "N, least sample of F_t in the period"),
    "F_max": (("F_t", "max"), "N, greatest sample of F_t in the period"),
    "sigma_mean": (("sigma", "mean"), "N/m, mean sample of the contact stiffness"),
    "A_r_mean": (("A_r", "mean"), "m2, mean sample of the real contact area"),
    "W_period": (("W_f", "change"), "J, work against friction in the period"),
    "evaluations": ("solver.evaluations", "1, evaluations of the right-hand side"),
}
OUTPUTS = {name: output for name, (output, _) in RESULTS.items()}


@dataclass(frozen=True)
class Job:
    """What all groups of a sweep share."""

    fmu: bytes  # the file
    rows: Rows  # of what varies
    fixed: Mapping[str, Value]  # in all scenarios
    samples: int  # of the period


@dataclass(frozen=True)
class Part:
    """Of a group: Parquet files of its scenarios with results, and of the refused ones with why."""

    good: pa.Buffer
    bad: pa.Buffer
    refused: int


def run_group(job: Job, group: Group, progress: bool | Progress = False) -> Part:
    """Runs the scenarios on one thread. Whatever progress raises ends them."""
    import pyarrow as pa

    values: dict[str, npt.ArrayLike] = {**job.rows(*group), **job.fixed}
    with quiet():
        results = simulate_many(
            values, OUTPUTS, fmu=job.fmu, samples=job.samples, errors="keep", threads=1, progress=progress
        )
        without = simulate_many(
            values | STILL, ["F_t_settled"], fmu=job.fmu,
            settle=0.0, duration=0.0, errors="keep", threads=1,
        )  # fmt: skip
    reasons = pa.array(results.pop("reason"), pa.string())
    results["reduction"] = reduction(results["F_mean"], without["F_t_settled"])
    scenarios = {"scenario": np.arange(*group)}
    scenarios |= {name: np.broadcast_to(column, len(reasons)) for name, column in values.items()}
    good = pa.table({**scenarios, **results}).filter(reasons.is_null())
    bad = pa.table({**scenarios, "reason": reasons}).filter(reasons.is_valid())
    return Part(_parquet(good), _parquet(bad), len(bad))


def _parquet(table: pa.Table) -> pa.Buffer:
    """Dictionaries serve names alone: numbers seldom come twice."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    sink = pa.BufferOutputStream()
    names = [field.name for field in table.schema if pa.types.is_string(field.type)]
    pq.write_table(table, sink, use_dictionary=names)
    return sink.getvalue()
