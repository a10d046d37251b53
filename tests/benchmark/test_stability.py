"""The stability edges, measured through the FMU, against theory."""

from __future__ import annotations

import numpy as np
import pytest

from frictioncontact.fmu import FrictionFmu
from tools.bench.coupling import (
    COUPLINGS,
    Belt,
    cosimulate,
    coupled_edge,
    coupled_errors,
    monolithic,
    theoretical_edge,
)
from tools.bench.stability import EDGES, classify, measured_edge


@pytest.mark.parametrize(("method", "edge"), [(m, edge) for m, limits in EDGES.items() for edge in limits])
def test_edges_lie_where_theory_says(fmu: FrictionFmu, method: str, edge: tuple[str, str]) -> None:
    """As near as docs/numerics.md says."""
    theory = EDGES[method][edge]
    assert measured_edge(fmu, method, edge[0], theory) == pytest.approx(theory, rel=1e-4)
    assert classify(fmu, method, 1.003 * theory) == edge[1]


def test_implicit_methods_have_no_limit(fmu: FrictionFmu) -> None:
    for z in (1e-3, 3.0, 1e8):
        assert classify(fmu, "collocation", z) == classify(fmu, "backwardEuler", z) == "monotone"
        assert classify(fmu, "cvode", z) in ("monotone", "stable")


@pytest.mark.parametrize("coupling", COUPLINGS)
def test_a_coupled_mass_is_stable_up_to_the_step_in_theory(fmu: FrictionFmu, coupling: str) -> None:
    belt = Belt()
    assert coupled_edge(fmu, belt, coupling) == pytest.approx(theoretical_edge(belt, coupling), rel=7e-4)


def test_the_coupled_error_falls_with_the_order_of_the_coupling(fmu: FrictionFmu) -> None:
    belt = Belt(end=0.08)  # a stick, a slip, a reversal
    reference = monolithic(belt)
    for coupling, order in zip(COUPLINGS, (1, 2), strict=True):
        errors = []
        for count in (4000, 8000):
            got = cosimulate(fmu, belt, coupling, belt.end / count, count)
            right = reference(belt.end / count * np.arange(count + 1)).T
            errors.append(np.abs(got[:, 2] - right[:, 2]).max())
        assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.2)


def test_a_coupling_that_chatters_is_told(fmu: FrictionFmu) -> None:
    belt = Belt()
    rows = coupled_errors(fmu, belt, monolithic(belt), (500,))
    assert [row["failure"] for row in rows] == ["chatters", ""]  # F_t held, F_t linear
