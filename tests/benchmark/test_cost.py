"""scripts/cost: instructions and evaluations of a step, and instances that take turns."""

from __future__ import annotations

import shutil
from dataclasses import replace

import numpy as np
import pytest

from frictioncontact.errors import UserError
from tools.bench import cost
from tools.bench.cases import sampled
from tools.bench.cost import Cost, Scene, counted, ratios, vibrating_scenes
from tools.bench.driver import Bench

needs_valgrind = pytest.mark.skipif(shutil.which("valgrind") is None, reason="valgrind is missing")
HELD = cost.held()


def test_the_scenes_are_105() -> None:
    scenes = vibrating_scenes()
    assert len(scenes) == 105
    assert len({(scene.group, scene.case.name, *scene.settings.values()) for scene in scenes}) == 105


@needs_valgrind
def test_instructions_of_a_step_are_those_of_its_calls_alone(bench: Bench) -> None:
    """Neither the loading of the library nor the start of an instance counts, which take more."""
    few, many = (counted(bench, Scene("held", replace(HELD, count=count), {})) for count in (100, 1000))
    assert few[0] == pytest.approx(many[0], rel=0.05)
    assert few[1] == many[1] == 1.0  # a held step has a closed form


@needs_valgrind
def test_a_count_of_nothing_is_refused(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cost, "CALLS", ("fmi2GetStringStatus",))
    with pytest.raises(UserError, match="has counted nothing in fmi2GetStringStatus"):
        counted(bench, Scene("held", replace(HELD, count=4), {}))


def test_a_line_has_the_geometric_means_of_ratios() -> None:
    pairs = [(Cost(100.0, 10.0, 1.0), Cost(200.0, 10.0, 0.5)), (Cost(10.0, 1.0, 1.0), Cost(80.0, 1.0, 0.5))]
    assert ratios("two", pairs) == ["two", "4.00", "1.00", "0.50"]


def test_instances_that_take_turns_give_what_one_gives(bench: Bench) -> None:
    job = sampled(20, 6e6, linear=True).job()
    alone, in_turn = bench.run(job), bench.run(replace(job, instances=3))
    assert np.array_equal(in_turn.F, alone.F)
    assert np.array_equal(in_turn.F_mean, alone.F_mean)
    assert in_turn.evaluations == alone.evaluations
