"""Who runs the groups of a sweep, threads here or the workers of a Dask cluster, and what they do."""

from __future__ import annotations

import copy
import logging
import threading
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from frictioncontact.batch import simulate_many
from frictioncontact.batch.many import Output
from frictioncontact.batch.run import Progress
from frictioncontact.errors import UserError, quiet
from frictioncontact.periodic import STILL, reduction
from frictioncontact.sweeps.scenarios import Rows
from frictioncontact.values import Value

if TYPE_CHECKING:
    import pyarrow as pa

CONNECT_SECONDS = 10.0
GOES_ON = "what was computed is kept; the same sweep without --fresh goes on from there"
WAIT = 1.0  # s, between which Windows lets a Control-C through
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


@dataclass(frozen=True)
class Workers:
    count: int
    submit: Callable[[Group], Future[Part]]

    def run(self, groups: list[Group]) -> Iterator[tuple[Group, Part]]:
        """Every group as it is done. Each worker has one that it runs and one that waits."""
        todo = iter(groups)
        waiting = {self.submit(group): group for group in islice(todo, 2 * self.count)}
        while waiting:
            for future in wait(waiting, timeout=WAIT, return_when=FIRST_COMPLETED).done:
                yield waiting.pop(future), future.result()
                waiting |= {self.submit(group): group for group in islice(todo, 1)}


@contextmanager
def threads(job: Job, count: int) -> Iterator[Workers]:
    stopped = threading.Event()

    def check(finished: int, refused: int) -> None:
        if stopped.is_set():
            raise CancelledError

    pool = ThreadPoolExecutor(count)
    try:
        yield Workers(count, lambda group: pool.submit(run_group, job, group, check))
    finally:
        stopped.set()
        pool.shutdown(cancel_futures=True)


@contextmanager
def cluster(job: Job, address: str) -> Iterator[Workers]:
    """The workers of the scheduler at this address, which need this package, of this version."""
    try:
        from distributed import Client
        from distributed.client import FutureCancelledError
        from distributed.comm import CommClosedError
        from distributed.scheduler import KilledWorker
    except ImportError:
        raise UserError("cluster needs Dask: pip install distributed") from None
    for name in ("distributed", "distributed.client", "distributed.comm", "distributed.core",
                 "tornado.application", "asyncio"):  # fmt: skip
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what fails is told in one line
    try:
        client = Client(address, timeout=CONNECT_SECONDS)
    except (OSError, TypeError, ValueError) as error:
        reason = str(error).splitlines()[0] if not isinstance(error, OSError) else "nothing answers there"
        raise UserError(f"cluster {address}: {reason}") from None
    with client:
        try:
            _check(client.get_versions(packages=["frictioncontact", "pyarrow"]), address)
            shared = client.submit(copy.copy, job, pure=False)  # a task: made again if lost with a worker
            executor = client.get_executor()
            count = sum(client.nthreads().values())
            yield Workers(count, lambda group: executor.submit(run_group, shared, group))
        except KilledWorker:
            raise UserError(f"cluster {address}: worker after worker died of a group; {GOES_ON}") from None
        except (CommClosedError, FutureCancelledError, CancelledError, OSError):
            raise UserError(f"cluster {address}: the connection was lost; {GOES_ON}") from None


def _check(found: dict, address: str) -> None:
    """That the scheduler and all workers have what run_group needs."""
    if not found["workers"]:
        raise UserError(f"cluster {address}: has no workers")
    wanted = version("frictioncontact")
    for where, has in {"scheduler": found["scheduler"], **found["workers"]}.items():
        if has["packages"]["frictioncontact"] != wanted or not has["packages"]["pyarrow"]:
            raise UserError(
                f"cluster {address}: {where} lacks frictioncontact {wanted} with its sweeps: "
                f"pip install 'frictioncontact[sweep]=={wanted}' there"
            )
