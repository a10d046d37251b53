"""The committed sweep.csv is what the reference gives, by either kind."""

from __future__ import annotations

import pytest
from data.sweep import SWEEP, SweepRow

from workshop.reference import collocation as reference_collocation
from workshop.reference import solution as reference
from workshop.reference.arithmetic import multiprecision
from workshop.reference.solution import MP


def test_it_holds_500_scenes_of_every_kind() -> None:
    assert len(SWEEP) == 500
    scenes = [row.scene for row in SWEEP]
    assert sum(scene.vibrates for scene in scenes) > 300
    assert sum(not scene.held for scene in scenes) > 100
    assert sum(0 < abs(1 - abs(scene.V) / scene.V_1) < 0.1 for scene in scenes if scene.V_1) > 60
    ratios = [row.h * row.scene.f for row in SWEEP]
    assert min(ratios) < 0.02 and max(ratios) > 500
    stiffness = [float(reference.sigma(row.scene, row.scene.start)) for row in SWEEP]
    assert min(stiffness) < 2e5 and max(stiffness) > 2e12
    assert {row.tolerance for row in SWEEP} == {float(f"1e-{k}") for k in range(3, 13)}


@pytest.mark.parametrize("row", SWEEP[::25], ids=lambda row: f"row {row.number}")
def test_the_reference_gives_it_again(row: SweepRow) -> None:
    t1 = MP.mpf(row.scene.start) + MP.mpf(row.h)
    delta, impulse, work = reference.solve(row.scene, row.scene.start, t1, row.delta_0)
    F_C = row.scene.F_C
    assert float(reference.force(row.scene, t1, delta)) == pytest.approx(row.F_t, abs=1e-14 * F_C)
    assert float(multiprecision(impulse) / MP.mpf(row.h)) == pytest.approx(row.F_t_mean, abs=1e-14 * F_C)
    assert float(work) == pytest.approx(row.work, rel=1e-12)


SHORT = [row for row in SWEEP if row.h * row.scene.f < 0.5]


@pytest.mark.parametrize("row", SHORT[::12], ids=lambda row: f"row {row.number}")
def test_collocation_gives_it_too(row: SweepRow) -> None:
    delta, impulse, *_ = reference_collocation.trajectory(row.scene, row.scene.start, row.h, row.delta_0)
    t1 = MP.mpf(row.scene.start) + MP.mpf(row.h)
    F_C = row.scene.F_C
    assert float(reference.force(row.scene, t1, delta)) == pytest.approx(row.F_t, abs=1e-13 * F_C)
    assert float(impulse / MP.mpf(row.h)) == pytest.approx(row.F_t_mean, abs=1e-13 * F_C)
