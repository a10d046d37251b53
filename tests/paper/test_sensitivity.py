"""The regimes: means and sensitivities of the FMU against reference and formulas, and the regime map."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from frictioncontact.parameters import COULOMB_FORCE, FREQUENCY
from workshop.reference import scene, settled
from workshop.regimes.mean import (
    PARAMETERS,
    REGIMES,
    V_1,
    Probe,
    Regime,
    coulomb_limit,
    coulomb_sensitivity,
    regime_map,
    soft_limit,
    soft_sensitivity,
)

ALPHA, PHASE = 1.1 / 6.0, 2.0


@pytest.fixture(scope="module")
def probe(fmu_path: Path) -> Probe:
    return Probe(fmu_path, tolerance=1e-9)


def expected(kappa: float, zeta: float) -> float:
    """By the reference, at a constant stiffness."""
    sigma = kappa * 2.0 * math.pi * FREQUENCY * COULOMB_FORCE / V_1
    moves = scene(V=zeta * V_1, V_1=V_1, f=FREQUENCY, F_C=COULOMB_FORCE, contact="Constant")
    moves.contact_sigma = sigma
    return settled(moves)[0] / COULOMB_FORCE


@pytest.mark.parametrize("kappa", [0.1, 1.0, 7.0, 300.0])
@pytest.mark.parametrize("zeta", [0.003, 0.3, 0.97])
def test_mean_is_that_of_the_reference(probe: Probe, kappa: float, zeta: float) -> None:
    assert probe.mean(Regime(kappa, zeta)) == pytest.approx(expected(kappa, zeta), abs=1e-8)


@pytest.mark.parametrize("zeta", [0.003, 0.3, 0.97])
def test_limits_are_those_of_the_reference(zeta: float) -> None:
    assert coulomb_limit(zeta) == pytest.approx(expected(1e8, zeta), rel=2e-3)
    mean_path = 2.0 / math.pi * (math.sqrt(1.0 - zeta**2) + zeta * math.asin(zeta))
    assert soft_limit(zeta) == pytest.approx(zeta / mean_path, rel=1e-5)
    assert soft_limit(zeta) == pytest.approx(expected(1e-3, zeta), rel=1e-5)


@pytest.mark.parametrize("alpha", [0.0, 0.02, ALPHA, 0.5])
def test_soft_limit_with_moving_separation_is_the_fmus(probe: Probe, alpha: float) -> None:
    """The distance to the limit goes with kappa, so two values extrapolate to it."""
    for phase in (0.0, 1.0, 4.0):
        one, two = (probe.mean(Regime(kappa, 0.3, alpha, phase)) for kappa in (1e-3, 2e-3))
        assert 2.0 * one - two == pytest.approx(soft_limit(0.3, alpha, phase), rel=2e-4)


@pytest.mark.parametrize("name", PARAMETERS)
def test_sensitivities_reach_their_limits(probe: Probe, name: str) -> None:
    soft = probe.sensitivity(Regime(1e-3, 0.3, ALPHA, PHASE), name)
    assert soft == pytest.approx(soft_sensitivity(0.3, name, ALPHA, PHASE), abs=1e-3)
    stiff = probe.sensitivity(Regime(1e7, 0.3, ALPHA, PHASE), name)
    assert stiff == pytest.approx(coulomb_sensitivity(0.3, name), abs=2e-3)


def test_sensitivity_to_the_stiffness_is_the_derivative_of_the_reference(probe: Probe) -> None:
    """E is proportional to sigma, but for the 0.01 % that A_r follows it."""
    h = 1e-3
    slope = (expected(math.exp(h), 0.3) - expected(math.exp(-h), 0.3)) / (2.0 * h)
    assert probe.sensitivity(Regime(1.0, 0.3), "E") == pytest.approx(slope, rel=2e-3)


@pytest.mark.parametrize("kappa", [0.1, 3.0, 100.0])
def test_sensitivities_obey_the_scaling_of_the_law(probe: Probe, kappa: float) -> None:
    """V, V_1 and F_C by one factor leave kappa and zeta, and multiply the mean: Euler's theorem."""
    regime = Regime(kappa, 0.3, ALPHA, PHASE)
    total = sum(probe.sensitivity(regime, name) for name in ("V", "V_1", "F_C"))
    assert total == pytest.approx(probe.mean(regime), abs=1e-5)


def test_regime_classes(probe: Probe) -> None:
    coulomb, dahl, moving, motor = range(len(REGIMES))
    assert regime_map(probe, [1e6], [0.3], 0.0).item() == coulomb
    assert regime_map(probe, [0.5], [0.3], 0.0).item() == dahl
    assert regime_map(probe, [0.5], [0.3], 0.1).item() == moving
    assert regime_map(probe, [5.0], [0.01], ALPHA).item() == motor
    assert regime_map(probe, [0.5], [1.4], 0.0).item() == coulomb


def test_motor_effect_turns_with_the_phase(probe: Probe) -> None:
    """At V = 0 half a period later is the mirror image: the mean changes its sign with the phase by pi."""
    for phase in (0.3, 1.7):
        forward = probe.mean(Regime(5.0, 0.0, ALPHA, phase))
        assert abs(forward) > 0.01
        assert probe.mean(Regime(5.0, 0.0, ALPHA, phase + math.pi)) == pytest.approx(-forward, abs=1e-7)


def test_limits_bracket_every_stiffness_with_constant_separation(probe: Probe) -> None:
    for zeta in np.linspace(0.01, 0.99, 9):
        for kappa in (0.03, 0.3, 3.0, 30.0):
            assert coulomb_limit(zeta) - 1e-8 <= probe.mean(Regime(kappa, zeta)) <= soft_limit(zeta) + 1e-5
