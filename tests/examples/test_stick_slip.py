"""The stick-slip example: two importers agree, and the coupling converges to the system solved at once."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from workshop.project import ROOT

stick_slip = pytest.importorskip("stick_slip", reason="libcosimpy is not installed")


@pytest.fixture(scope="module")
def ssp(fmu_path: Path, mass_on_belt: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return stick_slip.make_ssp(fmu_path, tmp_path_factory.mktemp("stick-slip") / "stick-slip.ssp")


def test_libcosim_and_fmpy_agree(ssp: Path) -> None:
    assert stick_slip.importers_differ(ssp) < 1e-9  # N, of 55


def test_coupling_error_is_of_first_order(ssp: Path) -> None:
    coarse, fine, finest = stick_slip.measure(ssp, (400_000, 100_000, 25_000))
    for name in ("largest error of x over F_C/k", "rms error of F_t over F_C"):
        orders = np.log([coarse[name] / fine[name], fine[name] / finest[name]]) / np.log(4)
        assert 0.85 < orders[1] < 1.15, name
        assert 0.8 < orders[0] < 1.4, name
    assert finest["largest error of x over F_C/k"] < 0.006


def test_the_build_s_file_errs_as_the_page_says(fmu_path: Path) -> None:
    """In fmpy, over F_C / k."""
    page = (ROOT / "examples" / "stick-slip" / "README.md").read_text(encoding="utf-8")
    step, count = 2e-4, 5000
    built = fmu_path.parent / "examples" / "stick-slip.ssp"
    run = stick_slip.run_fmpy(built, step, count, [("mass", "x")])
    x, _, _ = stick_slip.reference(step * np.arange(1, count + 1))
    said = float(re.search(r"^\| 0.2 ms \| ([\d.]+)", page, re.MULTILINE)[1])
    assert np.abs(run["mass", "x"] - x).max() / 1.1e-3 == pytest.approx(said, rel=0.02)
