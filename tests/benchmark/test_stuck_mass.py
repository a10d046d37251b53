"""A mass and a stuck contact that exchange values: edges of stability, the FMU's against eigenvalues."""

from __future__ import annotations

import math

import numpy as np
import pytest

from frictionlab.bench import advise
from frictionlab.bench.stuck_mass import (
    GAUSS_SEIDEL,
    JACOBI,
    LINEAR,
    REREAD,
    StuckMass,
    advice,
    best_damping,
    damping_range,
    exchange,
    grows,
    largest_step,
    light_damping,
    measured_edge,
    spectral_radius,
)
from frictionlab.fmu import FrictionFmu

M, SIGMA = 1.0, 1e6
TIME = math.sqrt(M / SIGMA)


def test_held_without_damping_grows_at_every_step(fmu: FrictionFmu) -> None:
    """sqrt(1 + H^2 sigma / m) a step: explicit Euler on the oscillator."""
    for fraction in (1e-3, 0.1, 1.0):
        H = fraction * TIME
        assert spectral_radius(StuckMass(M, SIGMA), JACOBI, H) == pytest.approx(
            math.sqrt(1 + fraction**2), rel=1e-12
        )
    speeds = np.abs(exchange(fmu, StuckMass(M, SIGMA), REREAD, 0.1 * TIME, 3000))
    peak = speeds[2900:].max() / speeds[:100].max()
    assert math.log(peak) / 2900 == pytest.approx(math.log(math.sqrt(1.01)), rel=0.02)


@pytest.mark.parametrize("fraction", [0.1, 0.3])
def test_reread_is_stable_between_its_two_formulas(fmu: FrictionFmu, fraction: float) -> None:
    H = fraction * TIME
    low, high = H * SIGMA, 2 * M / H + H * SIGMA / 2
    assert damping_range(M, SIGMA, REREAD, H) == pytest.approx((low, high), rel=1e-6)
    inside = StuckMass(M, SIGMA, best_damping(M, SIGMA, REREAD, H))
    for edge in (low, high):
        outside = StuckMass(M, SIGMA, 0.5 * edge if edge == low else 1.5 * edge)
        assert measured_edge(fmu, inside, outside, REREAD, H) == pytest.approx(edge, rel=0.02)


@pytest.mark.parametrize("fraction", [0.1, 0.3])
def test_plain_jacobi_is_stable_where_its_polynomial_says(fmu: FrictionFmu, fraction: float) -> None:
    """(x - 1)^2 + H^2 sigma / m + (H sigma_1 / m) (x - 1) / x = 0 has its roots in the unit circle."""
    H = fraction * TIME

    def radius(sigma_1: float) -> float:
        a, b = H**2 * SIGMA / M, H * sigma_1 / M
        return float(np.abs(np.roots([1.0, -2.0, 1.0 + a + b, -b])).max())

    low, high = damping_range(M, SIGMA, JACOBI, H)
    for edge in (low, high):
        assert radius(edge) == pytest.approx(1.0, abs=1e-6)
    inside = StuckMass(M, SIGMA, best_damping(M, SIGMA, JACOBI, H))
    for edge in (low, high):
        outside = StuckMass(M, SIGMA, 0.5 * edge if edge == low else 1.5 * edge)
        assert measured_edge(fmu, inside, outside, JACOBI, H) == pytest.approx(edge, rel=0.02)


def test_damping_outside_sets_the_held_step(fmu: FrictionFmu) -> None:
    """H < c / sigma."""
    H = 0.1 * TIME
    edge = measured_edge(fmu, StuckMass(M, SIGMA, 0.0, 4 * H * SIGMA), StuckMass(M, SIGMA), JACOBI, H)
    assert edge == pytest.approx(H * SIGMA, rel=0.02)


def test_gauss_seidel_needs_no_damping_up_to_twice_the_time(fmu: FrictionFmu) -> None:
    assert largest_step(M, SIGMA, GAUSS_SEIDEL) == pytest.approx(2 * TIME, rel=1e-6)
    assert not grows(fmu, StuckMass(M, SIGMA), GAUSS_SEIDEL, 1.98 * TIME)
    assert grows(fmu, StuckMass(M, SIGMA), GAUSS_SEIDEL, 2.02 * TIME)


def test_the_largest_steps_of_the_other_masters() -> None:
    assert largest_step(M, SIGMA, JACOBI) == pytest.approx(0.5 * TIME, rel=1e-3)
    assert largest_step(M, SIGMA, REREAD) == pytest.approx(2.0 * TIME, rel=5e-3)


def test_derivatives_help(fmu: FrictionFmu) -> None:
    H = 0.3 * TIME
    light = light_damping(M, SIGMA, LINEAR, H)
    assert light < 0.1 * light_damping(M, SIGMA, JACOBI, H)
    assert not grows(fmu, StuckMass(M, SIGMA, light), LINEAR, H)


def test_advice_is_stable_in_the_fmu(fmu: FrictionFmu, capsys: pytest.CaptureFixture[str]) -> None:
    advise.main(["--mass", "1", "--step", "1e-4", "contact.model=Constant", "contact.sigma=1e6"])
    text = capsys.readouterr().out
    sigma_1 = float(text.rsplit("friction.sigma_1", 1)[1])
    assert not grows(fmu, StuckMass(M, SIGMA, sigma_1), JACOBI, 1e-4)


def test_a_step_that_nothing_makes_stable_is_said() -> None:
    assert "no friction.sigma_1 does" in advice(M, SIGMA, JACOBI, 0.6 * TIME, {})


@pytest.mark.parametrize("words", [["--mass", "0", "--step", "1e-4"], ["--mass", "1"]])
def test_wrong_options_are_one_line(words: list[str]) -> None:
    with pytest.raises(SystemExit, match="--mass"):
        advise.main(words)
