"""The ultrasonic slider against the system with every period resolved: the page's errors, in two importers.

And the slider that its friction law drives.
"""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

from tools.project import ROOT

slider = pytest.importorskip("ultrasonic_slider", reason="libcosimpy is not installed")
sys.path.append(str(ROOT / "examples" / "friction-law"))
import slider as by_law  # noqa: E402

from examples.systems import run_fmpy  # noqa: E402

PAGE = (ROOT / "examples" / "ultrasonic-slider" / "README.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| (F_t|F_t_mean) \| \**([\d.]+) ms\** \| (\d+) \| \**([\d.]+)", PAGE, re.MULTILINE)
X = [("slider", "x")]


@pytest.fixture(scope="module")
def ssp(fmu_path: Path, mass_on_belt: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The build's file of F_t_mean, in a folder in which it may be unpacked; the one of F_t is made there."""
    folder = tmp_path_factory.mktemp("slider")
    shutil.copy(fmu_path.parent / "examples" / "ultrasonic-slider.ssp", folder / "slider-F_t_mean.ssp")
    slider.make_ssp(fmu_path, folder, "F_t")
    return folder


@pytest.mark.parametrize(("output", "milliseconds", "count", "error"), ROWS)
def test_errors_are_the_page_s(ssp: Path, output: str, milliseconds: str, count: str, error: str) -> None:
    """In libcosim. With F_t_mean they fall with the step, with F_t they are wrong."""
    step = 1e-3 * float(milliseconds)
    run = slider.run_libcosim(ssp / f"slider-{output}.ssp", round(1e9 * step), int(count), slider.SIGNALS)
    assert slider.errors(run, step) == pytest.approx(float(error), rel=0.03)


def test_resolved_cosimulation_meets_the_reference(ssp: Path) -> None:
    """F_t in 40 steps a period, over a tenth of the time."""
    run = slider.run_libcosim(ssp / "slider-F_t.ssp", slider.RESOLVED_NS, 8000, slider.SIGNALS)
    assert slider.errors(run, 1e-9 * slider.RESOLVED_NS) < 1e-4


def test_fmpy_converges_to_the_same(ssp: Path) -> None:
    """It leaves the force of the first step out, which moves x by up to F_C H / (m w): H w over F_C / k."""
    w = 100.0  # rad/s, the square root of k / m
    said = {float(row[1]): float(row[3]) for row in ROWS if row[0] == "F_t_mean"}
    steps = (1.0, 0.2)  # ms
    coarse, fine = (
        slider.errors(run_fmpy(ssp / "slider-F_t_mean.ssp", 1e-3 * step, round(100 / step), X), 1e-3 * step)
        for step in steps
    )
    assert coarse < 1e-3 * w + said[1.0] and fine < 2e-4 * w + said[0.2]
    assert 0.9 < np.log(coarse / fine) / np.log(5) < 1.1


def test_its_friction_law_drives_it_in_a_few_calls() -> None:
    times, x, calls = by_law.slide()
    all_times, y = slider.reference()
    resolved = np.interp(times, all_times, y[0])
    assert calls < 150
    assert np.abs(x - resolved).max() * by_law.K / 55.0 < 3e-4
