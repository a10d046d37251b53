"""The fit that bench/identify-cost takes for comparison: scipy's, through one session a row."""

from __future__ import annotations

from pathlib import Path

import pytest

from frictionlab.bench import identify_cost
from frictionlab.fmu import FrictionFmu
from frictionlab.identify.data import read
from frictionlab.identify.experiment import Rows
from frictionlab.identify.fit import fit
from frictionlab.identify.parameter import parameter


def test_scipy_finds_the_same_values(fmu: FrictionFmu) -> None:
    named = [parameter(fmu, name, None, None, {}) for name in identify_cost.NAMES]
    result = fit(Rows(fmu, read(identify_cost.EXAMPLE, fmu, {}), named))
    assert result.values == pytest.approx(identify_cost.by_sessions(fmu, named), rel=1e-4)


def test_prints_its_table(fmu_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    identify_cost.main(["--quick", "--fmu", str(fmu_path)])
    lines = capsys.readouterr().out.splitlines()
    assert [line.split("  ")[0] for line in lines[1:]] == [
        "one open session a row",
        "fit with linear intervals",
        "and profiles, as scripts/identify does",
        "1000 refits",
    ]
