"""Every law keeps the promise of solver.tolerance: 500 seeded scenes a law against the reference.

Errors of F_t and F_t_mean over the mean limit, of W_f and Q_f over the mean limit times the path. Below 1e-10
rounding of the inputs rules.
"""

from __future__ import annotations

import pytest
from data.laws import LAWS, LawScene, LawStep, law_scenes

from frictioncontact.fmu import FrictionFmu, Session

FLOOR = 1e-10
EPSILON = 2.0**-52


def deviations(session: Session, step: LawStep) -> dict[str, float]:
    """Errors after the step, over their scales."""
    scales = {"F_t": step.limit, "F_t_mean": step.limit, "W_f": step.limit_path, "Q_f": step.limit_path}
    # where a soft bristle is longer than its way by many orders, the double that holds it rounds coarser: at
    # both ends of the step, in the product and in the sum of the map between them
    rounding = 4 * EPSILON * abs(step.delta)
    allowed = {
        "F_t": 0.0,
        "F_t_mean": rounding * step.scene.sigma_1 / step.h,
        "W_f": rounding * step.limit,
        "Q_f": 2 * rounding * step.limit,  # the bound at both ends of a slip too, from e^-8 or so
    }
    found = {}
    for name, scale in scales.items():
        error = max(0.0, abs(session.get(name) - getattr(step, name)) - allowed[name])
        found[name] = error / scale if scale > 0.0 else float("inf" if error > 0.0 else 0.0)
    return found


def worst(fmu: FrictionFmu, scene: LawScene, tolerance: float) -> dict[str, float]:
    """The largest errors over all steps of the scene."""
    found: dict[str, float] = {}
    start = scene.start_values | {"solver.tolerance": tolerance}
    with fmu.session(start, start=scene.steps[0].scene.start) as session:
        for step in scene.steps:
            step.take(session)
            for name, error in deviations(session, step).items():
                found[name] = max(found.get(name, 0.0), error)
    return found


def missed(fmu: FrictionFmu, scenes: list[LawScene], tolerance: float | None = None) -> list[str]:
    """The scenes beyond their tolerance, or beyond the given one, with their errors."""
    lines = []
    for scene in scenes:
        asked = tolerance or scene.tolerance
        errors = worst(fmu, scene, asked)
        if not all(error <= max(asked, FLOOR) for error in errors.values()):
            listed = ", ".join(f"{name} {error:.2e}" for name, error in errors.items())
            lines.append(f"scene {scene.number}, tolerance {asked:g}: {listed}")
    return lines


@pytest.mark.parametrize("law", LAWS)
def test_each_scene_at_its_tolerance(fmu: FrictionFmu, law: str) -> None:
    lines = missed(fmu, law_scenes(law))
    assert not lines, f"{len(lines)} of 500 beyond the tolerance:\n" + "\n".join(lines)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-11])
@pytest.mark.parametrize("law", LAWS)
def test_every_fifth_scene_at_the_default_and_at_a_fine_tolerance(
    fmu: FrictionFmu, law: str, tolerance: float
) -> None:
    lines = missed(fmu, law_scenes(law)[::5], tolerance)
    assert not lines, f"{len(lines)} of 100 beyond the tolerance:\n" + "\n".join(lines)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-12])
def test_settled_starts(fmu: FrictionFmu, tolerance: float) -> None:
    scenes, bound = law_scenes("Settled"), max(tolerance, FLOOR)
    lines = missed(fmu, scenes, tolerance)
    for scene in scenes:
        first = scene.steps[0].scene
        with fmu.session(scene.start_values | {"solver.tolerance": tolerance}, start=first.start) as session:
            size = max(abs(scene.settled), scene.steps[0].limit / session.get("sigma"))
            error = abs(session.get("delta") - scene.settled) / size
        if not error <= bound:
            lines.append(f"scene {scene.number}: start {error:.2e}")
    assert not lines, "beyond the tolerance:\n" + "\n".join(lines)


def test_elastic_plastic_is_exact_where_nothing_moves_but_the_velocity(fmu: FrictionFmu) -> None:
    """1e-12 whatever the tolerance asked; the work of a step in which V and V_1 cos cancel rounds coarser."""
    lines, count = [], 0
    for scene in law_scenes("ElasticPlastic"):
        if scene.steps[0].scene.a_d != 0.0 or any(set(step.rates) - {"V"} for step in scene.steps):
            continue
        count += 1
        for name, error in worst(fmu, scene, 1e-3).items():
            if not error <= (1e-12 if name in ("F_t", "F_t_mean") else 1e-11):
                lines.append(f"scene {scene.number}: {name} {error:.2e}")
    assert count > 50
    assert not lines, "\n".join(lines)
