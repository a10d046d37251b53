"""What each law of friction is for, by the FMU, against formulas and numbers computed apart from it."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from frictioncontact.fmu import FrictionError, FrictionFmu, Value
from workshop.project import ROOT

PHYSICS = (ROOT / "docs" / "physics.md").read_text(encoding="utf-8")

SETTLED = {"initialState": "Settled"}
VIBRATING = {"V": 0.3, "vibration.V_1": 1.44, "vibration.a_d": 1.1e-6, "contact.stiffnessScale": 4.4e-7}


@pytest.mark.parametrize("scene", [{}, VIBRATING | {"friction.limit": "Load"}])
@pytest.mark.parametrize("method", ["collocation", "cvode", "rk4"])
def test_lugre_without_static_excess_is_dahl_bit_for_bit(
    fmu: FrictionFmu, scene: dict[str, Value], method: str
) -> None:
    results = []
    for law in ("Dahl", "LuGre"):
        with fmu.session({**scene, "friction.model": law, "solver.method": method}) as session:
            if method == "rk4" and not scene:
                session.set("contact.stiffnessScale", 1e-6)
            session.step(7e-6)
            session.step(13e-6)
            results.append(session.read(["F_t", "F_t_mean", "W_f", "Q_f", "delta"]).tolist())
    assert results[0] == results[1]


@pytest.mark.parametrize("scene", [{}, VIBRATING | {"friction.limit": "Load"}])
def test_elastic_plastic_with_a_static_ratio_of_1_has_no_stribeck_velocity(
    fmu: FrictionFmu, scene: dict[str, Value]
) -> None:
    """Bit for bit, at a Stribeck velocity far below V and at one far above."""
    results = []
    for V_S in (0.01, 1e-9, 1e3):
        stribeck = {"friction.model": "ElasticPlastic", "friction.staticRatio": 1.0, "friction.V_S": V_S}
        with fmu.session({**scene, **stribeck}) as session:
            for h in (7e-6, 13e-6, 1e-3):
                session.step(h)
            session.set_rates(V=10.0)
            session.step(6e-5)
            results.append(session.read(["F_t", "F_t_mean", "W_f", "Q_f", "delta"]).tolist())
    assert results[0] == results[1] == results[2]


@pytest.mark.parametrize("law", ["Dahl", "ElasticPlastic"])
def test_the_pace_does_not_matter(fmu: FrictionFmu, law: str) -> None:
    """V n times as large, and d, E and the vibration n times as fast: the same force along the path."""
    forces = []
    for n in (1.0, 1000.0):
        speeds = {"V": n * 0.3, "vibration.V_1": n * 1.44, "vibration.f": n * 20e3}
        start = VIBRATING | speeds | {"friction.model": law, "delta_0": 5e-6, "solver.tolerance": 1e-8}
        with fmu.session(start) as session:
            session.set_rates(V=n * n * 1e3, d=n * 2e-3, E=n * 1e14)
            session.step(1.3e-4 / n)
            forces.append(session.read(["F_t", "F_t_mean", "W_f"]))
    assert forces[0] == pytest.approx(forces[1], rel=1e-6)


def test_dahl_s_force_stays_within_coulomb_s_at_constant_stiffness(fmu: FrictionFmu) -> None:
    random = np.random.default_rng(1)
    for sigma in (1e5, 1e7, 1e12):
        start = {"contact.model": "Constant", "contact.sigma": sigma, "vibration.V_1": 1.44}
        with fmu.session(start | {"delta_0": -55.0 / sigma}) as session:
            for part in random.uniform(0.01, 3.0, 30):
                session.set("V", random.uniform(-2.0, 2.0))
                session.step(part / 20e3)
                assert np.abs(session.read(["F_t", "F_t_mean"])).max() <= 55.0 * (1 + 1e-6)


def test_damping_under_vibration_changes_the_force_and_the_heat_and_not_the_mean(fmu: FrictionFmu) -> None:
    """Against scipy's integration of Eq. 2; docs/physics.md states the numbers."""
    sigma, V, V_1, T, F_C, sigma_1 = 2.54e6, 0.5, 1.44, 1 / 20e3, 55.0, 500.0

    def velocity(t: np.ndarray | float) -> np.ndarray:
        return V + V_1 * np.cos(2 * math.pi * t / T)

    def rate(t: np.ndarray | float, delta: np.ndarray) -> np.ndarray:
        return velocity(t) - sigma * np.abs(velocity(t)) * delta / F_C

    t = T * np.linspace(19.0, 20.0, 501)  # in the periodic state
    options = {"t_eval": t, "rtol": 1e-9, "atol": 1e-16, "max_step": T / 400}
    delta = solve_ivp(rate, (0.0, t[-1]), [0.0], **options).y[0]
    expected, found = {}, {}
    for damping in (0.0, sigma_1):
        force = sigma * delta + damping * rate(t, delta)
        heat = np.trapezoid(force * velocity(t), t)
        expected[damping] = [force.min() / F_C, force.max() / F_C, np.trapezoid(force, t) / T / F_C, heat]
        scene = {"contact.model": "Constant", "contact.sigma": sigma, "vibration.V_1": V_1, "V": V}
        with fmu.session(scene | SETTLED | {"friction.sigma_1": damping}) as session:
            forces, means, heat = [session.get("F_t")], [], session.get("Q_f")
            for _ in range(500):
                session.step(T / 500)
                forces.append(session.get("F_t"))
                means.append(session.get("F_t_mean"))
            found[damping] = [
                min(forces) / F_C,
                max(forces) / F_C,
                np.mean(means) / F_C,
                session.get("Q_f") - heat,
            ]
        assert found[damping] == pytest.approx(expected[damping], rel=2e-3)
    text = " ".join(PHYSICS.split())
    assert "from {:.1f} to {:.1f} F_C".format(*found[sigma_1][:2]) in text
    assert "from {:.2f} to {:.2f} F_C".format(*found[0.0][:2]) in text
    assert f"the heat {found[sigma_1][3] / found[0.0][3]:.0f} times" in text


def test_a_stuck_mass_creeps_with_dahl_and_not_with_elastic_plastic(fmu: FrictionFmu) -> None:
    """1 kg under 30 N + 10 N cos at 50 Hz: it goes first, then the contact, stable up to 2 ms."""
    scene = {"V": 0.0, "contact.model": "Constant", "contact.sigma": 1e6, "friction.sigma_1": 300.0}
    creep, h = {}, 2e-4
    for law in ("Dahl", "ElasticPlastic"):
        velocities = [0.0]
        with fmu.session(scene | {"friction.model": law}) as session:
            for k in range(2000):
                load = 30.0 + 10.0 * math.cos(2 * math.pi * k / 100)
                velocities.append(velocities[-1] + h * (load - session.get("F_t")))
                session.set("V", velocities[-1])
                session.step(h)
        position = h * np.cumsum(velocities[1:])
        creep[law] = (position[-100:].mean() - position[-1100:-1000].mean()) / 10  # m per cycle
    assert abs(creep["ElasticPlastic"]) < 1e-13
    assert creep["Dahl"] > 1e-8


def test_the_bound_of_an_amplitude_under_a_load_is_said(fmu: FrictionFmu) -> None:
    """The one in the message is a bound: a little less is accepted, a little more is not."""
    pressed = {"contact.input": "Load", "load": 1e4}
    message = r"load = 1e\+09 N presses the surfaces together"
    with pytest.raises(FrictionError, match=message), fmu.session(pressed | {"load": 1e9}):
        pass
    message = r"vibration\.a_d = 0\.001 m presses the surfaces together under load = 10000 N: "
    with (
        pytest.raises(FrictionError, match=message) as refused,
        fmu.session(pressed | {"vibration.a_d": 1e-3}),
    ):
        pass
    bound = float(re.search(r"up to (\S+) m,", str(refused.value))[1])
    with fmu.session(pressed | {"vibration.a_d": (1 - 1e-8) * bound}):
        pass
    with pytest.raises(FrictionError), fmu.session(pressed | {"vibration.a_d": (1 + 1e-8) * bound}):
        pass


def test_methods_that_know_no_motion_across_are_named(fmu: FrictionFmu) -> None:
    for method in fmu.known.items["solver.method"].keys() - {"collocation", "cvode"}:
        across = {"vibration.V_2": 1.0, "solver.method": method}
        message = f"solver.method = {method} knows no motion across V"
        with fmu.session(across) as session, pytest.raises(FrictionError, match=message):
            session.step(1e-5)
