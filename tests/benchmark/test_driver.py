"""The C driver and the peers: the same numbers as fmpy and the reference, and failures with their reason."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from frictionlab.bench.cases import Case, cases, expected, sampled, vibrating
from frictionlab.bench.driver import Bench, Job
from frictionlab.bench.peers import SCIPY, plain_cvode, python_fmu, scipy_solver
from frictionlab.fmu import FrictionFmu, simulate

SOFT = replace(vibrating(6e6), starts=(0.0,), count=2)


def error(outcome: object, case: Case, start: float = 0.0) -> float:
    right = expected(case, start)
    assert outcome.failure == ""  # type: ignore[attr-defined]
    got = (outcome.F, outcome.F_mean)  # type: ignore[attr-defined]
    return max(float(np.abs(a - b).max()) for a, b in zip(got, right, strict=True)) / case.F_C


@pytest.mark.parametrize("linear", [False, True])
def test_the_driver_gives_what_fmpy_gives(bench: Bench, fmu: FrictionFmu, linear: bool) -> None:
    case = sampled(20, 6e6, linear)
    outcome = bench.run(case.job())
    rows = simulate(fmu, case.start_values, case.step, case.count, case.inputs, linear)
    assert np.array_equal(outcome.F, rows["F_t"][1:])
    assert np.array_equal(outcome.F_mean, rows["F_t_mean"][1:])
    assert outcome.cpu > 0 and outcome.wall > 0 and outcome.evaluations > 0


@pytest.mark.parametrize("case", [c for c in cases() if c.count < 40], ids=lambda c: c.name)
def test_the_default_keeps_its_tolerance_on_every_scene(bench: Bench, case: Case) -> None:
    tolerance = 1e-6
    for start in case.starts:
        assert error(bench.run(case.job(start, 0.0, solver__tolerance=tolerance)), case, start) <= tolerance


def test_plain_cvode_solves_the_same_equation(bench: Bench) -> None:
    errors = [error(plain_cvode(bench, SOFT, 0.0, tolerance, 0.0), SOFT) for tolerance in (1e-4, 1e-10)]
    assert errors[0] > 1e-5  # its own tolerance shows
    assert errors[1] < 1e-7


def test_plain_cvode_takes_linear_inputs(bench: Bench) -> None:
    case = sampled(20, 6e6, linear=True)
    assert error(plain_cvode(bench, case, 0.0, 1e-10, 0.0), case) < 1e-7


@pytest.mark.parametrize("method", SCIPY)
def test_scipy_solves_the_same_equation(method: str) -> None:
    case = sampled(20, 6e6, linear=True)
    assert error(scipy_solver(case, 0.0, method, 1e-7, 100_000), case) < 1e-4


def test_a_python_fmu_solves_the_same_equation() -> None:
    with python_fmu() as python:
        assert error(python.run(SOFT, 0.0, 1e-8), SOFT) < 1e-4


def test_failures_carry_their_reason(bench: Bench) -> None:
    stiff = vibrating(6e12)
    refused = bench.run(stiff.job(solver__method="explicitEuler", solver__stepSize=5e-5))
    assert "largest usable step" in refused.failure
    assert np.isnan(refused.cpu)
    slow = scipy_solver(stiff, 0.0, "Radau", 1e-8, 100)
    assert "100 evaluations" in slow.failure


def test_a_wrong_start_value_is_told(bench: Bench) -> None:
    assert "d = -1 m" in bench.run(Job({"d": -1.0}, 1e-6)).failure
