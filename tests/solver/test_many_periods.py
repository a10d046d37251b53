"""One communication step over many periods equals as many steps of one period."""

from __future__ import annotations

import pytest

from frictioncontact.fmu import FrictionFmu
from frictioncontact.parameters import IDENTIFIED, PRINTED, TABLE_2, ParameterSet, start_values

COUNT = 10_000
PERIOD = 1.0 / 20e3
SOFT = ParameterSet("soft", 0.5, 6e4, 1.0)
VERY_SOFT = ParameterSet("very soft", 0.5, 6.0, 1.0)  # a period relaxes by 1e-5


@pytest.mark.parametrize("parameters", [PRINTED, IDENTIFIED, SOFT, VERY_SOFT], ids=lambda p: p.name)
def test_many_steps_of_one_period_equal_one_step(fmu: FrictionFmu, parameters: ParameterSet) -> None:
    start = start_values(TABLE_2[1], parameters) | {"solver.tolerance": 1e-11}
    with fmu.session(start) as session:
        session.step(COUNT * PERIOD)
        once = session.get("F_t")
        mean_once, work_once = session.get("F_t_mean"), session.get("W_f")
    with fmu.session(start) as session:
        session.step_many(PERIOD, COUNT)
        stepped, work_stepped = session.get("F_t"), session.get("W_f")
        last_mean = session.get("F_t_mean")
    assert stepped == pytest.approx(once, abs=1e-9 * 55)
    assert work_stepped == pytest.approx(work_once, rel=1e-9)
    if parameters is not VERY_SOFT:
        return
    assert abs(last_mean - mean_once) > 1e-3  # the transient is long: the two means differ, as they must


@pytest.mark.parametrize("count", [1, 2, 3, 7, 1000])
def test_mean_over_periods_is_the_mean_of_the_means(fmu: FrictionFmu, count: int) -> None:
    start = start_values(TABLE_2[1], SOFT) | {"solver.tolerance": 1e-11, "delta_0": -5e-4}
    with fmu.session(start) as session:
        session.step(count * PERIOD)
        at_once = session.get("F_t_mean")
    with fmu.session(start) as session:
        total = 0.0
        for _ in range(count):
            session.step(PERIOD)
            total += session.get("F_t_mean")
    assert at_once == pytest.approx(total / count, abs=1e-9 * 55)


def test_a_million_periods_cost_what_one_costs(fmu: FrictionFmu) -> None:
    """In evaluations of the right-hand side, not in time."""
    start = start_values(TABLE_2[1], IDENTIFIED)

    def evaluations(periods: float) -> float:
        with fmu.session(start) as session:
            session.step(periods * PERIOD)
            return session.get("solver.evaluations")

    assert 0 < evaluations(1e6) <= 3 * evaluations(1)


def test_a_part_of_a_period_after_many(fmu: FrictionFmu) -> None:
    start = start_values(TABLE_2[1], IDENTIFIED) | {"solver.tolerance": 1e-11}
    with fmu.session(start) as session:
        session.step(1000.37 * PERIOD)
        at_once = session.get("F_t")
    with fmu.session(start) as session:
        session.step(1000.0 * PERIOD)
        session.step(1000.37 * PERIOD - 1000.0 * PERIOD)
        in_parts = session.get("F_t")
    assert in_parts == pytest.approx(at_once, abs=1e-9 * 55)
