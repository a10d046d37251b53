"""The default method takes the work it is meant to take: a spoilt step control costs work, not accuracy."""

from __future__ import annotations

import pytest
from solver.step_control import SCENES, committed, evaluations

from frictionlab.fmu import FrictionFmu

COMMITTED = committed()


def test_the_table_is_of_these_scenes() -> None:
    assert list(COMMITTED) == list(SCENES)


@pytest.mark.parametrize("name", SCENES)
def test_evaluations(fmu: FrictionFmu, name: str) -> None:
    """Within 5 %: one panel more or less may come from the rounding of another machine's exp and cos."""
    assert evaluations(fmu, SCENES[name]) == pytest.approx(COMMITTED[name], rel=0.05)
