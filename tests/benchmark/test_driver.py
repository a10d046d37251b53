"""The C driver and the peers: the same numbers as fmpy and the reference, and failures with their reason."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from frictioncontact.fmu import FrictionFmu, simulate
from tools.bench.cases import PLAIN_PROGRAMS, Case, cases, expected, plain, sampled, vibrating
from tools.bench.driver import Bench, Outcome

SOFT = replace(vibrating(6e6), starts=(0.0,), count=2)
RIGHT: dict[str, tuple[np.ndarray, np.ndarray]] = {}  # what several tests ask for


def error(outcome: Outcome, case: Case) -> float:
    right = RIGHT[case.name] = RIGHT.get(case.name) or expected(case, 0.0)
    assert outcome.failure == ""
    both = zip((outcome.F, outcome.F_mean), right, strict=True)
    return max(float(np.abs(a - b).max()) for a, b in both) / case.F_C


def test_the_driver_gives_what_fmpy_gives(bench: Bench, fmu: FrictionFmu) -> None:
    case = sampled(20, 6e6, linear=True)
    outcome = bench.run(case.job())
    rows = simulate(fmu, case.start_values, case.step, case.count, case.inputs, True)
    assert np.array_equal(outcome.F, rows["F_t"][1:])
    assert np.array_equal(outcome.F_mean, rows["F_t_mean"][1:])
    assert outcome.cpu > 0 and outcome.evaluations > 0


@pytest.mark.parametrize("method", PLAIN_PROGRAMS)
def test_plain_solvers_solve_the_same_equation(bench: Bench, method: str) -> None:
    """To their own tolerance, also with inputs."""
    errors = [error(plain(bench, method, SOFT, x, 0.0, 0.0), SOFT) for x in (1e-4, 1e-10)]
    assert errors[1] < 1e-7 and errors[0] > 10 * errors[1]
    for case in cases():
        if case.name in ("linear", "held", "sampled-20-linear-6e06", "vibrating-d"):
            assert error(plain(bench, method, case, 1e-10, 0.0, 0.0), case) < 1e-7, case.name
