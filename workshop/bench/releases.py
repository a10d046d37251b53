"""What the default costs in this build and in another release, both taking turns."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from rich.table import Table

from frictioncontact.command import as_table
from frictioncontact.fmu import FrictionFmu
from workshop.bench.cases import Case, expected
from workshop.bench.driver import Bench, Outcome
from workshop.bench.grade import Point, References, grade_point

TURNS = 5
SHOWN = (1e-3, 1e-6, 1e-9)


def compare(
    bench: Bench, against: Path | None, cases: Sequence[Case], tolerances: Sequence[float], budget: float
) -> list[Point]:
    """The default of this build and, if there is one, of the FMU against which it is held; in turns.

    The points' methods are the versions, this build's first; their CPU time is the least of several turns.
    """
    with ExitStack() as stack:
        benches = {_name(bench): bench}
        if against is not None:
            other = Bench(stack.enter_context(FrictionFmu(against)), bench.programs)
            name = _name(other)
            benches[name if name not in benches else f"{name} ({against.name})"] = other
        return [point for case in cases for point in _of_case(benches, case, tolerances, budget / TURNS)]


def _name(bench: Bench) -> str:
    return f"version {bench.fmu.description.version}"


def _of_case(
    benches: dict[str, Bench], case: Case, tolerances: Sequence[float], budget: float
) -> Iterator[Point]:
    references = {start: expected(case, start) for start in case.starts}
    for tolerance in tolerances:
        yield from _in_turns(benches, case, references, tolerance, budget)


def _in_turns(
    benches: dict[str, Bench], case: Case, references: References, tolerance: float, budget: float
) -> Iterator[Point]:
    best: dict[tuple[str, float], Outcome] = {}
    for _ in range(TURNS):
        for start in references:
            for name, bench in benches.items():
                outcome = bench.run(case.job(start, budget, solver__tolerance=tolerance))
                known = best.get((name, start), outcome)
                best[name, start] = replace(outcome, cpu=min(outcome.cpu, known.cpu))
    for name in benches:
        yield grade_point(case, references, name, tolerance, lambda start, name=name: best[name, start])


def table(points: Sequence[Point]) -> Table:
    """Evaluations of both releases and the ratio of their times."""
    own, other = dict.fromkeys(p.method for p in points)
    title = f"Evaluations of the default in {own} and in {other}, and how many times faster it is"
    tolerances = [t for t in dict.fromkeys(p.setting for p in points) if t in SHOWN]
    at = {(p.case, p.setting, p.method): p for p in points}
    rows = []
    for case in dict.fromkeys(p.case for p in points):
        cells = []
        for tolerance in tolerances:
            new, old = (at[case, tolerance, name] for name in (own, other))
            cells.append(f"{new.evaluations:.0f} of {old.evaluations:.0f}, {old.cpu / new.cpu:.2g} times")
        rows.append([case, *cells])
    return as_table(["scene", *(f"{tolerance:.0e}" for tolerance in tolerances)], rows, title)
