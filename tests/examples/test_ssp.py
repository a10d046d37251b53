"""The two .ssp files of the build: they err against the resolved systems as the pages of the examples say."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from workshop.project import ROOT

stick_slip = pytest.importorskip("stick_slip", reason="libcosimpy is not installed")
slider = pytest.importorskip("ultrasonic_slider", reason="libcosimpy is not installed")


def built(fmu_path: Path, name: str) -> Path:
    path = fmu_path.parent / "examples" / f"{name}.ssp"
    if not path.is_file():
        pytest.fail(f"{path} is missing: build it with scripts/run", pytrace=False)
    return path


def said(example: str, row: str) -> float:
    """The largest error of x over F_C/k of a row of the example's page."""
    page = (ROOT / "examples" / example / "README.md").read_text(encoding="utf-8")
    return float(re.search(rf"^\| {row} \| \**([\d.]+)", page, re.MULTILINE)[1])


def test_mass_on_a_belt(fmu_path: Path) -> None:
    step, count = 2e-4, 5000
    run = stick_slip.run_fmpy(built(fmu_path, "stick-slip"), step, count, [("mass", "x")])
    x, _, _ = stick_slip.reference(step * np.arange(1, count + 1))
    error = np.abs(run["mass", "x"] - x).max() / 1.1e-3  # F_C / k
    assert error == pytest.approx(said("stick-slip", "0.2 ms"), rel=0.02)


def test_ultrasonic_slider_in_libcosim(fmu_path: Path, tmp_path: Path) -> None:
    ssp = shutil.copy(built(fmu_path, "ultrasonic-slider"), tmp_path)  # it is unpacked beside itself
    error = slider.errors(slider.run_libcosim(Path(ssp), 1_000_000, 100, slider.SIGNALS), 1e-3)
    assert error == pytest.approx(said("ultrasonic-slider", r"F_t_mean \| \*\*1 ms\*\* \| 100"), rel=0.02)


def test_ultrasonic_slider_in_fmpy(fmu_path: Path) -> None:
    """fmpy leaves the force of the first step out, which moves x by up to F_C H / (m w): H w over F_C / k."""
    ssp, w = built(fmu_path, "ultrasonic-slider"), 100.0  # rad/s, the square root of k / m
    coarse, fine = (
        slider.errors(stick_slip.run_fmpy(ssp, step, round(0.1 / step), [("slider", "x")]), step)
        for step in (1e-3, 2e-4)
    )
    assert coarse < 1e-3 * w + said("ultrasonic-slider", r"F_t_mean \| \*\*1 ms\*\* \| 100")
    assert fine < 2e-4 * w + said("ultrasonic-slider", r"F_t_mean \| 0.2 ms \| 500")
    assert 0.9 < np.log(coarse / fine) / np.log(5) < 1.1
