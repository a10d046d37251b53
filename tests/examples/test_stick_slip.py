"""The stick-slip example: two importers agree, and the coupling converges to the system solved at once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

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


def test_start_values_reach_both_fmus(ssp: Path) -> None:
    """The mass starts with the belt: no sliding, no force."""
    run = stick_slip.run_libcosim(ssp, 1_000_000, 2, (("mass", "v"), ("contact", "F_t"), ("contact", "V")))
    assert run["contact", "F_t"][0] == run["contact", "V"][0] == 0.0
    assert run["mass", "v"][0] == pytest.approx(0.01, rel=0.02)
