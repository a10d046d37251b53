"""Who runs the groups of a sweep: threads of this process, or the workers of a Dask cluster."""

import copy
import logging
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from itertools import islice

from frictioncontact.errors import UserError
from frictioncontact.sweeps.group import Group, Job, Part, run_group

CONNECT_SECONDS = 10.0
GOES_ON = "what was computed is kept; the same sweep without --fresh goes on from there"
WAIT = 1.0  # s, between which Windows lets a Control-C through


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
