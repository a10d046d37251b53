"""Which scenarios are handed out next: runs of consecutive ones, of a size that takes a fair time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

Span = tuple[int, int]  # first scenario, and the one after the last

FIRST = 50  # scenarios, while nobody knows how long they take
MOST = 100_000  # bounds memory
SECONDS = 1.0  # what a chunk should take: soon there, and long against what it costs to hand it out


def missing(count: int, done: Iterable[Span]) -> list[Span]:
    """What is not done of so many scenarios; done spans may come in any order but do not overlap."""
    spans, at = [], 0
    for first, stop in sorted(done):
        if first > at:
            spans.append((at, first))
        at = max(at, stop)
    if at < count:
        spans.append((at, count))
    return spans


class Chunks:
    """Hands out the spans in pieces: of the given size, or of one that it learns, smaller towards the end."""

    def __init__(self, spans: Iterable[Span], size: int | None, workers: int) -> None:
        self._spans = list(reversed(list(spans)))
        self._fixed = size is not None
        self._size = size or FIRST
        self._least = 1
        self._left = sum(stop - first for first, stop in self._spans)
        self._workers = workers

    def learn(self, scenarios: int, seconds: float) -> None:
        """So many scenarios took so long on their worker."""
        if not self._fixed:
            fair = min(MOST, int(SECONDS * scenarios / max(seconds, 1e-9)))
            self._size = max(1, min(fair, 4 * self._size))
            self._least = max(1, self._size // 8)

    def __iter__(self) -> Iterator[Span]:
        while self._spans:
            first, stop = self._spans.pop()
            size = self._next_size()
            if stop - first > size:
                self._spans.append((first + size, stop))
                stop = first + size
            self._left -= stop - first
            yield first, stop

    def _next_size(self) -> int:
        """At the end half of what each worker still gets, so that all end together."""
        if self._fixed:
            return self._size
        return min(self._size, max(self._least, -(-self._left // (2 * self._workers))))
