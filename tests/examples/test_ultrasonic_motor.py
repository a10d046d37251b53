"""The ultrasonic motor: its rigid contact by quadrature, its course with every period resolved."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import odeint
from scipy.optimize import brentq
from scipy.special import i0

from tools.project import ROOT

FOLDER = ROOT / "examples" / "ultrasonic-motor"
sys.path.append(str(FOLDER))
import ultrasonic_motor as motor  # noqa: E402

PAGE = (FOLDER / "README.md").read_text(encoding="utf-8")
X = 3.0 * motor.A_D / 6e-6  # lambda a_d / R_q
PHASE = 2.0 * np.pi * (np.arange(200_000) + 0.5) / 200_000


def share(phase: np.ndarray) -> np.ndarray:
    """F_n over the load: it falls exponentially with the separation, which is least at phase 0."""
    return np.exp(X * np.cos(phase)) / i0(X)


def rigid(speed: float) -> float:
    """Mean of Coulomb friction [N] with a limit that moves with F_n."""
    return float(np.mean(motor.LIMIT * share(PHASE) * np.sign(motor.V_1 * np.cos(PHASE) - speed)))


def test_the_page_has_the_table_that_the_script_prints(fmu_path: Path) -> None:
    assert motor.table() in PAGE


def test_a_rigid_contact_by_quadrature(fmu_path: Path) -> None:
    start_values = motor.scene(1.0, "Coulomb")
    speeds = np.array([0.0, 0.05, 0.1, 0.2])
    truth = [rigid(speed) for speed in speeds]
    assert motor.thrust(start_values, speeds) == pytest.approx(truth, abs=2e-3)
    assert motor.speed_at(start_values) == pytest.approx(brentq(rigid, 0.0, 0.3, xtol=1e-7), abs=1e-5)
    output, efficiency = motor.power(start_values, speeds)
    assert output == pytest.approx(truth * speeds, abs=1e-3)
    for speed, force, found in zip(speeds, truth, efficiency, strict=True):
        slip = np.abs(motor.V_1 * np.cos(PHASE) - speed)
        heat = float(np.mean(motor.LIMIT * share(PHASE) * slip))
        assert found == pytest.approx(force * speed / (force * speed + heat), abs=1e-4)


def resolved(kappa: float, times: np.ndarray) -> np.ndarray:
    """Speeds [m/s] at the times: slider and bristle as one system, without the FMU."""
    assert times[0] == 0.0
    reach = motor.LIMIT / motor.stiffness(kappa)  # m: limit over stiffness, both of which move with F_n
    omega, mean = 2.0 * math.pi * motor.F, float(i0(X))

    def rates(t: float, y: np.ndarray) -> list[float]:
        speed, delta = y.tolist()
        V = motor.V_1 * math.cos(omega * t) - speed
        force = motor.LIMIT * math.exp(X * math.cos(omega * t)) / mean * delta / reach
        opposing = motor.OPPOSING if t > motor.LOADED_AT else 0.0
        return [(force - opposing) / motor.MASS, V - abs(V) * delta / reach]

    how = {"rtol": 1e-6, "atol": 1e-7 * np.array([1e-1, reach]), "hmax": 0.1 / motor.F, "mxstep": 10_000}
    return odeint(rates, [0.0, 0.0], times, tfirst=True, **how)[:, 0]


def test_the_slider_s_course(fmu_path: Path) -> None:
    """Speeds at the ends of periods, before and after the force that opposes."""
    start_values = motor.scene(10.0)
    times, speeds = motor.start_up(start_values)
    near = slice(0, 231, 10)
    fastest = motor.speed_at(start_values)
    assert speeds[near] == pytest.approx(resolved(10.0, times[near]), abs=0.01 * fastest)
    assert speeds[times <= motor.LOADED_AT][-1] == pytest.approx(fastest, rel=5e-3)
    assert speeds[-1] == pytest.approx(motor.speed_at(start_values, motor.OPPOSING), rel=5e-3)


def test_a_transverse_swing(fmu_path: Path) -> None:
    """The page's numbers; and Coulomb friction points against the velocity in the plane."""
    along = motor.V_1 * np.cos(PHASE)
    for phase_2 in (0.0, math.pi / 2):
        length = np.hypot(along, 0.3 * np.cos(PHASE + phase_2))
        truth = float(np.mean(motor.LIMIT * share(PHASE) * along / length))
        rigid_one = motor.scene(1.0, "Coulomb", V_2=0.3, phase_2=phase_2)
        assert float(motor.thrust(rigid_one, np.array(0.0))) == pytest.approx(truth, abs=1e-3)
        swings = motor.scene(10.0, V_2=0.3, phase_2=phase_2)
        assert f" {float(motor.thrust(swings, np.array(0.0))):.2f} N " in " ".join(PAGE.split())
        assert f" {1e3 * motor.speed_at(swings):.1f} mm/s" in " ".join(PAGE.split())
