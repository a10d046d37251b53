"""The methods take the work they are meant to take: a spoilt step control costs work, not accuracy."""

from __future__ import annotations

import pytest
from solver.step_control import FAMILIES, SCENES, committed, committed_of_laws, evaluations

from frictionlab.fmu import FrictionFmu

COMMITTED = committed()
OF_LAWS = committed_of_laws()


def test_the_table_is_of_these_scenes() -> None:
    assert list(COMMITTED) == list(SCENES)


@pytest.mark.parametrize("name", SCENES)
def test_evaluations(fmu: FrictionFmu, name: str) -> None:
    """Within 5 %: one panel more or less may come from the rounding of another machine's exp and cos."""
    assert evaluations(fmu, SCENES[name]) == pytest.approx(COMMITTED[name], rel=0.05)


@pytest.mark.parametrize("family", FAMILIES)
def test_evaluations_of_laws(fmu: FrictionFmu, family: str) -> None:
    """Each step within 5 %, and their sum, which rounding moves less, within a part in ten thousand."""
    counts = FAMILIES[family](fmu)
    assert [len(steps) for steps in counts] == [len(steps) for steps in OF_LAWS[family]]
    moved = [
        f"scene {number}: {steps} instead of {usual}"
        for number, (steps, usual) in enumerate(zip(counts, OF_LAWS[family], strict=True))
        if steps != pytest.approx(usual, rel=0.05)
    ]
    assert not moved, "\n".join(moved)
    assert sum(map(sum, counts)) == pytest.approx(sum(map(sum, OF_LAWS[family])), rel=1e-4)
