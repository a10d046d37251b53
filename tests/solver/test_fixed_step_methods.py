"""The fixed-step methods: orders of convergence, stability limits and how each behaves beyond them.

z = sigma |V| h / F_C. Explicit Euler is stable for z < 2 and monotone for z < 1; RK4 is stable for z <
2.785; the trapezoid never blows up but rings for z > 2; backward Euler and collocation have no limit.
"""

from __future__ import annotations

import re

import numpy as np
import pytest

from frictioncontact.fmu import FrictionError, FrictionFmu, Value
from tools.reference import changed, rest, scene_of, step

ORDERS = {"explicitEuler": 1, "backwardEuler": 1, "trapezoid": 2, "rk4": 4}
EXPLICIT = {"explicitEuler": 2.0, "rk4": 2.785293563405282}
SIGMA, V, F_C, H = 2.5e6, 0.5, 55.0, 3.7e-5
RATE = SIGMA * V / F_C  # 1/s
SLIDING: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": SIGMA, "V": V}
# V keeps its sign and everything moves: nothing but the method's own order limits it.
SMOOTH: dict[str, Value] = {"V": 2.0, "vibration.V_1": 0.9, "contact.stiffnessScale": 4e-7}
SMOOTH |= {"vibration.a_d": 5e-7, "vibration.phase_d": 1.0}


def final_errors(
    fmu: FrictionFmu, start: dict[str, Value], method: str, steps: int, h: float = H
) -> np.ndarray:
    """Of F_t, F_t_mean, W_f and Q_f, relative."""
    names = ("F_t", "F_t_mean", "W_f", "Q_f")
    truth = step(changed(scene_of(start), h=h))
    with fmu.session(start | {"solver.method": method, "solver.stepSize": h / steps}) as session:
        session.step(h)
        return np.abs(session.read(names) / [getattr(truth, name) for name in names] - 1)


@pytest.mark.parametrize("damping", [0.0, 2.0])
@pytest.mark.parametrize("method", ORDERS)
def test_order_of_convergence(fmu: FrictionFmu, method: str, damping: float) -> None:
    start = SMOOTH | {"friction.sigma_1": damping}
    coarse, fine = (final_errors(fmu, start, method, steps) for steps in (400, 800))
    assert np.log2(coarse / fine) == pytest.approx(ORDERS[method], abs=0.1)


@pytest.mark.parametrize("method", ORDERS)
def test_a_step_over_a_reversal_costs_high_orders(fmu: FrictionFmu, method: str) -> None:
    """|V| has a kink there, so no method of these keeps more than order 2; it still converges."""
    coarse, fine = (final_errors(fmu, SMOOTH | {"V": 0.3}, method, steps) for steps in (1000, 16000))
    assert (fine < coarse / 8).all()


def trace(fmu: FrictionFmu, method: str, z: float) -> np.ndarray:
    """F_t / F_C after each internal step, which is also the communication step."""
    with fmu.session(SLIDING | {"solver.method": method, "solver.stepSize": z / RATE}) as session:
        forces = np.empty(40)
        for k in range(len(forces)):
            session.step(z / RATE)
            forces[k] = session.get("F_t") / F_C
    return forces


def usable(refusal: Exception) -> float:
    return float(re.search(r"largest usable step is (\S+) s", str(refusal)).group(1))


@pytest.mark.parametrize("method", EXPLICIT)
@pytest.mark.parametrize("z", [3.0, 1e9])
def test_the_refusal_names_a_step_that_works(fmu: FrictionFmu, method: str, z: float) -> None:
    start = SLIDING | {"solver.method": method}
    with fmu.session(start | {"solver.stepSize": z / RATE}) as session:
        before = session.read()
        with pytest.raises(
            FrictionError, match=rf"{method}.*solver\.stepSize|solver\.stepSize.*{method}"
        ) as refusal:
            session.step(100 * z / RATE)
        assert (session.read() == before).all()
    h = usable(refusal.value)
    assert h == pytest.approx(EXPLICIT[method] / RATE, rel=0.02)
    with fmu.session(start | {"solver.stepSize": h}) as session:
        session.step(1000 * h)
        assert abs(session.get("F_t")) <= 2 * F_C


def test_the_refusal_under_vibration_goes_by_the_largest_rate(fmu: FrictionFmu) -> None:
    start = SMOOTH | {"V": 0.3}
    phase = np.linspace(0, 2 * np.pi, 2001)
    moved = [14e-6 + 5e-7 * np.cos(angle + 1.0) for angle in phase]
    sigma = np.array([rest(changed(scene_of(start), d=d, a_d=0.0))[1] for d in moved])
    largest = (sigma * np.abs(0.3 + 0.9 * np.cos(phase)) / F_C).max()
    explicit = {"solver.method": "explicitEuler", "solver.stepSize": 1e-4}
    with fmu.session(start | explicit) as session, pytest.raises(FrictionError) as refusal:
        session.step(1e-3)
    assert usable(refusal.value) == pytest.approx(2 / largest, rel=0.02)


@pytest.mark.parametrize(("z", "rings"), [(0.1, False), (1.96, False), (2.04, True), (1e6, True)])
def test_trapezoid_rings_beyond_2_and_never_blows_up(fmu: FrictionFmu, z: float, rings: bool) -> None:
    forces = trace(fmu, "trapezoid", z)
    assert bool((forces > 1 + 1e-12).any()) is rings
    assert (np.abs(forces - 1) <= 1 + 1e-12).all()  # the error at the start, and no more
    growth = (1 - z / 2) / (1 + z / 2)
    assert forces[:8] == pytest.approx(1 - growth ** np.arange(1, 9), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("z", [0.1, 2.04, 1e8])
def test_methods_without_a_limit(fmu: FrictionFmu, z: float) -> None:
    """Backward Euler never rings, and the default method is exact at any step."""
    forces = trace(fmu, "backwardEuler", z)
    assert (forces <= 1 + 1e-12).all() and (np.diff(forces) >= -1e-12).all()
    assert forces[:8] == pytest.approx(1 - (1 + z) ** -np.arange(1.0, 9.0), rel=1e-9)
    assert trace(fmu, "collocation", z) == pytest.approx(-np.expm1(-z * np.arange(1, 41)), rel=1e-12)


@pytest.mark.parametrize("method", ["collocation", "cvode", *ORDERS])
def test_every_method_ends_exactly_at_the_communication_point(fmu: FrictionFmu, method: str) -> None:
    """The internal step does not divide the communication step, yet V(t) is reached where it should be."""
    for h in (1e-5, 1.00001e-5):
        errors = final_errors(fmu, SMOOTH | {"solver.tolerance": 1e-8}, method, h / 3.1e-9, h)
        assert errors.max() < (2e-3 if ORDERS.get(method) == 1 else 1e-5)
