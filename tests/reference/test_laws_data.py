"""The committed laws_<law>.csv are what the reference gives, and hold scenes of every kind."""

from __future__ import annotations

import numpy as np
import pytest
from data.laws import LAWS, LawScene, law_scenes

from workshop.reference import solution as reference
from workshop.reference.arithmetic import multiprecision
from workshop.reference.settled import settled
from workshop.reference.solution import MP, Scene


def first_scenes(law: str) -> list[Scene]:
    return [scene.steps[0].scene for scene in law_scenes(law)]


@pytest.mark.parametrize("law", LAWS)
def test_500_scenes_of_every_kind(law: str) -> None:
    scenes = first_scenes(law)
    assert len(scenes) == 500
    assert {scene.friction for scene in scenes} == {law}
    kinds = {(scene.limit, scene.input, scene.contact.model) for scene in scenes if scene.vibrates}
    assert len(kinds) == 2 * 2 * 3
    assert sum(not scene.vibrates for scene in scenes) > 20
    steps = [step for scene in law_scenes(law) for step in scene.steps]
    assert sum(not step.scene.held for step in steps) > 200
    assert max(step.h * step.scene.f for step in steps) > 40
    assert any(scene.sigma_2 for scene in scenes) and any(not scene.sigma_2 for scene in scenes)
    assert {scene.tolerance for scene in law_scenes(law)} == {float(f"1e-{k}") for k in range(3, 13)}


def kappa(scene: Scene) -> float:
    drive = reference.Drive(scene, scene.start, reference.EXTENDED)
    now = reference.EXTENDED.real(0)
    top = max(abs(scene.V), scene.V_1, 1e-3)
    return float(drive.sigma(now) * top / (2 * MP.pi * scene.f) / drive.coulomb(now))


@pytest.mark.parametrize("law", ["Dahl", "LuGre", "ElasticPlastic"])
def test_laws_with_a_state_span_eleven_decades_of_stiffness_and_start_anywhere(law: str) -> None:
    stiffness = [kappa(scene) for scene in first_scenes(law)]
    assert min(stiffness) < 1e-2 and max(stiffness) > 1e7
    over_bound = []
    for scene in law_scenes(law):
        drive = reference.Drive(scene.steps[0].scene, scene.steps[0].scene.start, reference.EXTENDED)
        now = reference.EXTENDED.real(0)
        over_bound.append(abs(scene.delta_0) * float(drive.sigma(now) / drive.limit(now)) > 1)
    assert 30 < sum(over_bound) < 300


def check(scene: LawScene) -> None:
    delta, work, heat = scene.delta_0, 0, 0
    if scene.settled is not None:
        delta = settled(scene.steps[0].scene, scene.steps[0].scene.start, scene.delta_0)
        assert float(delta) == pytest.approx(scene.settled, rel=1e-15)
    for step in scene.steps:
        start, h = MP.mpf(step.scene.start), MP.mpf(step.h)
        got = reference.advance(step.scene, start, h, delta)
        delta, work, heat = got.delta, work + got.work, heat + got.heat
        force = float(reference.force(step.scene, start + h, delta))
        assert force == pytest.approx(step.F_t, abs=1e-14 * step.limit, rel=1e-14)
        mean = float(multiprecision(got.impulse) / h)
        # to so much the rate of a soft bristle's bound is known, of which the damping takes part
        rate = 1e-18 * abs(float(delta)) * 2 * np.pi * step.scene.f
        damping, path = step.scene.sigma_1 * rate, step.limit_path / step.limit
        heat_of_rate = damping * path + step.limit * rate * step.h
        assert mean == pytest.approx(step.F_t_mean, abs=1e-14 * step.limit + damping, rel=1e-14)
        assert float(work) == pytest.approx(step.W_f, abs=1e-14 * step.limit_path + damping * path, rel=1e-14)
        assert float(heat) == pytest.approx(step.Q_f, abs=1e-14 * step.limit_path + heat_of_rate, rel=1e-14)


@pytest.mark.parametrize("law", [*LAWS, "Settled"])
def test_the_reference_gives_it_again(law: str) -> None:
    """Also the rows of a bristle that relaxes within bounds, which the fast reference made."""
    for scene in law_scenes(law)[:: 40 if law != "Settled" else 7]:
        check(scene)


def test_settled_scenes_relax_within_one_period_and_after_a_million_million() -> None:
    scenes = law_scenes("Settled")
    assert len(scenes) == 100
    stiffness = [kappa(scene.steps[0].scene) for scene in scenes]
    assert min(stiffness) < 1e-12 and max(stiffness) > 1e6
