"""No heap allocation in a communication step of the default solver, counted by an interposed malloc."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from tools.bench.driver import Bench, Job

VIBRATING = {"vibration.V_1": 1.44, "vibration.a_d": 1.1e-6}
INPUTS = {"V": np.linspace(-0.1, 0.1, 8), "d": np.linspace(13e-6, 15e-6, 8), "E": np.linspace(5e10, 6e10, 8)}
SCENES = {
    "held inputs": Job({}, 1e-6, 50, inputs=INPUTS),
    "part of a period": Job(VIBRATING, 1.3e-5, 50),
    "many periods": Job(VIBRATING, 0.1234, 10),
    "vibration and linear inputs": Job(VIBRATING, 1e-4, 20, inputs=INPUTS, linear=True),
    "tightest tolerance": Job(VIBRATING | {"solver.tolerance": 1e-12}, 5e-5, 10),
    "in the plane": Job(VIBRATING | {"V_y": 0.1}, 1e-4, 10),
    "Coulomb": Job(VIBRATING | {"friction.model": "Coulomb"}, 1e-4, 10),
    "backward Euler": Job({"solver.method": "backwardEuler"}, 1e-6, 10),
}


@pytest.mark.skipif(sys.platform != "linux", reason="the counter is preloaded, as Linux allows")
@pytest.mark.parametrize("name", SCENES)
def test_a_step_does_not_allocate(bench: Bench, name: str) -> None:
    outcome = bench.run(SCENES[name], count_allocations=True)
    assert outcome.failure == ""
    assert outcome.allocations == 0 < outcome.allocations_to_start  # the instance itself is counted
