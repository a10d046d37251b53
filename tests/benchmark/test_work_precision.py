"""scripts/work-precision: what it computes from its measurements, and that the page has it."""

from __future__ import annotations

import math

import pytest

from tools.bench import work_precision
from tools.bench.driver import Bench
from tools.bench.work_precision import Point, cost_at, period_cells, period_points, step_size_points


def made(error: float, cpu: float, failure: str = "") -> Point:
    return Point("case", "method", 0.0, error, error, cpu, 1.0, failure)


def test_the_cost_at_an_error_is_interpolated() -> None:
    """Settings that fail, or that cost more for less, do not count."""
    points = [made(1e-4, 1.0), made(1e-8, 100.0), made(1e-5, 500.0), made(1e-9, 1.0, "refused")]
    assert cost_at(points, 1e-6) == pytest.approx(10.0)
    assert cost_at(points, 1e-3) == 1.0  # loosest setting is better than asked
    assert math.isnan(cost_at(points, 1e-9))  # never reached


def test_held_inputs_are_of_order_1_and_linear_ones_of_order_2(bench: Bench) -> None:
    rows = step_size_points(bench, quick=True)
    for kind, order in (("held", 1), ("linear", 2)):
        coarse, fine = (row for row in rows if row["inputs"] == kind and row["samples_per_period"] != 5)
        for key in ("error_F_t", "error_F_t_mean"):
            slope = math.log(coarse[key] / fine[key]) / math.log(5)  # type: ignore[operator]
            assert slope == pytest.approx(order, abs=0.15)


def test_the_page_has_what_long_steps_cost(bench: Bench) -> None:
    """Evaluations over those of one held period; they differ a little between compilers."""
    page = work_precision.PAGE.read_text(encoding="utf-8")
    for law, limit, *costs in period_cells(period_points(bench, (1, 10**6))):
        (line,) = (line for line in page.splitlines() if line.startswith(f"| {law} | {limit} |"))
        printed = [float(cell.strip(" |")) for cell in line.split(" | ")[2:4]]
        assert printed == pytest.approx([float(cost) for cost in costs], rel=0.2), line


@pytest.mark.parametrize("headings", [work_precision.RATIO_COLUMNS, work_precision.PERIOD_COLUMNS])
def test_a_table_of_the_page_is_found_by_its_headings(headings: list[str]) -> None:
    """One row in place of its rows; nothing else changes."""
    page = work_precision.PAGE.read_text(encoding="utf-8")
    row = ["1"] * len(headings)
    changed = work_precision.with_table(page, headings, [row])
    new = f"| {' | '.join(row)} |"
    rest = set(page.splitlines()) - set(changed.splitlines())
    assert changed.splitlines().count(new) == 1 and len(rest) > 5
    assert all(line.count("|") == new.count("|") for line in rest)
