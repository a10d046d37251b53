"""A mass held by friction, bristle and mass in one integrator."""

from __future__ import annotations

import math

import pytest

from frictioncontact.fmu import FrictionFmu
from workshop.bench.exchange import LAWS, LawBelt, against_cost, errors, exchange, reference
from workshop.exchange import Host


@pytest.mark.parametrize("law", LAWS)
def test_stick_and_slip_against_the_whole_system(fmu: FrictionFmu, law: str) -> None:
    """The error of F_t falls with the host's tolerance; the two solutions of the whole share no code."""
    belt = LawBelt(law=law)
    truth = reference(belt)
    for tolerance, allowed in ((1e-6, 1e-3), (1e-8, 1e-5), (1e-10, 1e-7)):
        of_F_t, of_x = errors(belt, exchange(fmu, belt, tolerance), truth)
        assert of_F_t < allowed and of_x < allowed, tolerance


def test_the_chart_has_the_error_of_each_tolerance_over_the_time_per_evaluation(fmu: FrictionFmu) -> None:
    belt = LawBelt()
    rows = against_cost(fmu)
    (row,) = (row for row in rows if 1e-4 < float(str(row["error_F_t"])) < 1e-3)  # of 1e-6
    run = exchange(fmu, belt, 1e-6)
    assert (row["error_F_t"], row["error_x"]) == errors(belt, run, reference(belt))
    assert row["H"] == belt.end / run.evaluations
    assert len(rows) == 3 and rows[-1]["error_F_t"] < 1e-5


def test_a_stuck_mass_does_not_creep(fmu: FrictionFmu) -> None:
    """1e4 s under a swinging force of up to 0.9 F_C: the mass moves as the bristle bends, and no more."""
    m, F_C, sigma = 1.0, 10.0, 1e6

    def pull(t: float) -> float:
        return 0.9 * F_C * math.sin(2 * math.pi * t / 700)

    start = {
        "friction.model": "ElasticPlastic",
        "contact.model": "Constant",
        "contact.sigma": sigma,
        "F_C": F_C,
        "friction.sigma_1": 2 * math.sqrt(m * sigma),  # critical: the host need not follow ringing
    }
    with Host(
        fmu,
        start,
        lambda t, own: {"V": own[1]},
        tolerance=1e-6,
        own=(0.0, 0.0),
        own_nominals=(F_C / sigma, F_C / math.sqrt(m * sigma)),
        own_rates=lambda t, own, F_t: (own[1], (pull(t) - F_t) / m),
    ) as host:
        for n in range(1, 101):
            host.advance(100.0 * n)
            (delta,) = host.get("delta")
            assert host.own[0] == pytest.approx(delta, rel=0, abs=1e-12 * F_C / sigma)
            assert sigma * delta == pytest.approx(pull(100.0 * n), rel=0, abs=1e-3 * F_C)
        assert host.events == 0
        assert host.get("solver.evaluations")[0] < 20_000
