"""The default solver keeps its promise: errors of F_t and F_t_mean at most tolerance times F_C.

500 seeded random scenes, sigma from 6e4 to 6e12 N/m, held and linear inputs, dips and tangential reversals,
communication steps from a hundredth of a period to a thousand. Below 1e-10 rounding of the inputs rules.
"""

from __future__ import annotations

import pytest
from data.sweep import SWEEP, SweepRow

from frictioncontact.fmu import FrictionFmu

FLOOR = 1e-10
TOLERANCES = sorted({row.tolerance for row in SWEEP})


def errors(fmu: FrictionFmu, row: SweepRow, tolerance: float) -> tuple[float, float]:
    """Of F_t and F_t_mean, over F_C."""
    start = row.start_values | {"solver.tolerance": tolerance}
    with fmu.session(start, start=row.scene.start) as session:
        if row.rates:
            session.set_rates(**row.rates)
        session.step(row.h)
        F_t, F_t_mean = session.get("F_t"), session.get("F_t_mean")
    return abs(F_t - row.F_t) / row.scene.F_C, abs(F_t_mean - row.F_t_mean) / row.scene.F_C


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_error_is_at_most_the_tolerance(fmu: FrictionFmu, tolerance: float) -> None:
    bound = max(tolerance, FLOOR)
    missed = []
    for row in SWEEP:
        if row.tolerance == tolerance:
            of_force, of_mean = errors(fmu, row, tolerance)
            if not max(of_force, of_mean) <= bound:
                missed.append(f"row {row.number}: F_t {of_force:.2e}, F_t_mean {of_mean:.2e}")
    assert not missed, f"errors over F_C beyond {bound:g}:\n" + "\n".join(missed)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-12])
def test_every_scene_at_the_default_and_at_the_finest_tolerance(fmu: FrictionFmu, tolerance: float) -> None:
    bound = max(tolerance, FLOOR)
    missed = []
    for row in SWEEP:
        of_force, of_mean = errors(fmu, row, tolerance)
        if not max(of_force, of_mean) <= bound:
            missed.append(f"row {row.number}: F_t {of_force:.2e}, F_t_mean {of_mean:.2e}")
    assert not missed, f"errors over F_C beyond {bound:g}:\n" + "\n".join(missed)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-12])
def test_work(fmu: FrictionFmu, tolerance: float) -> None:
    """Within the tolerance of the work that F_C would do on the same path."""
    missed = []
    for row in SWEEP:
        start = row.start_values | {"solver.tolerance": tolerance}
        with fmu.session(start, start=row.scene.start) as session:
            if row.rates:
                session.set_rates(**row.rates)
            session.step(row.h)
            work = session.get("W_f")
        scene = row.scene
        speed = max(abs(scene.V), abs(scene.V + scene.V_rate * row.h)) + scene.V_1
        error = abs(work - row.work) / (scene.F_C * max(speed * row.h, 1e-300))
        if not error <= max(tolerance, FLOOR):
            missed.append(f"row {row.number}: {error:.2e}")
    assert not missed, "errors of the work:\n" + "\n".join(missed)
