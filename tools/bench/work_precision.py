"""Measures speed against accuracy. For each scene, every method of the FMU and its peers (Radau IIA of orders
5, 9 and 13 that stops at reversals, CVODE with its defaults) over tolerances or steps: CPU time, evaluations
of the right-hand side, and the largest error of F_t and of its mean against an independent reference. The
peers are not FMUs: the time of the FMI calls, measured with steps of length 0, is added to theirs. Then the
error against the communication step for held and linear inputs, and the cost of one step against the number
of vibration periods in it."""

import argparse
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from frictioncontact.command import as_table, progress_bar, say_written, table_console, write_csv
from frictioncontact.parameters import PERIOD, STIFFNESS_PRINTED
from frictioncontact.plausibility import FIXED_STEPS
from tools.bench import figures
from tools.bench.cases import PLAIN_PROGRAMS, SIGMAS, Case, cases, expected, plain, sampled, vibrating
from tools.bench.driver import Bench, Job, Outcome, bench_options, open_bench, renew_docs
from tools.project import ROOT

PAGE = ROOT / "docs" / "numerics.md"
MATCHED_ERRORS = (1e-6, 1e-9)
ERROR_OF_PAGE = 1e-6  # the default tolerance
DEFAULT, CALLS, BARE = "collocation", "calls", "best Radau without calls"
RADAU = ("Radau 5", "Radau 9", "Radau 13")
LAWS = ("Coulomb", "ElasticPlastic", "Dahl", "LuGre")
PERIODS = tuple(10**k for k in range(7))  # in one communication step
SLOW = 5e-4  # s per period: a slower setting is measured once


@dataclass(frozen=True)
class Effort:
    """How much is measured."""

    tolerances: Sequence[float]  # of the default, cvode and the peers in C
    steps: Sequence[int]  # internal steps per communication step
    rounds: int  # in which everything in C takes turns; the least time counts
    budget: float = 0.001  # s of CPU time for one setting in one round


FULL = Effort(10.0 ** -np.arange(2, 13), 4 ** np.arange(9), 4)
QUICK = Effort((1e-3, 1e-6, 1e-9, 1e-12), (1, 16, 256, 4096), 1)
QUICK_CASES = (vibrating(SIGMAS[1]).name, vibrating(SIGMAS[4]).name, "held")


@dataclass(frozen=True)
class Point:
    """A method at a setting on a case: largest errors from all starts, over F_C; costs of a period."""

    case: str
    method: str
    setting: float  # tolerance, or internal steps per communication step
    error_F_t: float
    error_F_t_mean: float
    cpu: float  # s
    evaluations: float
    failure: str = ""

    @property
    def error(self) -> float:
        return max(self.error_F_t, self.error_F_t_mean)


Run = Callable[[float], Outcome]  # from a start [s] for which there is a reference
References = Mapping[float, tuple[np.ndarray, np.ndarray]]


def tasks(bench: Bench, case: Case, effort: Effort) -> Iterator[tuple[str, float, Run]]:
    """Each method at each setting."""

    def fmu(method: str, name: str, value: float) -> Run:
        settings = {"solver.method": method, name: value}
        return lambda start: bench.run(case.job(start, effort.budget, settings))

    for tolerance in map(float, effort.tolerances):
        for method in ("collocation", "cvode"):
            yield method, tolerance, fmu(method, "solver.tolerance", tolerance)
        for method in PLAIN_PROGRAMS:
            yield method, tolerance, partial(plain, bench, method, case, tolerance, effort.budget)
    for steps, method in product(map(float, effort.steps), FIXED_STEPS):
        yield method, steps, fmu(method, "solver.stepSize", case.step / steps)


def measure(bench: Bench, case: Case, effort: Effort) -> list[Point]:
    """Every method at every setting, each with its least time of all rounds.

    The first point is that of the calls, with no error: steps of length 0, whose time the peers' hold too.
    """
    references = {start: expected(case, start) for start in case.starts}
    planned = list(tasks(bench, case, effort))
    points: list[Point] = []
    empty = replace(case.job(case.starts[0], effort.budget), calls=True)
    calls = math.inf
    for turn in range(effort.rounds):
        calls = min(calls, PERIOD / case.step * bench.run(empty).cpu)
        for k, task in enumerate(planned):
            if turn == 0:
                points.append(graded(case, references, *task))
            elif not points[k].failure and points[k].cpu < SLOW:
                cpu = graded(case, references, *task).cpu
                points[k] = replace(points[k], cpu=min(cpu, points[k].cpu))
    return [
        Point(case.name, CALLS, 0.0, math.nan, math.nan, calls, 0.0),
        *(replace(p, cpu=p.cpu + calls) if p.method in PLAIN_PROGRAMS else p for p in points),
    ]


def graded(case: Case, right: References, method: str, setting: float, run: Run) -> Point:
    """From every start of the case."""
    outcomes = [run(start) for start in right]
    for outcome in outcomes:
        if outcome.failure:
            return Point(case.name, method, setting, *[math.nan] * 4, outcome.failure)
    misses = np.array([(o.F, o.F_mean) for o in outcomes]) - [*right.values()]  # [start, which, step]
    errors = np.abs(misses).max(axis=(0, 2)) / case.F_C
    costs = np.median([(o.cpu, o.evaluations) for o in outcomes], axis=0)
    return Point(case.name, method, setting, *errors, *PERIOD / case.step * costs)


def cost_at(points: Sequence[Point], error: float) -> float:
    """CPU time [s] per period at which a method reaches the error: interpolated between its settings."""
    measured = sorted((p for p in points if not p.failure), key=lambda p: -p.error)
    front: list[Point] = []  # ever smaller errors at ever higher cost
    for p in measured:
        while front and front[-1].cpu >= p.cpu:
            front.pop()
        front.append(p)
    if not front or front[-1].error > error:
        return math.nan
    if front[0].error <= error:
        return front[0].cpu
    errors = [-math.log(max(p.error, 1e-17)) for p in front]
    return math.exp(np.interp(-math.log(error), errors, [math.log(p.cpu) for p in front]))


def step_size_points(bench: Bench, quick: bool) -> list[dict[str, object]]:
    """Error against the true vibration when V and d come from outside as samples, held or linear."""
    counts = (5, 20, 100) if quick else (5, 10, 20, 50, 100, 200, 400)
    rows: list[dict[str, object]] = []
    for sigma, n in product((6e6,) if quick else (6e6, 6e12), counts):
        inside = replace(sampled(n, sigma, False, 2), start_values=vibrating(sigma).start_values, inputs={})
        truth = expected(inside, 0.13 * PERIOD)
        for linear in (False, True):
            case = sampled(n, sigma, linear, periods=2)
            outcome = bench.run(case.job(0.0, 0.0, {"solver.tolerance": 1e-9}))
            misses = np.subtract((outcome.F, outcome.F_mean), truth)
            errors = (np.abs(misses).max(axis=1) / case.F_C).tolist()
            row = {"sigma": sigma, "samples_per_period": n, "inputs": "linear" if linear else "held"}
            rows.append(row | dict(zip(("error_F_t", "error_F_t_mean"), errors, strict=True)))
    return rows


def period_points(bench: Bench, counts: Sequence[int] = PERIODS) -> list[dict[str, object]]:
    """Cost of one step from rest over ever more vibration periods, in every law.

    V rises from 0.3 to 0.7 V_1 and the load falls by half within a moving step; in a held one they keep
    their means. Ratios are over one period with held inputs.
    """
    rows: list[dict[str, object]] = []
    samples = {"V": np.array([0.432, 1.008]), "load": np.array([300.0, 150.0])}
    for law, limit in product(LAWS, ("Constant", "Load")):
        values = {
            "friction.model": law,
            "friction.limit": limit,
            "friction.staticRatio": 1.5 if law in ("ElasticPlastic", "LuGre") else 1.0,
            "friction.V_S": 0.1,
            "contact.input": "Load",
            "contact.stiffnessScale": 6e6 / STIFFNESS_PRINTED,
            "vibration.V_1": 1.44,
            "vibration.a_d": 1.1e-6,
        }
        one: Outcome | None = None
        for kind, periods in product(("held", "moving"), counts):
            moves = kind == "moving"
            inputs = {name: ends if moves else np.full(2, ends.mean()) for name, ends in samples.items()}
            outcome = bench.run(Job(values, periods * PERIOD, inputs=inputs, linear=moves, budget=0.005))
            one = one or outcome
            ratio, cpu_ratio = outcome.evaluations / one.evaluations, outcome.cpu / one.cpu
            costs = {"evaluations": outcome.evaluations, "ratio": ratio, "cpu_ratio": cpu_ratio}
            row = {"law": law, "limit": limit, "inputs": kind, "periods": periods}
            rows.append({**row, **costs, "failure": outcome.failure})
    return rows


def ratios(points: Sequence[Point]) -> list[dict[str, object]]:
    """Cost of each method over that of collocation at each of the matched errors."""
    own: dict[str, dict[str, list[Point]]] = {}  # by case and method
    for p in points:
        own.setdefault(p.case, {}).setdefault(p.method, []).append(p)
    rows: list[dict[str, object]] = []
    for error, (case, methods) in product(MATCHED_ERRORS, own.items()):
        base = cost_at(methods[DEFAULT], error)
        calls = methods[CALLS][0].cpu / base
        row = {m: cost_at(its, error) / base for m, its in methods.items() if m not in (DEFAULT, CALLS)}
        row |= {"calls": calls, BARE: min((row[m] for m in RADAU if m in row), default=math.nan) - calls}
        rows.append({"error": error, "case": case, "collocation_us_per_period": 1e6 * base, **row})
    return rows


COLUMNS: dict[str, Sequence[str]] = {  # of the tables of ratios: the least of these methods
    **{name: (name,) for name in RADAU},
    "best, bare": (BARE,),
    "CVODE": ("plain CVODE",),
    "fixed step": FIXED_STEPS,
}
RATIO_COLUMNS = ["scene", "calls", *COLUMNS]
PERIOD_COLUMNS = ["law", "limit", "held", "moving"]


def ratio_cells(rows: Sequence[Mapping[str, Any]], error: float) -> list[list[str]]:
    """A line a scene: the calls' part of the default's time, and each peer's time over the default's."""
    return [
        [row["case"], f"{100 * row['calls']:.0f} %", *(cheapest(row, names) for names in COLUMNS.values())]
        for row in rows
        if row["error"] == error
    ]


def renew_tables(
    compared: Sequence[Mapping[str, Any]], periods: Sequence[Mapping[str, Any]], titles: Mapping[str, str]
) -> Path:
    """The tables of docs/numerics.md, by their headings: of speed, and of long steps."""
    text = PAGE.read_text(encoding="utf-8")
    rows = [[titles[name], *cells] for name, *cells in ratio_cells(compared, ERROR_OF_PAGE)]
    text = with_table(text, RATIO_COLUMNS, rows)
    text = with_table(text, PERIOD_COLUMNS, period_cells(periods))
    PAGE.write_text(text, encoding="utf-8")
    return PAGE


def with_table(text: str, headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """The text with this table in place of the one with the same headings."""
    head, *below = (f"| {' | '.join(line)} |\n" for line in (headings, ["---"] * len(headings), *rows))
    before, found, after = text.partition(head)
    if not found:
        raise ValueError(f"no table {headings}")
    return before + head + "".join(below) + re.sub(r"^(?:\|.*\n)*", "", after)


def period_cells(rows: Sequence[Mapping[str, Any]]) -> list[list[str]]:
    """A line a law and limit: evaluations of the longest step, held and moving."""
    longest = [row for row in rows if row["periods"] == PERIODS[-1]]
    held, moving = ([row for row in longest if row["inputs"] == kind] for kind in ("held", "moving"))
    cells = []
    for one, other in zip(held, moving, strict=True):
        costs = [f"{row['ratio']:#.3g}".rstrip(".") for row in (one, other)]
        cells.append([one["law"], one["limit"], *costs])
    return cells


def cheapest(row: Mapping[str, Any], names: Sequence[str]) -> str:
    """The least ratio of these methods."""
    least = min((row[name] for name in names if not math.isnan(row.get(name, math.nan))), default=math.nan)
    if math.isnan(least):
        return "not reached"
    return f"{least:.3g}" if least < 1000 else f"{least:.0f}"


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    return bench_options("work-precision", __doc__).parse_args(argv)


def run(options: argparse.Namespace) -> None:
    output, quick = options.output, options.quick
    chosen = [case for case in cases() if not quick or case.name in QUICK_CASES]
    points: list[Point] = []
    with progress_bar() as progress, open_bench(progress) as bench:
        for case in progress.track(chosen, description="Measuring"):
            points += measure(bench, case, QUICK if quick else FULL)
        step_sizes, periods = step_size_points(bench, quick), period_points(bench)
    compared, titles = ratios(points), {case.name: case.title for case in chosen}
    tables: dict[str, Sequence[Mapping[str, object]]]
    tables = {"work-precision": [*map(asdict, points)], "work-precision-ratios": compared}
    tables |= {"step-size": step_sizes, "periods": periods}
    written = [write_csv(rows, output / f"{name}.csv") for name, rows in tables.items()]
    written += figures.work_precision(points, titles, output)
    written += figures.step_sizes(step_sizes, output)
    written += figures.periods(periods, output)
    if options.docs:
        written += [*renew_docs(written), renew_tables(compared, periods, titles)]
    for error in MATCHED_ERRORS:
        title = f"CPU time over the default's, errors of at most {error:.0e} F_C"
        cells = ratio_cells(compared, error)
        table_console().print(as_table(["scene", "calls", *COLUMNS], cells, title))
    table_console().print(as_table(PERIOD_COLUMNS, period_cells(periods), "A step over 1e6 periods over one"))
    say_written(written)
