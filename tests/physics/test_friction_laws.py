"""What each law of friction is for, by the FMU, against formulas and numbers computed apart from it."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from frictioncontact.fmu import FrictionError, FrictionFmu, Value
from tools.project import ROOT
from tools.reference import changed, follow, scene_of

PHYSICS = (ROOT / "docs" / "physics.md").read_text(encoding="utf-8")

SETTLED = {"initialState": "Settled"}
VIBRATING = {"V": 0.3, "vibration.V_1": 1.44, "vibration.a_d": 1.1e-6, "contact.stiffnessScale": 4.4e-7}


def outputs(fmu: FrictionFmu, start: dict[str, Value]) -> list[float]:
    with fmu.session(start) as session:
        for h in (7e-6, 13e-6, 2e-5):
            session.step(h)
        session.set_rates(V=10.0)
        session.step(6e-5)
        return session.read(["F_t", "F_t_mean", "W_f", "Q_f", "delta"]).tolist()


SCENES = [{"contact.stiffnessScale": 1e-6}, {"V": 0.1}, VIBRATING | {"friction.limit": "Load"}]


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("method", ["collocation", "cvode", "rk4"])
def test_lugre_without_static_excess_is_dahl_bit_for_bit(
    fmu: FrictionFmu, scene: dict[str, Value], method: str
) -> None:
    if method == "rk4" and "contact.stiffnessScale" not in scene:
        pytest.skip("it is not stable there")
    dahl, lugre = (
        outputs(fmu, scene | {"friction.model": law, "solver.method": method}) for law in ("Dahl", "LuGre")
    )
    assert dahl == lugre


@pytest.mark.parametrize("scene", SCENES)
def test_elastic_plastic_with_a_static_ratio_of_1_has_no_stribeck_velocity(
    fmu: FrictionFmu, scene: dict[str, Value]
) -> None:
    """Bit for bit, at a Stribeck velocity far below V and at one far above."""
    law = {"friction.model": "ElasticPlastic", "friction.staticRatio": 1.0}
    results = [outputs(fmu, scene | law | {"friction.V_S": V_S}) for V_S in (0.01, 1e-9, 1e3)]
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
    """Against the reference; docs/physics.md states the numbers."""
    scene = {"contact.model": "Constant", "contact.sigma": 2.54e6, "V": 0.5, "vibration.V_1": 1.44}
    steps, F_C, sigma_1, found = 500, 55.0, 500.0, {}
    for damping in (0.0, sigma_1):
        values = scene | SETTLED | {"friction.sigma_1": damping}
        truth = follow([changed(scene_of(values), h=5e-5 / steps)] * steps)
        with fmu.session(values) as session:
            start, rows = session.get("Q_f"), []
            for _ in range(steps):
                session.step(5e-5 / steps)
                rows.append(session.read(["F_t", "F_t_mean"]))
            heat = session.get("Q_f") - start
        assert rows == pytest.approx(np.array([(each.F_t, each.F_t_mean) for each in truth]), abs=1e-3 * F_C)
        assert heat == pytest.approx(sum(each.Q_f for each in truth), rel=1e-3)
        forces = np.array(rows)[:, 0] / F_C
        found[damping] = (forces.min(), forces.max(), np.mean(rows, axis=0)[1] / F_C, heat)
    assert found[0.0][2] == pytest.approx(found[sigma_1][2], rel=1e-6)
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
