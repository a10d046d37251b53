"""A checked batch, run by the C runner on threads of this process."""

import ctypes
import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..errors import BatchError
from ..values import Variables
from .runner import DONE, REFUSED, STATISTICS, TEXT, Column, Plan, Result, Start

Progress = Callable[[int, int], None]  # is told how many scenarios are finished and how many of them refused
POLL = 0.05  # s between looks at the threads
FEW = 256  # steps that are done before a thread would have begun
STOP = 0.5  # s that threads have to come to the end of their step


@dataclass(frozen=True)
class Batch:
    """Scenarios of a shape; a column has a value for each, flat, or one for all."""

    runner: ctypes.CDLL
    fmu: int  # the runner's handle
    guid: bytes
    variables: Variables
    shape: tuple[int, ...]
    starts: dict[str, np.ndarray]
    settle: np.ndarray
    duration: np.ndarray
    samples: int
    read: dict[str, tuple[int, str]]  # result -> value reference, statistic
    frequency: int | None  # value reference; None: settle and duration are seconds
    inputs: tuple[int, ...] = ()  # value references of what is set before each step
    moves: np.ndarray | None = None  # [sample, input], of all scenarios
    rates: np.ndarray | None = None  # [sample, input], their time derivatives; None: held
    steps: np.ndarray | None = None  # lengths of the steps; None: all are duration / samples
    begin: float = 0.0  # s, when every scenario starts

    @property
    def scenarios(self) -> int:
        return math.prod(self.shape)

    def run(
        self, threads: int, raises: bool, progress: Progress = lambda finished, refused: None
    ) -> dict[str, np.ndarray]:
        """The results and "reason", of the batch's shape. BatchError at the first refusal, if asked for.

        A few steps are run without a thread.
        """
        try:
            running = _Running(self, raises)
        except MemoryError:
            raise BatchError(f"no memory for the results of {self.scenarios} scenarios") from None
        if self.scenarios * self.samples <= FEW and "solver.method" not in self.starts:
            running.work_here(progress)  # the cost of the default method does not grow with its steps
        elif self.scenarios:
            running.work(min(threads, self.scenarios), progress)
        try:
            return running.results(raises)
        finally:
            running.end()


@dataclass
class _Running:
    """The C runner's batch and all that it borrows."""

    batch: Batch
    raises: bool
    values: dict[str, np.ndarray] = field(init=False)
    failures: list[str] = field(default_factory=list)
    ended: list[int] = field(default_factory=list)  # threads that use it no longer

    def __post_init__(self) -> None:
        batch, self.runner = self.batch, self.batch.runner
        references = sorted({reference for reference, _ in batch.read.values()})
        self.values, results = {}, []
        for name, (reference, statistic) in batch.read.items():
            width = (batch.samples,) if statistic == "samples" else ()
            self.values[name] = array = np.full((batch.scenarios, *width), np.nan)
            results.append(
                Result(references.index(reference), STATISTICS.index(statistic), array.ctypes.data)
            )
        self.plan = Plan(
            guid=batch.guid,
            scenarios=batch.scenarios,
            starts=len(batch.starts),
            start=_array(Start, [self._start(name, column) for name, column in batch.starts.items()]),
            variables=len(references),
            variable=_array(ctypes.c_uint, references),
            results=len(results),
            result=_array(Result, results),
            begin=batch.begin,
            settle=_column(batch.settle),
            duration=_column(batch.duration),
            samples=batch.samples,
            inputs=len(batch.inputs),
            input=_array(ctypes.c_uint, list(batch.inputs)),
            moves=None if batch.moves is None else batch.moves.ctypes.data,
            rates=None if batch.rates is None else batch.rates.ctypes.data,
            step=None if batch.steps is None else batch.steps.ctypes.data,
            stops_at_refusal=self.raises,
        )
        if batch.frequency is not None:
            self.plan.frequency = ctypes.pointer(ctypes.c_uint(batch.frequency))
        self.handle = self.runner.batch_begin(batch.fmu, ctypes.byref(self.plan))
        if not self.handle:
            raise BatchError(f"no memory for {batch.scenarios} scenarios")

    def _start(self, name: str, column: np.ndarray) -> Start:
        variable = self.batch.variables.all[name]
        return Start(variable.valueReference, variable.type != "Real", _column(column))

    def work(self, threads: int, progress: Progress) -> None:
        """Until no scenario is left. Whatever is raised meanwhile ends the threads first."""
        workers = [threading.Thread(target=self._work, daemon=True) for _ in range(threads)]
        begun = 0
        try:
            for worker in workers:
                begun += 1
                worker.start()
            for worker in workers:
                while worker.is_alive():
                    worker.join(POLL)
                    self._tell(progress)
            self._tell(progress)
        except BaseException:
            self.runner.batch_stop(self.handle)
            until = time.monotonic() + STOP
            while len(self.ended) < begun and time.monotonic() < until:
                time.sleep(0.001)
            # A thread in a long step, or one about to begin, still uses the batch through its own reference.
            if len(self.ended) == begun:
                self.end()
            raise

    def work_here(self, progress: Progress) -> None:
        self._work()
        self._tell(progress)

    def _tell(self, progress: Progress) -> None:
        progress(self.runner.batch_finished(self.handle), self.runner.batch_refusals(self.handle))

    def _work(self) -> None:
        why = ctypes.create_string_buffer(TEXT)
        try:
            if not self.runner.batch_work(self.handle, why, TEXT):
                self.failures.append(why.value.decode(errors="replace"))
                self.runner.batch_stop(self.handle)
        finally:
            self.ended.append(threading.get_ident())

    def results(self, raises: bool) -> dict[str, np.ndarray]:
        if self.failures:
            raise BatchError(self.failures[0])
        batch = self.batch
        shaped = {name: array.reshape(batch.shape + array.shape[1:]) for name, array in self.values.items()}
        reasons = np.full(batch.scenarios, None, dtype=object)
        if not self.runner.batch_refusals(self.handle):
            assert self.runner.batch_finished(self.handle) == batch.scenarios
            return shaped | {"reason": reasons.reshape(batch.shape)}
        status = np.ctypeslib.as_array(self.runner.batch_statuses(self.handle), (batch.scenarios + 1,))[:-1]
        refused = np.flatnonzero(status == REFUSED)
        if raises and len(refused):
            row = [int(i) for i in np.unravel_index(refused[0], batch.shape)]
            named = f"scenario {row[0] if len(row) == 1 else tuple(row)}: " if row else ""
            raise BatchError(named + self._reason(refused[0]))
        for row in refused:
            reasons[row] = self._reason(row)
        assert np.all((status == DONE) | (status == REFUSED))
        return shaped | {"reason": reasons.reshape(batch.shape)}

    def _reason(self, row: int) -> str:
        return self.runner.batch_reason(self.handle, int(row)).decode(errors="replace")

    def end(self) -> None:
        if self.handle:
            self.runner.batch_end(self.handle)
            self.handle = None


def _column(array: np.ndarray) -> Column:
    address, _ = array.__array_interface__["data"]  # sooner than array.ctypes.data
    return Column(address, 0 if array.size == 1 else 1)


def _array(kind: type, items: list) -> ctypes.Array:
    return (kind * max(1, len(items)))(*items)
