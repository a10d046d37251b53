"""Both interfaces against the reference: model exchange by CVODE, in fmpy's own loop, and co-simulation."""

from __future__ import annotations

from itertools import count, islice, repeat

import numpy as np
import pytest
from fmpy import simulate_fmu
from model_exchange.exchange_scenes import LARGEST, drawn, error, errors, is_held, run
from solver.test_tolerance import results

from frictioncontact.fmu import FrictionFmu
from workshop.reference import NAMES, changed, start_values, step

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


def test_fmpy_and_co_simulation(fmu: FrictionFmu) -> None:
    """fmpy sets inputs between its steps only, so they are held here."""
    for scene in islice(filter(is_held, map(drawn, count())), 3):
        truth = step(scene)
        start = {name: getattr(scene, NAMES[name]) for name in start_values(scene)}
        rows = {}
        for interface, tolerance in (("ModelExchange", TOLERANCE), ("CoSimulation", 1e-9)):
            rows[interface] = simulate_fmu(
                str(fmu.path),
                fmi_type=interface,
                stop_time=scene.h,
                output_interval=scene.h / 40,
                start_values=start,
                relative_tolerance=tolerance,
                output=list(LARGEST),
                record_events=False,
            )
        exchanged, co_simulated = rows.values()
        assert error(scene, {name: exchanged[name][-1] for name in LARGEST}) < ALLOWED
        for name, is_energy in LARGEST.items():
            scale = truth.S * (truth.path if is_energy else 1.0)
            np.testing.assert_allclose(exchanged[name], co_simulated[name], rtol=0, atol=2 * ALLOWED * scale)
