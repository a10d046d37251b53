"""Both interfaces against the reference: model exchange by CVODE, in fmpy's own loop, and co-simulation."""

from __future__ import annotations

import numpy as np
import pytest
from fmpy import simulate_fmu
from model_exchange.exchange_scenes import ExchangeScene, drawn, errors, run, stepped
from physics.course import Course

from frictioncontact.fmu import FrictionFmu

TOLERANCE = 1e-7  # of the host, for every step; the error of a run is the sum of some of them
ALLOWED = 100 * TOLERANCE


@pytest.mark.parametrize("number", range(24))
def test_scenes(fmu: FrictionFmu, number: int) -> None:
    """Vibrating or not, inputs held or linear, every law with a state; tests/hunt has many more."""
    scene = drawn(number, fmu)
    truth = Course(scene.scene, scene.delta_0).step(scene.scene, scene.h)
    assert max(errors(truth, run(scene, fmu, TOLERANCE))) < ALLOWED
    for tolerance in (1e-3, 1e-6, 1e-8):
        assert max(errors(truth, stepped(scene, fmu, {"solver.tolerance": tolerance}))) < tolerance + 1e-11


def held(fmu: FrictionFmu, count: int) -> list[ExchangeScene]:
    scenes = (drawn(number, fmu) for number in range(1000))
    chosen = (scene for scene in scenes if scene.is_held)
    return [next(chosen) for _ in range(count)]


def by_fmpy(
    fmu: FrictionFmu, scene: ExchangeScene, interface: str, tolerance: float
) -> dict[str, np.ndarray]:
    names = ["F_t", "W_f", "Q_f"]
    start = scene.start_values()
    for name, value in start.items():
        if isinstance(value, str):
            items = fmu.variables[name].declaredType.items
            start[name] = next(int(item.value) for item in items if item.name == value)
    result = simulate_fmu(
        str(fmu.path),
        fmi_type=interface,
        stop_time=scene.h,
        output_interval=scene.h / 40,
        start_values=start,
        relative_tolerance=tolerance,
        output=names,
        record_events=False,
    )
    return {name: result[name] for name in names}


def test_fmpy_and_co_simulation(fmu: FrictionFmu) -> None:
    """fmpy sets inputs between its steps only, so they are held here."""
    for scene in held(fmu, 6):
        exchanged = by_fmpy(fmu, scene, "ModelExchange", TOLERANCE)
        stepped = by_fmpy(fmu, scene, "CoSimulation", 1e-9)
        truth = Course(scene.scene, scene.delta_0).step(scene.scene, scene.h)
        found = errors(truth, {name: values[-1] for name, values in exchanged.items()})
        assert max(found) < ALLOWED, scene.number
        for name, values in stepped.items():
            scale = truth.scale * (1.0 if name == "F_t" else truth.path)
            assert exchanged[name] == pytest.approx(values, rel=0, abs=2 * ALLOWED * scale), (
                scene.number,
                name,
            )
