"""Control-C and SIGTERM while a sweep runs: noted when they come, raised where nothing is cut in two by it.

Raised wherever they come, they would also fall into destructors and callbacks, where Python drops them, and
between the taking and the giving back of a lock of Dask's.
"""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from multiprocessing.resource_tracker import ensure_running
from queue import SimpleQueue
from typing import Generic, TypeVar

from frictionlab.project import UserError

SIGNALS = (signal.SIGINT, signal.SIGTERM)
Event = TypeVar("Event")


class Stop(Generic[Event]):
    """Whether an end was asked for, and a queue in which one can wait for events and for that."""

    def __init__(self) -> None:
        self._asked = False
        self._events: SimpleQueue[Event | None] = SimpleQueue()  # may be filled amid its own methods

    def ask(self, *_: object) -> None:
        """A handler of signals."""
        self._asked = True
        self._events.put(None)

    def check(self) -> None:
        """KeyboardInterrupt if an end was asked for."""
        if self._asked:
            raise KeyboardInterrupt

    def add(self, event: Event) -> None:
        """From any thread."""
        self._events.put(event)

    def wait(self) -> Event:
        """The next event; KeyboardInterrupt as soon as an end is asked for."""
        event = self._events.get()
        self.check()
        assert event is not None
        return event


@contextlib.contextmanager
def held_back() -> Iterator[Stop]:
    """Both signals, where they are heeded, only ask for an end; if nobody looked, it is raised at the end.

    What fails after it was asked for, fails because of it: the signal may have reached other processes too.
    """
    stop: Stop = Stop()
    heeded = [number for number in SIGNALS if signal.getsignal(number) is not signal.SIG_IGN]
    before = {number: signal.signal(number, stop.ask) for number in heeded}
    try:
        yield stop
    except UserError:
        stop.check()
        raise
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    stop.check()


@contextlib.contextmanager
def kept_from_children() -> Iterator[None]:
    """What is started meanwhile, and by threads that are, never gets a Control-C: it is this process's."""
    ensure_running()  # a process of its own, which lets Control-C in again where it is started
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
