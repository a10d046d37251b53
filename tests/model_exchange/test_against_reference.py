"""Both interfaces against the reference: model exchange by scipy's BDF, and co-simulation."""

from __future__ import annotations

from itertools import count, islice, repeat

import pytest
from model_exchange.exchange_scenes import drawn, error, errors, run
from solver.test_tolerance import results

from frictioncontact.fmu import FrictionFmu
from tools.reference import changed

TOLERANCE = 1e-7  # of the host, for every step; the error of a run is the sum of some of them
ALLOWED = 100 * TOLERANCE


@pytest.mark.parametrize("planar", [False, True], ids=["line", "plane"])
def test_scenes(fmu: FrictionFmu, planar: bool) -> None:
    """Vibrating or not, inputs held or linear, every law with a state; tests/hunt has many more."""
    for number in range(24):
        scene = drawn(number, planar)
        assert error(scene, run(scene, fmu, TOLERANCE)) < (3 if planar else 1) * ALLOWED, number
        for tolerance in (1e-3, 1e-8):
            assert error(scene, results(fmu, scene, tolerance)) < tolerance + 1e-11, number


@pytest.mark.parametrize("planar", [False, True], ids=["line", "plane"])
def test_a_load_that_falls_to_zero(fmu: FrictionFmu, planar: bool) -> None:
    """How fast it moves a bound, and that one's part of Q_f, is taken from the host's steps."""
    for scene in islice((each for each in map(drawn, count(), repeat(planar)) if each.input == 2), 9):
        opens = changed(scene, load_rate=-1.5 * scene.load / scene.h, E_rate=0.0, sigma_1=0.0)
        found = errors(opens, run(opens, fmu, TOLERANCE))
        assert found.pop("Q_f") < 3e-4 and max(found.values()) < ALLOWED
