"""Contacts that are open, and loads that jump."""

from __future__ import annotations

import math

import pytest

from frictioncontact.fmu import FrictionFmu, Session, Value
from tools.reference import changed, follow, scene_of

MU = 0.176
CONTACTS = ("Asperities", "Mindlin", "Constant")
BY_LOAD: dict[str, Value] = {"contact.input": "Load", "friction.limit": "Load", "load": 100.0}
SOFT = {"Asperities": 1e-5, "Mindlin": 1e-2, "Constant": 1.0}


def pressed(law: str, model: str, **more: Value) -> dict[str, Value]:
    start = {"friction.model": law, "contact.model": model, "contact.stiffnessScale": SOFT[model]}
    return {**BY_LOAD, **start, "solver.tolerance": 1e-7, **more}


def assert_open(session: Session, F_t: float, F_y: float = 0.0, *, constant: bool = False) -> None:
    """Viscous friction alone."""
    assert session.read(["F_n", "A_r", "delta", "delta_y"]).tolist() == [0.0] * 4
    for end in ("", "_settled"):
        forces = session.read([f"F_t{end}", f"F_y{end}"])
        assert forces == pytest.approx([F_t, F_y], rel=1e-14)
    slopes = [session.slope("F_t_settled", name) for name in ("V", "V_y", "d", "E", "load")]
    assert slopes == pytest.approx([2.0, 0.0, 0.0, 0.0, 0.0])
    assert constant or session.get("sigma") == 0.0


@pytest.mark.parametrize("load", [0.0, -5.0, 1e-101])
@pytest.mark.parametrize("model", CONTACTS)
def test_a_contact_that_starts_open(fmu: FrictionFmu, model: str, load: float) -> None:
    start = pressed("Dahl", model, load=load, V=0.1, V_y=-0.7, **{"friction.sigma_2": 2.0, "delta_y_0": 1e-9})
    with fmu.session(start) as session:
        session.step(1e-3)
        assert_open(session, 0.2, -1.4, constant=model == "Constant")
        session.set("load", 100.0)
        session.set("V_y", 0.0)
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


@pytest.mark.parametrize("law", ["Dahl", "ElasticPlastic"])
def test_the_heat_of_surfaces_pressed_together(fmu: FrictionFmu, law: str) -> None:
    """Eq. 3: g ~ L and sigma = c L^2, where d^-3 moves c by half: (mu^2 / c) ln(L_1 / L_0) and more."""
    values = {"friction.model": law, "friction.limit": "Load", "V": 0.0, "d": 16e-6}
    values |= {"contact.stiffnessScale": 1e-6}
    with fmu.session(values) as session:
        F_n, sigma = session.read(("F_n", "sigma"))
        session.set("d", 14e-6)
        F_n_1 = session.get("F_n")
    start = changed(scene_of(values), h=1e-6, delta_0=MU * F_n / sigma)
    heat = sum(each.Q_f for each in follow([start, changed(start, d=14e-6)]))
    closed = MU**2 * F_n**2 / sigma * math.log(F_n_1 / F_n)
    assert closed < heat < closed * (16 / 14) ** 3
    with fmu.session(values | {"delta_0": start.delta_0}) as session:
        session.step(1e-6)
        session.set("d", 14e-6)
        session.step(1e-6)
        assert session.get("Q_f") == pytest.approx(heat, rel=1e-9)


def test_a_lifted_contact_pressed_again(fmu: FrictionFmu) -> None:
    """It slid 5 mm at 1e-12 N. 100 N at once, in held steps or as a ramp: 0.88 mJ, not millions of J."""
    found = {}
    for count in (0, 1, 1000):
        with fmu.session({**BY_LOAD, "load": 1e-12, "V": 0.1}) as session:
            session.step(0.05)
            before = session.get("Q_f")
            if count == 0:
                session.set_rates(load=100.0 / 1e-3)
                session.step(1e-3)
            for k in range(count):
                session.set("load", 100.0 * (k + 0.5) / count)
                session.step(1e-3 / count)
            found[count] = session.get("Q_f") - before
    assert found[0] == pytest.approx(0.5 * MU * 100.0 * 1e-4, rel=1e-3)
    assert found[1] == pytest.approx(found[0], rel=1e-2)
    assert found[1000] == pytest.approx(found[0], rel=1e-5)
