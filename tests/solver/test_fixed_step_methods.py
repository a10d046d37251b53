"""The fixed-step methods: orders of convergence, stability limits and how each behaves beyond them.

z = sigma |V| h / F_C. Explicit Euler is stable for z < 2 and monotone for z < 1; RK4 is stable for z <
2.785; the trapezoid never blows up but rings for z > 2; backward Euler and collocation have no limit.
"""

from __future__ import annotations

import re

import numpy as np
import pytest

from frictioncontact.fmu import FrictionError, FrictionFmu
from workshop.reference import solution as reference
from workshop.reference.arithmetic import EXTENDED, MP, multiprecision
from workshop.reference.scene import Drive
from workshop.reference.start_values import scene_of

ORDERS = {"explicitEuler": 1, "backwardEuler": 1, "trapezoid": 2, "rk4": 4}
EXPLICIT = {"explicitEuler": 2.0, "rk4": 2.785293563405282}
SIGMA, V, F_C = 2.5e6, 0.5, 55.0
RATE = SIGMA * V / F_C  # 1/s

# V keeps its sign and everything moves: nothing but the method's own order limits it.
SMOOTH = {
    "V": 2.0,
    "vibration.V_1": 0.9,
    "vibration.a_d": 5e-7,
    "vibration.phase_d": 1.0,
    "contact.stiffnessScale": 4e-7,
}


def final_errors(fmu: FrictionFmu, start: dict, method: str, steps: int, h: float) -> np.ndarray:
    """Of F_t, F_t_mean and W_f, relative."""
    scene = scene_of(start)
    delta, impulse, work = reference.solve(scene, 0, MP.mpf(h), 0)
    expected = [
        float(reference.force(scene, h, delta)),
        float(multiprecision(impulse) / MP.mpf(h)),
        float(work),
    ]
    with fmu.session(start | {"solver.method": method, "solver.stepSize": h / steps}) as session:
        session.step(h)
        got = session.read(("F_t", "F_t_mean", "W_f"))
    return np.abs(got / expected - 1)


@pytest.mark.parametrize("method", ORDERS)
def test_order_of_convergence(fmu: FrictionFmu, method: str) -> None:
    h = 3.7e-5
    coarse, fine = (final_errors(fmu, SMOOTH, method, steps, h) for steps in (400, 800))
    orders = np.log2(coarse / fine)
    assert orders == pytest.approx(ORDERS[method], abs=0.1)


@pytest.mark.parametrize(
    ("method", "evaluations"), [("explicitEuler", 8), ("backwardEuler", 8), ("trapezoid", 9), ("rk4", 17)]
)
def test_evaluations_of_eight_steps(fmu: FrictionFmu, method: str, evaluations: int) -> None:
    """The end of a step is the start of the next; RK4 has a middle too."""
    h = 3.7e-5
    with fmu.session(SMOOTH | {"solver.method": method, "solver.stepSize": h / 8}) as session:
        session.step(h)
        assert session.get("solver.evaluations") == evaluations


@pytest.mark.parametrize("method", ORDERS)
def test_work_of_the_damping(fmu: FrictionFmu, method: str) -> None:
    """sigma_1 (integral of delta' V dt), by Gauss quadrature over the reference's deflections."""
    h, sigma_1 = 3.7e-5, 2e4
    scene = scene_of(SMOOTH)
    nodes, weights = np.polynomial.legendre.leggauss(16)
    work = float(reference.solve(scene, 0, MP.mpf(h), 0)[2])
    for node, weight in zip(0.5 * h * (nodes + 1.0), 0.5 * h * weights, strict=True):
        V = SMOOTH["V"] + SMOOTH["vibration.V_1"] * np.cos(2.0 * np.pi * 20e3 * node)
        delta = reference.solve(scene, 0, MP.mpf(node), 0)[0]
        force = float(reference.force(scene, node, delta))
        work += sigma_1 * weight * V * (V - abs(V) * force / F_C)
    start = SMOOTH | {"friction.sigma_1": sigma_1, "solver.method": method, "solver.stepSize": h / 4000}
    with fmu.session(start) as session:
        session.step(h)
        assert session.get("W_f") == pytest.approx(work, rel={1: 2e-3, 2: 2e-6, 4: 1e-9}[ORDERS[method]])


@pytest.mark.parametrize("method", ORDERS)
def test_a_step_over_a_reversal_costs_high_orders(fmu: FrictionFmu, method: str) -> None:
    """|V| has a kink there, so no method of these keeps more than order 2; it still converges."""
    start = SMOOTH | {"V": 0.3}
    coarse, fine = (final_errors(fmu, start, method, steps, 3.7e-5) for steps in (1000, 16000))
    assert (fine < coarse / 8).all()


def sliding(method: str, z: float, **more: float) -> dict[str, float | str]:
    return {
        "contact.model": "Constant",
        "contact.sigma": SIGMA,
        "V": V,
        "solver.method": method,
        "solver.stepSize": z / RATE,
        **more,
    }


def trace(fmu: FrictionFmu, method: str, z: float, steps: int = 40, **more: float) -> np.ndarray:
    """F_t / F_C after each internal step, which is also the communication step."""
    with fmu.session(sliding(method, z, **more)) as session:
        forces = np.empty(steps)
        for k in range(steps):
            session.step(z / RATE)
            forces[k] = session.get("F_t") / F_C
    return forces


@pytest.mark.parametrize("method", EXPLICIT)
@pytest.mark.parametrize("z", [3.0, 1e3, 1e9])
def test_the_refusal_names_a_step_that_works(fmu: FrictionFmu, method: str, z: float) -> None:
    with fmu.session(sliding(method, z)) as session:
        before = session.read()
        with pytest.raises(FrictionError) as refusal:
            session.step(100 * z / RATE)
        assert (session.read() == before).all()
    message = str(refusal.value)
    assert "solver.stepSize" in message and method in message
    usable = float(re.search(r"largest usable step is (\S+) s", message).group(1))
    assert usable == pytest.approx(EXPLICIT[method] / RATE, rel=0.02)
    with fmu.session(sliding(method, z, **{"solver.stepSize": usable})) as session:
        session.step(1000 * usable)
        assert abs(session.get("F_t")) <= 2 * F_C


def test_the_refusal_under_vibration_goes_by_the_largest_rate(fmu: FrictionFmu) -> None:
    start = SMOOTH | {"V": 0.3, "solver.method": "explicitEuler", "solver.stepSize": 1e-4}
    scene = scene_of(start)
    drive = Drive(scene, 0, EXTENDED)
    largest = drive.relaxation_rate(EXTENDED.array(np.linspace(0, 5e-5, 4001))).max()
    with fmu.session(start) as session, pytest.raises(FrictionError) as refusal:
        session.step(1e-3)
    usable = float(re.search(r"largest usable step is (\S+) s", str(refusal.value)).group(1))
    assert usable == pytest.approx(float(2 / largest), rel=0.02)


@pytest.mark.parametrize(
    ("z", "rings"), [(0.1, False), (1.96, False), (2.04, True), (50.0, True), (1e6, True)]
)
def test_trapezoid_rings_beyond_2_and_never_blows_up(fmu: FrictionFmu, z: float, rings: bool) -> None:
    forces = trace(fmu, "trapezoid", z)
    assert bool((forces > 1 + 1e-12).any()) is rings
    assert (np.abs(forces - 1) <= 1 + 1e-12).all()  # the error at the start, and no more
    growth = (1 - z / 2) / (1 + z / 2)
    assert forces[:8] == pytest.approx(1 - growth ** np.arange(1, 9), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("z", [0.1, 2.04, 50.0, 1e8])
def test_backward_euler_never_rings(fmu: FrictionFmu, z: float) -> None:
    forces = trace(fmu, "backwardEuler", z)
    assert (forces <= 1 + 1e-12).all() and (np.diff(forces) >= -1e-12).all()
    assert forces[:8] == pytest.approx(1 - (1 + z) ** -np.arange(1.0, 9.0), rel=1e-9)


@pytest.mark.parametrize("z", [1e-3, 0.1, 2.04, 50.0, 1e8])
def test_the_default_method_is_exact_at_any_step(fmu: FrictionFmu, z: float) -> None:
    forces = trace(fmu, "collocation", z)
    assert forces == pytest.approx(-np.expm1(-z * np.arange(1, 41)), rel=1e-12)


@pytest.mark.parametrize("method", ["collocation", "cvode", *ORDERS])
def test_every_method_ends_exactly_at_the_communication_point(fmu: FrictionFmu, method: str) -> None:
    """The internal step does not divide the communication step, yet V(t) is reached where it should be."""
    start = SMOOTH | {"solver.method": method, "solver.stepSize": 3.1e-9, "solver.tolerance": 1e-8}
    for h in (1e-5, 1.00001e-5, 7.77e-6):
        scene = scene_of(start)
        delta, _, _ = reference.solve(scene, 0, MP.mpf(h), 0)
        with fmu.session(start) as session:
            session.step(h)
            assert session.get("F_t") == pytest.approx(
                float(reference.force(scene, h, delta)), rel=2e-3 if ORDERS.get(method) == 1 else 1e-5
            )


@pytest.mark.parametrize("sigma_1", [0.0, 30.0])
@pytest.mark.parametrize(
    ("method", "within"),
    [
        ("explicitEuler", 1e-2),
        ("backwardEuler", 1e-2),
        ("trapezoid", 1e-4),
        ("rk4", 1e-9),
        ("cvode", 1e-5),
        ("collocation", 1e-12),
    ],
)
def test_work_and_heat_of_every_method(fmu: FrictionFmu, method: str, within: float, sigma_1: float) -> None:
    """From rest at constant speed: what of the work is not stored in the bristle is heat."""
    h = 2.0 / RATE
    start = {
        "V": V,
        "contact.model": "Constant",
        "contact.sigma": SIGMA,
        "friction.sigma_1": sigma_1,
        "solver.method": method,
        "solver.stepSize": h / 1000,
    }
    D = F_C / SIGMA
    delta = D * -np.expm1(-2.0)
    damped = sigma_1 * V * delta
    work = F_C * (V * h - delta) + damped
    heat = work - SIGMA * delta**2 / 2
    with fmu.session(start) as session:
        session.step(h)
        assert session.read(("W_f", "Q_f")) == pytest.approx([work, heat], rel=within)
