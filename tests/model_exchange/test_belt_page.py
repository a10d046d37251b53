"""The numbers of docs/model-exchange.md: `python -m workshop.bench.exchange`, and an energy that grows."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
import pytest
from fmpy import simulate_fmu

from frictioncontact.fmu import FrictionFmu
from workshop.bench.exchange import CALLS, LAWS, LawBelt, Run, errors, exchange, reference, simulate
from workshop.project import ROOT

PAGE = (ROOT / "docs" / "model-exchange.md").read_text(encoding="utf-8")
ROW = re.compile(r"\| (\w+) \| ((?:co-simulation|model exchange), .*?) \| (\d+) \| (\S+) \| (\S+) \|")
COUPLINGS = {"held values": "F_t held", "derivatives both ways": "F_t linear"}


def rows() -> Iterator[tuple[str, str, float, float, float]]:
    for law, way, *numbers in ROW.findall(PAGE):
        yield (law, way, *map(float, numbers))  # type: ignore[misc]


def again(fmu: FrictionFmu, belt: LawBelt, way: str, calls: float) -> Run:
    interface, how = way.split(", ")
    if interface == "co-simulation":
        coupling = COUPLINGS[how]
        return simulate(fmu, belt, coupling, int(calls) // CALLS[coupling])
    return exchange(fmu, belt, float(how.rpartition(" ")[2]))


@pytest.mark.parametrize("law", LAWS)
def test_table(fmu: FrictionFmu, law: str) -> None:
    """Calls to 5 %, errors to a third: where an integrator's steps fall is a matter of rounding."""
    belt = LawBelt(law=law)
    truth = reference(belt)
    of_law = [row for row in rows() if row[0] == law]
    assert len(of_law) == 4
    for _, way, calls, of_F_t, of_x in of_law:
        run = again(fmu, belt, way, calls)
        assert run.calls == pytest.approx(calls, rel=0.05), way
        assert errors(belt, run, truth) == pytest.approx((of_F_t, of_x), rel=0.35), way


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
