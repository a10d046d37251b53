"""Every law keeps the promise of solver.tolerance: 200 seeded scenes a law against the reference.

Errors of F_t and F_t_mean over the largest force of the step, of W_f and Q_f over that times the path.
"""

from __future__ import annotations

import pytest
from data.laws import LAWS, LawScene, LawStep, law_scenes

from frictioncontact.fmu import FrictionFmu, Session

ROUNDING = 1e-11


def deviations(session: Session, step: LawStep) -> dict[str, float]:
    """Errors after the step beyond rounding, over their scales."""
    scales = {"F_t": step.scale, "F_t_mean": step.scale, "W_f": step.energy, "Q_f": step.energy}
    found = {}
    for name, scale in scales.items():
        error = abs(session.get(name) - getattr(step, name))
        error = max(0.0, error - ROUNDING * (scale + abs(getattr(step, name))))
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
        if not all(error <= asked for error in errors.values()):
            listed = ", ".join(f"{name} {error:.2e}" for name, error in errors.items())
            lines.append(f"scene {scene.number}, tolerance {asked:g}: {listed}")
    return lines


@pytest.mark.parametrize("law", LAWS)
def test_each_scene_at_its_tolerance(fmu: FrictionFmu, law: str) -> None:
    lines = missed(fmu, law_scenes(law))
    assert not lines, f"{len(lines)} of 200 beyond the tolerance:\n" + "\n".join(lines)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
@pytest.mark.parametrize("law", LAWS)
def test_every_fifth_scene_at_the_default_and_at_a_fine_tolerance(
    fmu: FrictionFmu, law: str, tolerance: float
) -> None:
    lines = missed(fmu, law_scenes(law)[::5], tolerance)
    assert not lines, f"{len(lines)} of 40 beyond the tolerance:\n" + "\n".join(lines)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_settled_starts(fmu: FrictionFmu, tolerance: float) -> None:
    scenes = law_scenes("Settled")
    lines = missed(fmu, scenes, tolerance)
    for scene in scenes:
        first = scene.steps[0].scene
        with fmu.session(scene.start_values | {"solver.tolerance": tolerance}, start=first.start) as session:
            size = max(abs(scene.settled), scene.steps[0].scale / session.get("sigma"))
            error = abs(session.get("delta") - scene.settled) / size
        if not error <= tolerance:
            lines.append(f"scene {scene.number}: start {error:.2e}")
    assert not lines, "beyond the tolerance:\n" + "\n".join(lines)
