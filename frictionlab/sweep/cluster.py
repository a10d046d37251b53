"""Chunks of scenarios on the workers of a Dask cluster: processes of this machine, or a scheduler's.

A chunk whose worker dies runs at the end in a process of its own here, and is halved each time that this
dies too, until only the scenario that kills its process is given up.
"""

from __future__ import annotations

import contextlib
import copy
import itertools
import logging
import os
import signal
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path

import dask
import numpy as np
from distributed import Client, Future, LocalCluster
from distributed.client import FutureCancelledError
from distributed.comm import CommClosedError
from distributed.scheduler import KilledWorker

from frictionlab.project import UserError
from frictionlab.sweep.scenario import RESULTS, Results
from frictionlab.sweep.spans import Chunks, Span
from frictionlab.sweep.stop import Stop, kept_from_children

CONNECT_SECONDS = 5.0
IN_HAND = 2  # chunks of each worker: one that it runs, and one that waits there


class ClusterError(UserError):
    """The cluster went away or can't do the work; the text is one line that says how."""


@contextlib.contextmanager
def connected(scheduler: str | None, workers: int, folder: Path) -> Iterator[Client]:
    """A client of the scheduler at this address, or of so many processes here, which use the folder."""
    for name in ("", ".worker", ".nanny", ".scheduler", ".client", ".comm", ".core"):
        logging.getLogger("distributed" + name).setLevel(logging.CRITICAL)
    for name in ("tornado.application", "asyncio"):  # they tell of tasks that lost their worker
        logging.getLogger(name).setLevel(logging.CRITICAL)
    dask.config.set({"distributed.comm.timeouts.connect": CONNECT_SECONDS})
    if scheduler is None:
        with _temporary_files_in(folder), _local(workers, folder) as client:
            yield client
        return
    try:
        client = Client(scheduler, timeout=CONNECT_SECONDS)
    except (OSError, ValueError) as error:
        reason = str(error).splitlines()[0] if isinstance(error, ValueError) else "nothing answers there"
        raise UserError(f"--scheduler {scheduler}: {reason}") from None
    with client:
        if not client.scheduler_info(n_workers=-1)["workers"]:
            raise UserError(f"--scheduler {scheduler}: has no workers")
        yield client


@contextlib.contextmanager
def _temporary_files_in(folder: Path) -> Iterator[None]:
    """Those of processes that start meanwhile: what a killed one leaves is removed with the folder."""
    before = os.environ.get("TMPDIR")
    os.environ["TMPDIR"] = str(folder)
    try:
        yield
    finally:
        del os.environ["TMPDIR"]
        if before is not None:
            os.environ["TMPDIR"] = before


@contextlib.contextmanager
def _local(workers: int, folder: Path) -> Iterator[Client]:
    dask.config.set(
        {
            # One death makes a chunk suspect: a worker that dies again and again can stall its nanny.
            "distributed.scheduler.allowed-failures": 0,
            "distributed.nanny.pre-spawn-environ": {"DASK_LOGGING__DISTRIBUTED": "critical"},
            "temporary-directory": str(folder),
            # What watches the workers all the time costs more than handing out the work.
            "distributed.worker.profile.enabled": False,
            "distributed.admin.system-monitor.interval": "5s",
            "distributed.admin.tick.interval": "1s",
        }
    )
    os.environ.setdefault("PYTHONWARNINGS", "ignore")  # what is killed says nothing of it
    try:
        with kept_from_children():
            cluster = LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                memory_limit=0,  # a chunk's is bounded; to watch it ten times a second costs more
                dashboard_address="localhost:0",
            )
    except (OSError, RuntimeError) as error:
        raise UserError(
            "worker processes here can't be reached through the loopback interface: "
            f"{error.__cause__ or error}"
        ) from None
    with cluster, Client(cluster, direct_to_workers=True) as client:
        try:
            yield client
        except BaseException:
            _kill(cluster)
            raise
        with contextlib.suppress(TimeoutError):  # closing amid a worker's restart can fail
            client.wait_for_workers(workers, timeout=30)


def _kill(cluster: LocalCluster) -> None:
    """Ends the workers in the midst of their work."""
    for nanny in cluster.workers.values():
        nanny.auto_restart = False
        if nanny.pid:
            with contextlib.suppress(ProcessLookupError):
                os.kill(nanny.pid, signal.SIGKILL)


def run(
    client: Client,
    function: Callable[[object, Mapping[str, np.ndarray]], Results],
    work: object,
    values: Callable[[Span], Mapping[str, np.ndarray]],
    chunks: Chunks,
    stop: Stop[Future] | None = None,
) -> Iterator[tuple[Span, Results]]:
    """Results of function(work, values(chunk)) for all chunks, as they come, until an end is asked for."""
    stop = stop or Stop()
    # The work is a task of its own: what is lost with a worker is made again.
    shared = client.submit(copy.copy, work, pure=False)
    todo = iter(chunks)

    submitted: dict[Future, Span] = {}

    def submit(count: int) -> None:
        for span in itertools.islice(todo, count):
            future = client.submit(function, shared, values(span), pure=False)
            submitted[future] = span
            future.add_done_callback(stop.add)

    submit(IN_HAND * sum(client.nthreads().values()))
    suspects: list[Span] = []
    while submitted:
        future = stop.wait()
        span = submitted.pop(future)
        results = _result(future)
        if results is None:
            suspects.append(span)
        else:
            chunks.learn(span[1] - span[0], float(np.sum(results.columns["seconds"])))
            yield span, results
        del future  # lets the cluster forget it
        submit(1)
    yield from _alone(function, work, values, suspects, stop)


def _alone(
    function: Callable[[object, Mapping[str, np.ndarray]], Results],
    work: object,
    values: Callable[[Span], Mapping[str, np.ndarray]],
    suspects: list[Span],
    stop: Stop[Future],
) -> Iterator[tuple[Span, Results]]:
    """Chunks whose workers died, in processes of their own here; halved each time that one dies."""
    while suspects:
        with ProcessPoolExecutor(1, get_context("spawn")) as pool:
            while suspects:
                stop.check()
                first, end = suspects.pop()
                try:
                    with kept_from_children():
                        task = pool.submit(function, work, values((first, end)))
                    results = task.result()
                except BrokenProcessPool:
                    break
                yield (first, end), results
            else:
                return
        if end - first == 1:
            yield (first, end), given_up()
        else:
            middle = (first + end) // 2
            suspects += [(middle, end), (first, middle)]


def given_up() -> Results:
    """Of a scenario that no worker survives."""
    columns = {name: np.full(1, np.nan) for name in RESULTS}
    return Results(columns, {0: "every process that ran this scenario died"})


def _result(future: Future) -> Results | None:
    """The results, or None if too many workers died with them."""
    try:
        return future.result()
    except KilledWorker:
        return None
    except (CommClosedError, FutureCancelledError, OSError):
        raise ClusterError("the connection to the scheduler was lost") from None
    except Exception as error:
        raise ClusterError(f"a worker can't run the scenarios: {type(error).__name__}: {error}") from None
