"""The methods take the work they are meant to take: a spoilt step control costs work, not accuracy."""

from __future__ import annotations

import pytest
from solver.step_control import SCENES, committed, evaluations

from frictioncontact.fmu import FrictionFmu

MOST = 1.5  # times the committed work, or less by this factor: a change of method within it is no fault


def test_the_table_is_of_these_scenes() -> None:
    assert list(committed()) == list(SCENES)


@pytest.mark.parametrize("name", SCENES)
def test_evaluations(fmu: FrictionFmu, name: str) -> None:
    """If a change takes far less work, the table is renewed: its old bound would allow all of it again."""
    assert committed()[name] / MOST <= evaluations(fmu, SCENES[name]) <= MOST * committed()[name]
