"""Chunks of scenarios on the workers of a Dask cluster: processes of this machine, or a scheduler's.

A chunk whose worker dies is run again by another one. Chunks that keep losing their workers run at the end,
one scenario at a time, so that only the scenario that kills its workers is given up.
"""

from __future__ import annotations

import contextlib
import logging
import operator
from collections.abc import Iterator, Mapping, Sequence

import cloudpickle
import dask
from distributed import Client, Future, LocalCluster, as_completed
from distributed.client import FutureCancelledError
from distributed.comm import CommClosedError
from distributed.scheduler import KilledWorker

from frictionlab.sweep.plan import PlanError, Value

CONNECT_SECONDS = 5.0
Rows = list[dict[str, Value]]
Numbered = list[tuple[int, Mapping[str, Value]]]


class ClusterError(RuntimeError):
    """The cluster went away or can't do the work; the text is one line that says how."""


@contextlib.contextmanager
def connected(scheduler: str | None, workers: int) -> Iterator[Client]:
    """A client of the scheduler at this address, or of as many worker processes on this machine."""
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    for name in ("distributed.worker", "distributed.nanny", "distributed.scheduler", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    dask.config.set({"distributed.comm.timeouts.connect": CONNECT_SECONDS})
    if scheduler is None:
        # One death makes a chunk suspect: a worker that dies again and again as it starts can stall its
        # nanny.
        dask.config.set({"distributed.scheduler.allowed-failures": 0})
        cluster = LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None)
        with cluster, Client(cluster) as client:
            yield client
            with contextlib.suppress(TimeoutError):  # closing amid a worker's restart can fail
                client.wait_for_workers(workers, timeout=30)
        return
    try:
        client = Client(scheduler, timeout=CONNECT_SECONDS)
    except (OSError, ValueError) as error:
        reason = str(error).splitlines()[0] if isinstance(error, ValueError) else "nothing answers there"
        raise PlanError(f"--scheduler {scheduler}: {reason}") from None
    with client:
        if not client.scheduler_info(n_workers=-1)["workers"]:
            raise PlanError(f"--scheduler {scheduler}: has no workers")
        yield client


def run(client: Client, function: bytes, content: bytes, chunks: Sequence[Numbered]) -> Iterator[Rows]:
    """Rows of the chunks as they come: of a pickled function of the FMU's bytes and a chunk."""
    # Function and FMU are tasks of their own: what is lost with a worker is made again.
    work = client.submit(cloudpickle.loads, function, pure=True)
    fmu = client.submit(bytes, content, pure=True)

    def submit(chunk: Numbered) -> Future:
        return client.submit(operator.call, work, fmu, chunk, pure=False)

    submitted = {submit(chunk): chunk for chunk in chunks}
    suspects: Numbered = []
    for future in as_completed(list(submitted), raise_errors=False):
        chunk = submitted.pop(future)  # lets the cluster forget it
        rows = _result(future)
        if rows is None:
            suspects.extend(chunk)
        else:
            yield rows
    for index, values in suspects:
        rows = _result(submit([(index, values)]))
        yield rows or [{"scenario": index, **values, "reason": "every worker that ran this scenario died"}]


def _result(future: Future) -> Rows | None:
    """The rows, or None if too many workers died with them."""
    try:
        return future.result()
    except KilledWorker:
        return None
    except (CommClosedError, FutureCancelledError, OSError):
        raise ClusterError("the connection to the scheduler was lost") from None
    except Exception as error:
        raise ClusterError(f"a worker can't run the scenarios: {type(error).__name__}: {error}") from None
