"""Mean friction of the periodic state, by the FMU, against closed forms and the reference.

By `periodic_mean`, and by one step over a period from a settled start.
"""

from __future__ import annotations

import numpy as np
import pytest

from frictioncontact.batch import simulate_many
from frictioncontact.fmu import FrictionFmu
from frictioncontact.gap import stiffness
from frictioncontact.parameters import (
    IDENTIFIED,
    IDENTIFIED_ABSOLUTE,
    SEPARATION,
    TABLE_2,
    Surfaces,
    start_values,
)
from frictioncontact.periodic import periodic_mean
from workshop.project import ROOT
from workshop.reference import solution as reference
from workshop.reference.arithmetic import MP
from workshop.reference.start_values import scene_of

ACCURATE = {"solver.tolerance": 1e-11}


def constant_stiffness(kappa: float, zeta: float) -> dict[str, float | str]:
    V_1, f, F_C = 1.0, 20e3, 55.0
    return {
        "contact.model": "Constant",
        "contact.sigma": kappa * 2 * np.pi * f * F_C / V_1,
        "V": zeta * V_1,
        "vibration.V_1": V_1,
        **ACCURATE,
    }


@pytest.mark.parametrize(
    ("kappa", "zeta", "printed"),
    [(1.0, 0.1, 0.122328249), (2.0, 0.25, 0.227294259), (5.0, 0.5, 0.379341496)],
)
def test_mean_at_constant_stiffness(fmu: FrictionFmu, kappa: float, zeta: float, printed: float) -> None:
    start = constant_stiffness(kappa, zeta)
    assert periodic_mean(fmu, start) / 55.0 == pytest.approx(printed, abs=1e-9)


def test_a_moving_separation_asks_for_a_stiffer_contact_than_a_constant_one(fmu: FrictionFmu) -> None:
    """docs/physics.md says how far the mean lies from Coulomb's over the phase, at two kappa."""
    text = " ".join((ROOT / "docs" / "physics.md").read_text(encoding="utf-8").split())
    zeta, V_1, F_C = 0.05, 1.44, 55.0
    coulomb = 2 / np.pi * F_C * np.arcsin(zeta)
    assert f"Coulomb's mean is {coulomb:.2f} N" in text
    for kappa in (100.0, 3000.0):
        sigma = kappa * 2 * np.pi * 20e3 * F_C / V_1
        scene = {
            "V": zeta * V_1,
            "vibration.V_1": V_1,
            "vibration.a_d": 1.1e-6,
            "contact.stiffnessScale": sigma / stiffness(Surfaces(), SEPARATION),
            "vibration.phase_d": np.linspace(0.0, 2 * np.pi, 73),
        }
        means = simulate_many(scene, settled=True, fmu=fmu.path)["F_t_mean"]
        assert means.min() < coulomb < means.max()
        assert f"{means.min():.1f} and {means.max():.1f} N" in text
    assert np.max(np.abs(means - coulomb)) < 0.01 * F_C


def test_how_far_kappa_100_is_from_coulomb_is_what_the_page_says(fmu: FrictionFmu) -> None:
    text = " ".join((ROOT / "docs" / "physics.md").read_text(encoding="utf-8").split())
    off = {
        zeta: periodic_mean(fmu, constant_stiffness(100.0, zeta)) / 55.0 - 2 / np.pi * np.arcsin(zeta)
        for zeta in (0.3, 0.9, 0.99)
    }
    said = f"{off[0.3]:.4f} F_C at ζ = 0.3, by {off[0.9]:.3f} F_C at 0.9 and by {off[0.99]:.3f} F_C at 0.99"
    assert said in text


@pytest.mark.parametrize("kappa", [1e-5, 1e-12])  # the relaxation takes 1e5 and 1e12 periods
@pytest.mark.parametrize("zeta", [-0.9, 0.05, 0.3, 0.999])
def test_soft_limit(fmu: FrictionFmu, zeta: float, kappa: float) -> None:
    turn = MP.acos(-MP.mpf(zeta))
    mean_speed = MP.quad(lambda x: abs(zeta + MP.cos(x)), [0, turn, 2 * MP.pi - turn, 2 * MP.pi])
    expected = float(zeta * 2 * MP.pi / mean_speed)
    mean = periodic_mean(fmu, constant_stiffness(kappa, zeta))
    assert mean / 55.0 == pytest.approx(expected, abs=1e-8)


IDENTIFIED_ABSOLUTE_MEANS = {1: 55.00, 2: 21.05, 3: 27.05, 6: 27.95}


@pytest.mark.parametrize("number", IDENTIFIED_ABSOLUTE_MEANS)
def test_table_2_identified_by_the_mean_of_the_absolute_force(fmu: FrictionFmu, number: int) -> None:
    points = 4000
    period = 1.0 / 20e3
    start = start_values(TABLE_2[number - 1], IDENTIFIED_ABSOLUTE) | ACCURATE
    with fmu.session(start) as session:
        session.step(1e6 * period)
        force = np.empty(points)
        for k in range(points):
            session.step(period / points)
            force[k] = session.get("F_t")
    assert np.abs(force).mean() == pytest.approx(IDENTIFIED_ABSOLUTE_MEANS[number], abs=0.0055)


@pytest.mark.parametrize("V", [0.5, 1.0, 1.5, -2.0])
def test_velocity_weighted_mean_is_the_coulomb_force_times_mean_over_mean_speed(
    fmu: FrictionFmu, V: float
) -> None:
    """Over a period of the periodic state, integral F |V| dt = F_C integral V dt, whatever sigma(t) does.

    Where V keeps its sign that integral is the work.
    """
    start = start_values(TABLE_2[1], IDENTIFIED) | ACCURATE | {"V": V}
    scene, period = scene_of(start), 1.0 / 20e3
    with fmu.session(start) as session:
        session.step(1e6 * period)
        delta, W_f = session.get("delta"), session.get("W_f")
        session.step(period)
        assert session.get("delta") == pytest.approx(delta, rel=1e-9)
        work = session.get("W_f") - W_f
    expected = reference.solve(scene, 0, scene.period, reference.periodic_deflection(scene))[2]
    assert work == pytest.approx(float(expected), rel=1e-9, abs=1e-12 * abs(W_f))
    if abs(V) > scene.V_1:
        assert work == pytest.approx(55.0 * abs(V) * period, rel=1e-9, abs=1e-12 * abs(W_f))
