"""The work of a mass: every way comes to the reference, and panels take fewer evaluations than CVODE.

A master is of first order, and fails at 1 ms: a stuck mass is beyond its limit of stability, 2 sqrt(m/sigma).
"""

from __future__ import annotations

import pytest

from frictioncontact.advice.stuck_mass import GAUSS_SEIDEL
from tools.bench.cases import Case, expected
from tools.bench.driver import Bench
from tools.bench.exchange import MODEL_EXCHANGE
from tools.bench.mass_work import CVODE, PANELS, PARTS, Point, drawn, graded, solved

# Largest error of a step at the tolerance 1e-8; only that of the panels is promised. Those of a run add up.
LARGEST = {PANELS: 1e-8, CVODE: 1e-6, MODEL_EXCHANGE: 1e-3}


@pytest.mark.parametrize("scene", drawn(), ids=lambda scene: scene.name)
def test_every_way_solves_the_scenes_of_the_picture(bench: Bench, scene: Case) -> None:
    truth = {0.0: expected(scene, 0.0)}

    def point(method: str) -> Point:
        return graded(scene, truth, method, 1e-8, lambda _: solved(bench, scene, method, 1e-8))

    points = {method: point(method) for method in LARGEST}
    for method, found in points.items():
        assert not found.failure and found.error <= scene.count * LARGEST[method], found
    assert points[PANELS].evaluations < points[CVODE].evaluations


@pytest.mark.parametrize("scene", drawn(), ids=lambda scene: scene.name)
def test_a_master_is_of_first_order_and_fails_beyond_its_limit(bench: Bench, scene: Case) -> None:
    truth = {0.0: expected(scene, 0.0)}

    def error(parts: int) -> float:
        method = (GAUSS_SEIDEL, parts)
        return graded(scene, truth, *method, lambda _: solved(bench, scene, *method)).error

    longest, *_, fine, finest = map(error, PARTS)
    assert 5.0 < fine / finest < 25.0  # steps of a tenth
    assert (longest > 1.0) == ("vibration.V_1" not in scene.start_values)
