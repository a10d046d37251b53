"""The ultrasonic slider: 1 ms steps with F_t_mean follow the resolved system; with F_t they do not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

slider = pytest.importorskip("ultrasonic_slider", reason="libcosimpy is not installed")


def run(fmu_path: Path, folder: Path, force: str, step_ns: int, duration: float) -> np.ndarray:
    ssp = slider.make_ssp(fmu_path, folder, force)
    return slider.run_libcosim(ssp, step_ns, round(duration * 1e9) // step_ns, slider.SIGNALS)["slider", "x"]


def test_mean_force_over_1_ms_steps(fmu_path: Path, mass_on_belt: Path, tmp_path: Path) -> None:
    duration, step_ns = 0.02, 1_000_000
    _, y = slider.reference(duration, 21)

    def error(force: str, divisor: int) -> float:
        x = run(fmu_path, tmp_path, force, step_ns // divisor, duration)
        return float(np.abs(x[divisor - 1 :: divisor] - y[0][1:]).max() / 2.75e-3)

    with_mean, with_quarter_steps = error("F_t_mean", 1), error("F_t_mean", 4)
    assert with_mean < 0.05
    assert 0.9 < np.log(with_mean / with_quarter_steps) / np.log(4) < 1.1
    assert error("F_t", 1) > 0.2


def test_resolved_cosimulation_meets_the_reference(
    fmu_path: Path, mass_on_belt: Path, tmp_path: Path
) -> None:
    duration = 0.01
    _, y = slider.reference(duration, 11)
    x = run(fmu_path, tmp_path, "F_t", 1_250, duration)[799::800]
    assert np.abs(x - y[0][1:]).max() / 2.75e-3 < 1e-4
