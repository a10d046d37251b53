"""scripts/gap: what it prints and refuses."""

from __future__ import annotations

import re

import pytest

from frictionlab.contact import separation as gap
from frictionlab.contact.heights import load
from frictionlab.parameters import Surfaces


def test_load_gives_start_values_that_carry_it(capsys: pytest.CaptureFixture[str]) -> None:
    gap.main(["--load", "100"])
    d, E = re.search(r"start values: d (\S+)  E (\S+)", capsys.readouterr().out).groups()
    assert load(Surfaces(), float(d), float(E)) == pytest.approx(100.0, rel=1e-6)


def test_separation_gives_load(capsys: pytest.CaptureFixture[str]) -> None:
    gap.main(["--separation", "14e-6", "--R_q", "6e-6"])
    assert f"{load(Surfaces(), 14e-6):.4g}" in capsys.readouterr().out


@pytest.mark.parametrize("argv", [["--load", "-1"], ["--separation", "nan"], ["--load", "1", "--R_q", "0"]])
def test_values_that_are_not_positive_are_refused(
    argv: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as stop:
        gap.main(argv)
    assert stop.value.code == 2
    assert "is not a positive number" in capsys.readouterr().err


def test_load_out_of_reach_is_refused() -> None:
    with pytest.raises(SystemExit, match=r"error: load = 1e\+09 N is out of reach"):
        gap.main(["--load", "1e9"])
