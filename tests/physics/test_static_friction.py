"""ElasticPlastic with static friction: break-away, sticking under vibration, stop and go; by formulas."""

from __future__ import annotations

import math

import pytest
from physics.course import Course

from frictioncontact.fmu import FrictionFmu, Session, Value
from workshop.reference.settled import settled
from workshop.reference.start_values import scene_of

SIGMA, F_C, RATIO, V_S = 2.5e6, 55.0, 1.5, 0.01
F_S = RATIO * F_C
SCALE = F_S
SPRING: dict[str, Value] = {
    "friction.model": "ElasticPlastic",
    "friction.staticRatio": RATIO,
    "friction.V_S": V_S,
    "contact.model": "Constant",
    "contact.sigma": SIGMA,
}


def kinetic(V: float) -> float:
    return F_C * (1 + (RATIO - 1) * math.exp(-((V / V_S) ** 2)))


def stored(session: Session) -> float:
    return SIGMA * session.get("delta") ** 2 / 2


def assert_energy(session: Session, stored_0: float = 0.0, scale: float = 1e-3) -> None:
    """W = Q + stored."""
    W_f, Q_f = session.get("W_f"), session.get("Q_f")
    assert W_f - Q_f == pytest.approx(stored(session) - stored_0, abs=1e-11 * scale)


@pytest.mark.parametrize("V", [1e-5, -1e-3, 5e-3, 0.01, -0.03, 1.0])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-8])
def test_break_away_is_at_the_static_limit_whatever_V_is(
    fmu: FrictionFmu, V: float, tolerance: float
) -> None:
    """Just before F_s, just behind F_k; the drop's heat is (F_s^2 - F_k^2) / (2 sigma)."""
    side, way = math.copysign(1.0, V), F_S / SIGMA
    with fmu.session({**SPRING, "V": V, "solver.tolerance": tolerance}) as session:
        session.step((1 - 1e-9) * way / abs(V))
        assert session.get("F_t") == pytest.approx(side * F_S, rel=2e-9)
        assert session.get("Q_f") == pytest.approx(0.0, abs=1e-15)
        session.step(2e-9 * way / abs(V))
        F_k = kinetic(V)
        assert session.get("F_t") == pytest.approx(side * F_k, abs=tolerance * SCALE)
        heat = (F_S**2 - F_k**2) / (2 * SIGMA)
        assert session.get("Q_f") == pytest.approx(heat, abs=1e-8 * F_S * way)
        session.step(10 * way / abs(V))
        assert session.get("F_t_mean") == pytest.approx(side * F_k, abs=tolerance * SCALE)
        assert_energy(session)


@pytest.mark.parametrize("V_1", [0.02, 0.5, 4.0])
@pytest.mark.parametrize("h", [1.7e-6, 1e-3, 1000.0])
def test_a_vibration_below_break_away_makes_no_heat_and_no_drift(
    fmu: FrictionFmu, V_1: float, h: float
) -> None:
    """V_1 far above V_S, 40 nm to 32 um of swing at 20 kHz, around 0 and around 77 N less the swing."""
    swing = SIGMA * V_1 / (2 * math.pi * 20e3)
    for force in (0.0, max(0.0, F_S - 1.01 * swing)):
        scene = {**SPRING, "V": 0.0, "vibration.V_1": V_1, "delta_0": force / SIGMA}
        with fmu.session(scene) as session:
            for _ in range(3):
                session.step(h)
            assert session.get("Q_f") == pytest.approx(0.0, abs=1e-11 * F_S * swing / SIGMA)
            t = 3 * h * 20e3
            phase = math.sin(2 * math.pi * (t - math.floor(t)))
            assert session.get("F_t") == pytest.approx(force + swing * phase, abs=1e-7 * SCALE)
            assert session.get("F_t_settled") == pytest.approx(force, abs=1e-6 * SCALE)


@pytest.mark.parametrize("V", [1e-3, 0.5])
def test_stop_and_go_shows_static_friction_again(fmu: FrictionFmu, V: float) -> None:
    with fmu.session({**SPRING, "V": V, "solver.tolerance": 1e-8}) as session:
        session.step(2 * F_S / SIGMA / V)
        F_k = session.get("F_t")
        session.set("V", 0.0)
        session.step(1.0)
        session.set("V", V)
        session.step((1 - 1e-9) * (F_S - F_k) / SIGMA / V)
        assert session.get("F_t") == pytest.approx(F_S, rel=1e-6)
        session.step(2e-8 * F_S / SIGMA / V)
        assert session.get("F_t") == pytest.approx(F_k, rel=1e-6)


CYCLES = [
    {"V": 0.3, "vibration.V_1": 1.44},
    {"V": 0.01, "vibration.V_1": 0.02, "friction.V_S": 0.3},
    {
        "V": 0.5,
        "vibration.V_1": 1.44,
        "vibration.a_d": 1e-6,
        "vibration.phase_d": 1.0,
        "friction.limit": "Load",
    }
    | {"contact.model": "Asperities", "contact.stiffnessScale": 4.4e-7},
    {"V": 1e-3, "vibration.V_1": 0.5, "friction.V_S": 2.0, "contact.sigma": 1e7},
]


@pytest.mark.parametrize("change", CYCLES)
def test_the_settled_mean_is_that_of_the_whole_cycle(fmu: FrictionFmu, change: dict[str, Value]) -> None:
    values = {**SPRING, **change}
    mean = float(settled(scene_of(values), 0, 0.0).mean)
    with fmu.session({**values, "solver.tolerance": 1e-8}) as session:
        assert session.get("F_t_settled") == pytest.approx(mean, abs=1e-8 * F_S)


@pytest.mark.parametrize(("duration", "peak"), [(1e-5, 100.0), (1e-2, 50.0 * (1 + math.exp(-0.16)))])
def test_held_samples_come_to_the_ramp_that_they_sample(
    fmu: FrictionFmu, duration: float, peak: float
) -> None:
    """V falls from 50 to 20 mm/s. If its bound rises faster than the bristle moves, the bristle sticks."""
    start: dict[str, Value] = {"F_C": 50.0, "contact.sigma": 5e6, "friction.V_S": 0.05}
    with fmu.session({**SPRING, **start, "friction.staticRatio": 2.0, "V": 0.05}) as session:
        session.step(0.1)
        largest = 0.0
        for k in range(100):
            session.set("V", 0.05 - 0.03 * (k + 1) / 100)
            session.step(duration / 100)
            largest = max(largest, session.get("F_t"))
        for _ in range(1000):
            session.step(1e-6)
            largest = max(largest, session.get("F_t"))
        assert largest == pytest.approx(peak, abs=0.11)


STEPS = [
    ({"V": 0.2}, {}, 1e-4),
    ({"V": 0.2}, {"V": -4e3}, 1e-4),
    ({"V": -0.2}, {"V": 2e3, "d": -5e-3}, 2e-4),
    ({"V": 0.4, "d": 14.5e-6}, {"d": 2e-2}, 5e-5),
    ({"V": -0.1, "d": 14e-6}, {}, 1.3e-5),
    ({"V": 0.0, "d": 16e-6}, {"V": 1e3}, 1.1e-4),
]


VIBRATION: dict[str, Value] = {"vibration.V_1": 0.6, "vibration.a_d": 5e-7}


@pytest.mark.parametrize(
    ("model", "limit", "vibration"),
    [
        ("Constant", "Constant", {}),
        ("Constant", "Load", VIBRATION),
        ("Asperities", "Constant", VIBRATION),
        ("Asperities", "Load", {}),
        ("Mindlin", "Constant", {}),
        ("Mindlin", "Load", VIBRATION),
    ],
)
def test_a_course_of_steps_and_jumps(
    fmu: FrictionFmu, model: str, limit: str, vibration: dict[str, Value]
) -> None:
    """The reference's, with every input held, linear and jumping; energy through all of it."""
    scale = {"Asperities": 1e-6, "Mindlin": 1e-3, "Constant": 1.0}[model]
    values = {**SPRING, **vibration, "friction.V_S": 0.1, "friction.limit": limit, "contact.model": model}
    values |= {"contact.stiffnessScale": scale, "contact.sigma": 5e6, "V": 0.2, "solver.tolerance": 1e-7}
    scene, energy = scene_of(values), 0.0
    course = Course(scene, 0.0)
    with fmu.session(values) as session:
        inputs = {"V": 0.2, "d": 14e-6}
        for change, rates, h in STEPS:
            inputs |= change
            for name, value in inputs.items():
                session.set(name, value)
            session.set_rates(**{name: rates.get(name, 0.0) for name in inputs})
            session.step(h)
            now = scene_of({**values, **inputs})
            now = type(now)(**{**now.__dict__, **{f"{name}_rate": rate for name, rate in rates.items()}})
            step = course.step(now, h)
            energy += step.scale * step.path
            for name in ("F_t", "F_t_mean"):
                assert abs(session.get(name) - float(getattr(step, name))) < 1.1e-7 * step.scale, name
            for name in ("W_f", "Q_f"):
                value = float(getattr(step, name))
                assert abs(session.get(name) - value) < 1e-7 * energy + 1e-10 * abs(value), name
            inputs = {name: value + rates.get(name, 0.0) * h for name, value in inputs.items()}
