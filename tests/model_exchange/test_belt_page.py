"""The table of docs/model-exchange.md has the numbers that `python -m workshop.bench.exchange` prints."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from frictioncontact.fmu import FrictionFmu
from workshop.bench.exchange import CALLS, LAWS, LawBelt, Run, errors, exchange, reference, simulate
from workshop.project import ROOT

ROW = re.compile(r"\| (\w+) \| ((?:co-simulation|model exchange), .*?) \| (\d+) \| (\S+) \| (\S+) \|")
COUPLINGS = {"held values": "F_t held", "derivatives both ways": "F_t linear"}


def rows() -> Iterator[tuple[str, str, float, float, float]]:
    for law, way, *numbers in ROW.findall((ROOT / "docs" / "model-exchange.md").read_text()):
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
