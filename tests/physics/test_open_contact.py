"""Contacts that open and close, inputs that jump, and what the tolerance is relative to."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from physics.course import Course

from frictioncontact.fmu import FrictionError, FrictionFmu, Session, Value
from workshop.reference.start_values import scene_of

MU = 0.176
LAWS = ("Coulomb", "Dahl", "ElasticPlastic", "LuGre")
CONTACTS = ("Asperities", "Mindlin", "Constant")
BY_LOAD: dict[str, Value] = {"contact.input": "Load", "friction.limit": "Load", "load": 100.0}
SOFT = {"Asperities": 1e-5, "Mindlin": 1e-2, "Constant": 1.0}


def pressed(law: str, model: str, **more: Value) -> dict[str, Value]:
    scale = SOFT[model]
    start = {"friction.model": law, "contact.model": model, "contact.stiffnessScale": scale}
    return {**BY_LOAD, **start, "solver.tolerance": 1e-7, **more}


def assert_open(session: Session, sigma_2_V: float = 0.0, *, constant: bool = False) -> None:
    assert session.read(["F_n", "A_r", "delta"]).tolist() == [0.0, 0.0, 0.0]
    assert session.get("F_t") == pytest.approx(sigma_2_V, rel=1e-14)
    assert session.get("F_t_settled") == pytest.approx(sigma_2_V, rel=1e-14)
    if not constant:
        assert session.get("sigma") == 0.0


VIBRATION: dict[str, Value] = {"vibration.V_1": 0.3, "vibration.a_d": 1e-6}


@pytest.mark.parametrize(
    ("law", "model", "vibration"),
    [
        ("Coulomb", "Mindlin", VIBRATION),
        ("Dahl", "Asperities", VIBRATION),
        ("Dahl", "Constant", {}),
        ("ElasticPlastic", "Mindlin", {}),
        ("ElasticPlastic", "Constant", VIBRATION),
        ("LuGre", "Constant", VIBRATION),
    ],
)
def test_a_load_that_falls_to_0_stays_and_comes_back(
    fmu: FrictionFmu, law: str, model: str, vibration: dict[str, Value]
) -> None:
    """In linear steps, through negative loads, and at 0; the reference step by step."""
    values = pressed(law, model, **{"friction.staticRatio": 1.3, "friction.V_S": 0.2}, **vibration)
    values |= {"V": 0.1, "friction.sigma_2": 2.0}
    scene, h, energy = scene_of(values), 1.1e-4, 0.0
    course = Course(scene, 0.0)
    loads = [100.0, -20.0, -20.0, 0.0, 0.0, 60.0, 100.0]  # at the ends of the steps
    with fmu.session(values) as session:
        before = 100.0
        for k, load in enumerate(loads):
            rate = (load - before) / h
            session.set("load", before)
            session.set_rates(load=rate)
            session.step(h)
            now = course.step(replace(scene, load=before, load_rate=rate), h)
            energy += now.scale * now.path
            before = load
            for name in ("F_t", "F_t_mean"):
                assert abs(session.get(name) - float(getattr(now, name))) < 1.1e-7 * now.scale, (k, name)
            for name in ("W_f", "Q_f"):
                value = float(getattr(now, name))
                assert abs(session.get(name) - value) < 1e-7 * energy + 1e-10 * abs(value), (k, name)
            if load < 0:  # at 0 the end of the step is 0 to rounding
                V = 0.1 + scene.V_1 * math.cos(2 * math.pi * scene.f * h * (k + 1))
                assert session.read(["F_n", "A_r", "delta"]).tolist() == [0.0, 0.0, 0.0]
                assert session.get("F_t") == pytest.approx(2.0 * V, rel=1e-9)


@pytest.mark.parametrize("load", [0.0, -5.0, 1e-101])
@pytest.mark.parametrize("model", CONTACTS)
def test_a_contact_that_starts_open(fmu: FrictionFmu, model: str, load: float) -> None:
    with fmu.session(pressed("Dahl", model, load=load, V=0.1, **{"friction.sigma_2": 2.0})) as session:
        session.step(1e-3)
        assert_open(session, 0.2, constant=model == "Constant")
        session.set("load", 100.0)
        session.step(1e-1)
        assert session.get("F_t") == pytest.approx(MU * 100.0 + 0.2, rel=1e-6)


@pytest.mark.parametrize("d", [1e-3, 2e-3])
def test_surfaces_far_apart(fmu: FrictionFmu, d: float) -> None:
    """F_n ~ e^(-d / 2 um): 1e-215 N at 1 mm, no number at 2 mm."""
    start = {"friction.limit": "Load", "V": 0.1, "d": d, "friction.sigma_2": 2.0}
    with fmu.session(start) as session:
        session.step(1e-3)
        assert_open(session, 0.2)
        session.set("d", 14e-6)
        session.step(1e-3)
        assert session.get("F_t") == pytest.approx(MU * 312.4415202 + 0.2, rel=1e-6)
        session.set("d", d)
        session.step(1e-3)
        assert_open(session, 0.2)


def test_a_constant_limit_and_stiffness_do_not_know_the_load(fmu: FrictionFmu) -> None:
    start = {"contact.input": "Load", "load": 100.0, "contact.model": "Constant", "V": 0.1}
    forces = []
    for load in (100.0, 0.0, -5.0):
        with fmu.session(start | {"load": load}) as session:
            session.step(1e-4)
            forces.append(session.get("F_t"))
    assert forces[0] == forces[1] == forces[2] > 1.0
    with fmu.session(
        {"contact.input": "Load", "load": 0.0, "friction.model": "Coulomb", "V": 0.1}
    ) as session:
        session.step(1e-4)
        assert session.get("F_t") == 55.0


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("rates", [False, True])
def test_a_mass_that_bounces(fmu: FrictionFmu, law: str, rates: bool) -> None:
    """1 kg falls on 1e6 N/m in steps of 10 us, sliding at 0.1 m/s: four contacts without an error."""
    mass, k, h, x, v = 1.0, 1e6, 1e-5, -1e-3, 0.0
    start = pressed(law, "Constant", load=0.0, V=0.1, **{"contact.sigma": 1e9, "friction.staticRatio": 1.2})
    contacts, was_closed, momentum, heat = 0, False, 0.0, 0.0
    with fmu.session(start) as session:
        silent = list(session.messages)
        while contacts < 4:
            load = max(0.0, k * x)
            v += h * (9.81 - load / mass)
            following = max(0.0, k * (x + h * v))
            session.set("load", load)
            if rates:
                session.set_rates(load=(following - load) / h)
            session.step(h)
            x += h * v
            momentum += session.get("F_t_mean") * h
            contacts += was_closed and load == 0.0
            was_closed = load > 0.0
            assert session.get("Q_f") >= heat - 1e-12
            heat = session.get("Q_f")
        assert session.get("F_t") == 0.0
        # it slips all but 20 nm of each contact: mu times the impulse, times V, is heat
        assert heat == pytest.approx(0.1 * momentum, rel=1e-2)
        assert session.messages == silent


@pytest.mark.parametrize("law", ["Dahl", "ElasticPlastic", "LuGre"])
def test_the_heat_of_a_load_that_jumps_down(fmu: FrictionFmu, law: str) -> None:
    """A constant stiffness gives up sigma (delta^2 - D^2) / 2, in one jump or in many."""
    sigma, first, last = 1e7, 100.0, 30.0
    expected = (MU * first) ** 2 / (2 * sigma) - (MU * last) ** 2 / (2 * sigma)
    for count in (1, 7):
        start = pressed(law, "Constant", V=0.0, delta_0=MU * first / sigma, **{"contact.sigma": sigma})
        with fmu.session(start) as session:
            session.step(1e-6)
            for k in range(1, count + 1):
                session.set("load", first + (last - first) * k / count)
                session.step(1e-6)
            assert session.get("Q_f") == pytest.approx(expected, rel=1e-10)
            assert session.get("F_t") == pytest.approx(MU * last, rel=1e-12)


@pytest.mark.parametrize("steps_before", [0, 1])
@pytest.mark.parametrize("law", ["Dahl", "ElasticPlastic"])
def test_the_heat_of_surfaces_pressed_together(fmu: FrictionFmu, law: str, steps_before: int) -> None:
    """Eq. 3: g ~ L and sigma = c L^2 but for d^-3; the integral of g |dD| by the reference."""
    values = {
        "friction.model": law,
        "friction.limit": "Load",
        "V": 0.0,
        "d": 16e-6,
        "contact.stiffnessScale": 1e-6,
    }
    scene = scene_of(values)
    F_n, sigma = [], []
    with fmu.session(values) as session:
        for d in (16e-6, 14e-6):
            session.set("d", d)
            F_n.append(session.get("F_n"))
            sigma.append(session.get("sigma"))
    D = MU * F_n[0] / sigma[0]
    course = Course(scene, D)
    with fmu.session(values | {"delta_0": D}) as session:
        course.step(scene, 1e-6)
        if steps_before:
            session.step(1e-6)
        session.set("d", 14e-6)
        session.step(1e-6)
        heat = float(course.step(replace(scene, d=14e-6), 1e-6).Q_f)
        assert session.get("Q_f") == pytest.approx(heat, rel=1e-9)
    # (mu^2 / c) ln(L_1 / L_0), with a c = sigma / L^2 that d^-3 moves by half
    closed = MU**2 * F_n[0] ** 2 / sigma[0] * math.log(F_n[1] / F_n[0])
    assert closed < heat < closed * (16 / 14) ** 3


def test_a_lifted_contact_pressed_again(fmu: FrictionFmu) -> None:
    """It slid 5 mm at 1e-12 N. 100 N at once, in held steps or as a ramp: 0.88 mJ, not millions of J."""
    start = {**BY_LOAD, "load": 1e-12, "V": 0.1}
    found = {}
    for count in (1, 10, 100, 1000):
        with fmu.session(start) as session:
            session.step(0.05)
            before = session.get("Q_f")
            for k in range(count):
                session.set("load", 100.0 * (k + 0.5) / count)
                session.step(1e-3 / count)
            found[count] = session.get("Q_f") - before
    with fmu.session(start) as session:
        session.step(0.05)
        before = session.get("Q_f")
        session.set_rates(load=100.0 / 1e-3)
        session.step(1e-3)
        ramp = session.get("Q_f") - before
    assert ramp == pytest.approx(0.5 * MU * 100.0 * 1e-4, rel=1e-3)
    errors = [abs(found[count] - ramp) / ramp for count in found]
    assert errors[0] < 1e-2 and errors[-1] < 1e-5


@pytest.mark.parametrize("factor", [0.099, 10.1])
def test_a_modulus_that_moves_by_more_than_ten_is_refused(fmu: FrictionFmu, factor: float) -> None:
    with fmu.session({"V": 0.1}) as session:
        E = session.get("E")
        before = session.read(["F_t", "delta", "Q_f"]).tolist()
        session.set_rates(E=(factor - 1) * E / 1e-4)
        with pytest.raises(FrictionError, match=r"\bE\b.*5\.8556"):
            session.step(1e-4)
        assert session.read(["F_t", "delta", "Q_f"]).tolist() == before
        session.set_rates(E=(9.9 - 1) * E / 1e-4)
        session.step(1e-4)


@pytest.mark.parametrize("law", ["Dahl", "ElasticPlastic", "LuGre"])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-8])
def test_a_press_of_80_times_is_graded_by_the_press(fmu: FrictionFmu, law: str, tolerance: float) -> None:
    """S is the largest of the limits at both ends and of the bristle's force at the start."""
    values = pressed(
        law, "Asperities", load=5.0, V=0.02, **{"friction.staticRatio": 1.3, "friction.V_S": 0.01}
    )
    values |= {"solver.tolerance": tolerance}
    scene, h = replace(scene_of(values), load_rate=395.0 / 1e-3), 1e-3
    step = Course(scene, 0.0).step(scene, h)
    assert step.scale == pytest.approx(MU * 400.0 * (1.3 if law in ("LuGre", "ElasticPlastic") else 1.0))
    with fmu.session(values) as session:
        session.set_rates(load=scene.load_rate)
        session.step(h)
        for name, size in (("F_t", 1.0), ("F_t_mean", 1.0), ("W_f", step.path), ("Q_f", step.path)):
            error = abs(session.get(name) - float(getattr(step, name)))
            assert error <= (tolerance + 1e-11) * step.scale * size, name
