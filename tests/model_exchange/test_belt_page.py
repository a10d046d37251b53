"""A mass held by friction, by one integrator: `python -m tools.bench.exchange`, docs/model-exchange.md."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import numpy as np
import pytest
from fmpy import simulate_fmu

from frictioncontact import ModelExchange
from frictioncontact.fmu import FrictionFmu
from tools.bench.exchange import CALLS, LAWS, Belt, Run, errors, exchange, reference, simulate
from tools.project import ROOT

PAGE = (ROOT / "docs" / "model-exchange.md").read_text(encoding="utf-8")
ROW = re.compile(r"\| (\w+) \| ((?:co-simulation|model exchange), .*?) \| (\d+) \| (\S+) \| (\S+) \|")
COUPLINGS = {"held values": "F_t held", "derivatives both ways": "F_t linear"}


def rows() -> Iterator[tuple[str, str, float, float, float]]:
    for law, way, *numbers in ROW.findall(PAGE):
        yield (law, way, *map(float, numbers))  # type: ignore[misc]


def again(fmu: FrictionFmu, belt: Belt, way: str, calls: float) -> Run:
    interface, how = way.split(", ")
    if interface == "co-simulation":
        coupling = COUPLINGS[how]
        return simulate(fmu, belt, coupling, int(calls) // CALLS[coupling])
    return exchange(fmu, belt, float(how.rpartition(" ")[2]))


@pytest.mark.parametrize("law", LAWS)
def test_table(fmu: FrictionFmu, law: str) -> None:
    """Calls to 5 %, errors to a third: where an integrator's steps fall is a matter of rounding.

    At 1e-11 both solutions of the whole, which share no code, are one.
    """
    belt = Belt(law=law)
    truth = reference(belt)
    of_law = [row for row in rows() if row[0] == law]
    assert len(of_law) == 4
    for _, way, calls, of_F_t, of_x in of_law:
        run = again(fmu, belt, way, calls)
        assert run.calls == pytest.approx(calls, rel=0.05), way
        assert errors(belt, run, truth) == pytest.approx((of_F_t, of_x), rel=0.35), way
    assert max(errors(belt, exchange(fmu, belt, 1e-11), truth)) < 1e-7


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
    with ModelExchange(
        start,
        own=(0.0, 0.0),
        inputs=lambda t, own: {"V": own[1]},
        rates=lambda t, own, F_t: (own[1], (pull(t) - F_t) / m),
        nominals=(F_C / sigma, F_C / math.sqrt(m * sigma)),
        fmu=fmu,
    ) as host:
        for n in range(1, 101):
            host.advance(100.0 * n)
            delta = host.get("delta")
            assert host.own[0] == pytest.approx(delta, rel=0, abs=1e-12 * F_C / sigma)
            assert sigma * delta == pytest.approx(pull(100.0 * n), rel=0, abs=1e-3 * F_C)
        assert host.events == 0
        assert host.get("solver.evaluations") < 20_000


def test_a_relative_tolerance_allows_more_error_of_an_energy_that_has_grown(fmu: FrictionFmu) -> None:
    """In FMPy's own loop over 200 periods, against co-simulation in one step; errors to a third, as above."""
    duration, V_1 = 200 * 5e-5, 0.3
    start = {"V": 5e-3, "contact.sigma": 50e6, "vibration.V_1": V_1}
    laws = {"friction.model": "ElasticPlastic", "contact.model": "Constant"}
    with fmu.session(start | laws | {"solver.tolerance": 1e-8}) as session:
        session.step(duration)
        work = session.get("W_f")
    said = re.search(
        r"errs by (\S+) % at the tolerance 1e-3, (\S+) % at 1e-4 and (\S+) % at 1e-6", " ".join(PAGE.split())
    )
    for tolerance, percent in zip((1e-3, 1e-4, 1e-6), said.groups(), strict=True):
        rows = simulate_fmu(
            str(fmu.path),
            fmi_type="ModelExchange",
            stop_time=duration,
            output_interval=5e-5 / 40,
            start_values=start | {"friction.model": 3, "contact.model": 2},
            relative_tolerance=tolerance,
            output=["F_t", "W_f"],
        )
        error = 100 * abs(rows["W_f"][-1] / work - 1)
        assert error == pytest.approx(float(percent), rel=0.35)
        V = 5e-3 + V_1 * np.cos(2 * np.pi * 20e3 * rows["time"])
        assert np.trapezoid(rows["F_t"] * V, rows["time"]) == pytest.approx(work, rel=5e-3)
