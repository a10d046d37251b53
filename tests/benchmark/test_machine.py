"""The errors of masters on docs/machine.md are those that tools/bench/machine.py measures."""

from __future__ import annotations

import re

import pytest

from frictioncontact.advice.stuck_mass import GAUSS_SEIDEL, JACOBI, LINEAR
from frictioncontact.fmu import FrictionFmu
from tools.bench import machine
from tools.project import ROOT

PAGE = (ROOT / "docs" / "machine.md").read_text(encoding="utf-8")
ROW = re.compile(
    r"^\| (.+?), (?:T|[\d.]+ |tolerance|always).* \| (on|off) \| `\w+` \| [\d.]+ \| ([\d.]+) % \|$",
    re.MULTILINE,
)


def said(vibrates: bool, master: str) -> list[float]:
    """The errors [%] of a master's rows."""
    wanted = (master, "on" if vibrates else "off")
    return [float(error) for *row, error in ROW.findall(PAGE) if tuple(row) == wanted]


@pytest.mark.parametrize("vibrates", [False, True])
@pytest.mark.parametrize("master", [GAUSS_SEIDEL, LINEAR, JACOBI])
def test_the_page_says_what_a_master_errs_by(fmu: FrictionFmu, master: str, vibrates: bool) -> None:
    rows = [row for row in machine.ROWS if row[:2] == (master, vibrates)]
    found = []
    for _, _, output, H, sticks in rows:
        sigma_1 = machine.damping(master, output, H) if sticks else 0.0
        found.append(100.0 * machine.exchange(fmu, master, vibrates, output, H, sigma_1))
    assert found == pytest.approx(said(vibrates, master), rel=0.06)  # as the page rounds


def test_the_page_says_what_an_integrator_and_a_law_err_by(
    fmu: FrictionFmu, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With vibration, of which the first part is run, the integrator's error grows to the page's."""
    ((still,), (vibrating,)) = (said(vibrates, machine.MODEL_EXCHANGE) for vibrates in (False, True))
    assert 100.0 * machine.by_exchange(fmu, False, 1e-6) == pytest.approx(still, rel=0.5)  # where steps fall
    (stated,) = said(True, machine.OWN)
    assert 100.0 * machine.by_law() == pytest.approx(stated, rel=0.06)
    monkeypatch.setattr(machine, "END", 0.005)
    assert 100.0 * machine.by_exchange(fmu, True, 1e-6) < vibrating
