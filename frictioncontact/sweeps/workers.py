"""Who runs the groups of a sweep: threads of this process, or the workers of a Dask cluster."""

from __future__ import annotations

import copy
import itertools
import logging
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from typing import TYPE_CHECKING

from frictioncontact.errors import UserError
from frictioncontact.sweeps.folder import Group
from frictioncontact.sweeps.group import Job, Part, run_group

if TYPE_CHECKING:
    from distributed import Client

CONNECT_SECONDS = 5.0
WAIT = 1.0  # s
IN_HAND = 2  # groups of each worker: one that it runs, and one that waits


@dataclass(frozen=True)
class Workers:
    count: int
    submit: Callable[[Group], Future[Part]]
    died: tuple[type[Exception], ...] = ()  # what is raised where a group's workers died
    gone: tuple[type[Exception], ...] = ()  # and where the cluster is gone

    def run(self, groups: list[Group]) -> Iterator[tuple[Group, Part | None]]:
        """Every group as it is done; without a part where every worker that ran it died."""
        todo, suspects = iter(groups), []
        waiting = {self.submit(group): group for group in itertools.islice(todo, IN_HAND * self.count)}
        while waiting:
            # Windows lets a Control-C through only between two waits.
            done, _ = wait(waiting, timeout=WAIT, return_when=FIRST_COMPLETED)
            for future in done:
                group, part = waiting.pop(future), self._part(future)
                if part is None:
                    suspects.append(group)
                else:
                    yield group, part
                for following in itertools.islice(todo, 1):
                    waiting[self.submit(following)] = following
        for group in suspects:  # one by one: some only waited where another one killed the worker
            yield group, self._part(self.submit(group))

    def _part(self, future: Future[Part]) -> Part | None:
        try:
            return future.result()
        except self.died:
            return None
        except self.gone:
            raise UserError("the connection to the scheduler was lost") from None


class _Stopped(Exception):
    """Ends a group that nobody waits for any more."""


@contextmanager
def threads(job: Job, count: int) -> Iterator[Workers]:
    stopped = threading.Event()

    def check(finished: int, refused: int) -> None:
        if stopped.is_set():
            raise _Stopped

    pool = ThreadPoolExecutor(count)
    try:
        yield Workers(count, lambda group: pool.submit(run_group, job, *group, check))
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
        raise UserError("--cluster needs Dask: pip install distributed") from None
    for name in ("distributed", "distributed.client", "distributed.comm", "distributed.core",
                 "tornado.application", "asyncio"):  # fmt: skip
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what fails is told in one line
    try:
        client = Client(address, timeout=CONNECT_SECONDS)
    except (OSError, ValueError) as error:
        reason = str(error).splitlines()[0] if isinstance(error, ValueError) else "nothing answers there"
        raise UserError(f"--cluster {address}: {reason}") from None
    with client:
        _check(client, address)
        shared = client.submit(copy.copy, job, pure=False)  # a task: what is lost with a worker is made again
        executor = client.get_executor()
        yield Workers(
            sum(client.nthreads().values()),
            lambda group: executor.submit(run_group, shared, *group),
            (KilledWorker,),
            (CommClosedError, FutureCancelledError, CancelledError, OSError),
        )


def _check(client: Client, address: str) -> None:
    """That the scheduler and all workers have what run_group needs."""
    wanted = version("frictioncontact")

    def lacking() -> str:  # travels by value, to where this package may be missing
        try:
            from importlib.metadata import version

            import frictioncontact.sweeps.group  # noqa: F401

            found = version("frictioncontact")
        except ImportError as error:
            return str(error)
        return "" if found == wanted else f"its version is {found}"

    at_workers = client.run(lacking)
    if not at_workers:
        raise UserError(f"--cluster {address}: has no workers")
    for where, why in {"scheduler": client.run_on_scheduler(lacking), **at_workers}.items():
        if why:
            raise UserError(
                f"--cluster {address}: {where} lacks frictioncontact {wanted} ({why}): "
                f"pip install frictioncontact=={wanted} there"
            )
