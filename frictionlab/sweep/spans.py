"""Which scenarios are handed out next: runs of consecutive ones, of a size that takes a fair time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

Span = tuple[int, int]  # first scenario, and the one after the last

FIRST = 50  # scenarios, while nobody knows how long they take
MOST = 20_000  # bounds memory
SECONDS = 0.5  # what a chunk should take: soon there, and long against what it costs to hand it out


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
    """Hands out the spans in pieces: of the given size, or of one that it learns."""

    def __init__(self, spans: Iterable[Span], size: int | None, workers: int) -> None:
        self._spans = list(reversed(list(spans)))
        self._fixed = size is not None
        left = sum(stop - first for first, stop in self._spans)
        self._most = min(MOST, max(1, -(-left // (2 * workers))))  # so that all workers have some
        self._size = size or min(FIRST, self._most)

    def learn(self, scenarios: int, seconds: float) -> None:
        """So many scenarios took so long on their worker."""
        if not self._fixed:
            fair = int(SECONDS * scenarios / max(seconds, 1e-9))
            self._size = max(1, min(fair, self._most, 4 * self._size))

    def __iter__(self) -> Iterator[Span]:
        while self._spans:
            first, stop = self._spans.pop()
            if stop - first > self._size:
                self._spans.append((first + self._size, stop))
                stop = first + self._size
            yield first, stop
