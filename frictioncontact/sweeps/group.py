"""What a worker does with a group of scenarios: runs them and makes the Parquet files of their rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from frictioncontact import resources
from frictioncontact.batch.prepare import Output, prepared
from frictioncontact.batch.run import Progress
from frictioncontact.batch.runner import runner
from frictioncontact.batch.unpacked import loaded_fmu
from frictioncontact.sweeps.scenarios import Scenarios

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
class Job:
    """What all groups of a sweep share."""

    fmu: bytes  # the file
    scenarios: Scenarios
    settle: float  # periods of the vibration that bring a scenario to its periodic state
    samples: int  # in the period after that


@dataclass(frozen=True)
class Part:
    """Of a group."""

    good: pa.Buffer  # a Parquet file: the scenarios and their results
    bad: pa.Buffer | None  # the same: the refused scenarios and why, if there are any
    refused: int
    seconds: float  # that the scenarios took on their worker


def silent(finished: int, refused: int) -> None:
    """Progress that nobody looks at."""


def run_group(job: Job, first: int, stop: int, progress: Progress = silent) -> Part:
    """Runs scenarios first to stop - 1 on one thread. Whatever progress raises ends them."""
    progress(0, 0)
    rows = {name: column.rows(first, stop) for name, column in job.scenarios.columns.items()}
    fmu = loaded_fmu(job.fmu, runner(resources.batch_host()))
    batch = prepared(fmu, rows, OUTPUTS, settle=job.settle, samples=job.samples, times=True)
    results = batch.run(threads=1, raises=False, progress=progress)
    reasons = pa.array(results.pop("reason"), pa.string())
    results["reduction"] = 100.0 * (1.0 - results["F_mean"] / results["reduction"])
    scenarios = {
        "scenario": pa.array(np.arange(first, stop)),
        **{name: job.scenarios.columns[name].shown(column) for name, column in rows.items()},
    }
    good = pa.table({**scenarios, **{name: results[name] for name in RESULTS}})
    refused = len(reasons) - reasons.null_count
    bad = None
    if refused:
        good = good.filter(reasons.is_null())
        bad = _parquet(pa.table({**scenarios, "reason": reasons}).filter(reasons.is_valid()))
    return Part(_parquet(good), bad, refused, float(np.nansum(results["seconds"])))


def _parquet(table: pa.Table) -> pa.Buffer:
    """Dictionaries serve names alone: numbers seldom come twice."""
    sink = pa.BufferOutputStream()
    names = [field.name for field in table.schema if pa.types.is_string(field.type)]
    pq.write_table(table, sink, use_dictionary=names, write_page_checksum=True)
    return sink.getvalue()
