"""The regimes: means and sensitivities of the FMU against reference and formulas, and the regime map."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from figures.report import regimes
from figures.report.regimes import (
    CONSTANT,
    COULOMB,
    MOTOR,
    MOVING,
    SYMBOLS,
    coulomb_limit,
    regime_map,
    scene,
    sensitivity,
    soft_limit,
)
from frictioncontact.parameters import COULOMB_FORCE, FREQUENCY
from tools import reference

ALPHA, PHASE = 1.1 / 6.0, 2.0
Mean = Callable[[dict], np.ndarray]


@pytest.fixture(scope="module")
def mean(fmu_path: Path) -> Mean:
    return lambda values: regimes.mean(fmu_path, {**values, "solver.tolerance": 1e-9})


def expected(kappa: float, zeta: float) -> float:
    """By the reference, at a constant stiffness."""
    sigma = kappa * 2.0 * math.pi * FREQUENCY * COULOMB_FORCE  # V_1 = 1 m/s
    one = reference.scene(
        V=zeta, V_1=1.0, f=FREQUENCY, F_C=COULOMB_FORCE, contact="Constant", contact_sigma=sigma
    )
    return reference.settled(one)[0] / COULOMB_FORCE


@pytest.mark.parametrize("zeta", [0.003, 0.3, 0.97])
def test_mean_and_limits_are_those_of_the_reference(mean: Mean, zeta: float) -> None:
    for kappa in (0.1, 7.0, 300.0):
        assert mean(scene(kappa, zeta)) == pytest.approx(expected(kappa, zeta), abs=1e-8)
    assert coulomb_limit(scene(0, zeta)) == pytest.approx(expected(1e8, zeta), rel=2e-3)
    mean_path = 2.0 / math.pi * (math.sqrt(1.0 - zeta**2) + zeta * math.asin(zeta))
    assert soft_limit(scene(0, zeta)) == pytest.approx(zeta / mean_path, rel=1e-5)
    assert soft_limit(scene(0, zeta)) == pytest.approx(expected(1e-3, zeta), rel=1e-5)


@pytest.mark.parametrize("name", SYMBOLS)
def test_sensitivities_reach_their_limits(mean: Mean, name: str) -> None:
    for kappa, limit, near in ((1e-3, soft_limit, 1e-3), (1e7, coulomb_limit, 2e-3)):
        of_fmu = sensitivity(mean, scene(kappa, 0.3, ALPHA, PHASE), name)
        assert of_fmu == pytest.approx(sensitivity(limit, scene(kappa, 0.3, ALPHA, PHASE), name), abs=near)


def test_regime_classes(fmu_path: Path) -> None:
    of = partial(regime_map, fmu_path)
    assert of([1e6], [0.3], 0.0).item() == COULOMB
    assert of([0.5], [0.3], 0.0).item() == CONSTANT
    assert of([0.5], [0.3], 0.1).item() == MOVING
    assert of([5.0], [0.01], ALPHA).item() == MOTOR
    assert of([0.5], [1.4], 0.0).item() == COULOMB


def test_limits_bracket_every_stiffness_with_constant_separation(mean: Mean) -> None:
    values = scene(np.array([0.03, 0.3, 3.0, 30.0])[:, None], np.linspace(0.01, 0.99, 9))
    means = mean(values)
    assert np.all(coulomb_limit(values) - 1e-8 <= means) and np.all(means <= soft_limit(values) + 1e-5)
