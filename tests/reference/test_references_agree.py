"""Two references of different kind agree to 1e-12 before either grades a solver; in truth to 1e-16."""

from __future__ import annotations

import pytest

from frictioncontact.parameters import IDENTIFIED, PRINTED, TABLE_2, start_values
from workshop.reference import collocation as reference_collocation
from workshop.reference import constant as reference_constant
from workshop.reference import solution as reference
from workshop.reference.arithmetic import multiprecision
from workshop.reference.solution import EXTENDED, MP, MULTIPRECISION, Contact, Scene
from workshop.reference.start_values import scene_of

STIFF = Contact()
SOFT = Contact(stiffnessScale=1e-8)  # 6e4 N/m at 14 um
MEDIUM = Contact(stiffnessScale=4e-7)
PERIOD = 5e-5

SCENES = {
    "soft, all moving": Scene(V=0.3, V_1=1.44, a_d=1.1e-6, phase_d=1.0, contact=SOFT),
    "medium, identified row 2": scene_of(start_values(TABLE_2[1], IDENTIFIED)),
    "stiff, printed row 6": scene_of(start_values(TABLE_2[5], PRINTED)),
    "stiff, start elsewhere": Scene(V=-0.4, V_1=1.0, a_d=2e-6, phase_d=-2.0, start=0.123456789),
    "dip": Scene(V=1.0000001, V_1=1.0, a_d=1e-6, contact=Contact(stiffnessScale=1e-3)),
    "tangential reversal": Scene(V=0.9999999, V_1=1.0, a_d=1e-6, contact=Contact(stiffnessScale=1e-3)),
    "linear inputs": Scene(V=-0.01, V_rate=1e3, d_rate=0.04, E_rate=-4e14, contact=MEDIUM),
    "linear inputs and vibration": Scene(
        V=0.2, V_rate=-9e3, d_rate=0.03, E_rate=2e14, V_1=0.7, a_d=3e-7, phase_d=4.0, contact=MEDIUM
    ),
    "only the separation vibrates": Scene(V=0.005, a_d=1.1e-6),
    "reversal just beyond the end": Scene(
        V=-0.05, V_rate=-3e5, E_rate=-1.8e14, f=2639.0, V_1=2.8, a_d=2.1e-6, phase_d=5.4, F_C=1.66
    ),
    "at rest": Scene(V=0.0, d_rate=0.01),
}


@pytest.mark.parametrize("name", SCENES)
def test_quadrature_agrees_with_collocation(name: str) -> None:
    scene = SCENES[name]
    t0 = MP.mpf(scene.start)
    t1 = t0 + MP.mpf("0.8") * MP.mpf(PERIOD)
    delta_0 = float(0.4 * scene.F_C / reference.sigma(scene, t0))
    by_quadrature = reference.advance(scene, t0, t1 - t0, delta_0, EXTENDED)
    by_collocation = reference_collocation.trajectory(scene, t0, t1 - t0, delta_0)
    top_speed = abs(scene.V) + abs(scene.V_rate) * PERIOD + scene.V_1
    scales = (
        scene.F_C / reference.sigma(scene, t1),
        scene.F_C * PERIOD,
        scene.F_C * PERIOD * max(top_speed, 1e-3),
        scene.F_C * PERIOD * max(top_speed, 1e-3),
    )
    for one, other, scale in zip(by_quadrature, by_collocation, scales, strict=True):
        assert abs(multiprecision(one) - other) < 1e-12 * scale


@pytest.mark.parametrize("name", ["soft, all moving", "linear inputs"])
def test_extended_precision_agrees_with_forty_digits(name: str) -> None:
    scene = SCENES[name]
    t1 = MP.mpf(scene.start) + MP.mpf(PERIOD) / 5
    extended = reference.solve(scene, scene.start, t1, 1e-6, EXTENDED)
    multi = reference.solve(scene, scene.start, t1, 1e-6, MULTIPRECISION)
    for one, other in zip(extended, multi, strict=True):
        assert abs(multiprecision(one) - other) < 1e-15 * abs(other)


@pytest.mark.parametrize("kappa", [1e-3, 0.3, 1, 5, 1e3, 1e6])
@pytest.mark.parametrize("zeta", [0.1, 0.5, 0.99])
def test_quadrature_agrees_with_the_closed_form_of_constant_stiffness(kappa: float, zeta: float) -> None:
    V_1, F_C, f = 1.3, 55.0, 20e3
    sigma = float(kappa * 2 * MP.pi * f * F_C / V_1)
    scene = Scene(V=zeta * V_1, V_1=V_1, F_C=F_C, f=f, contact=Contact(model="Constant", sigma=sigma))
    expected = reference_constant.periodic_mean(sigma, F_C, scene.V, V_1, f)
    assert abs(multiprecision(reference.periodic_mean(scene)) - expected) < 1e-13 * F_C


def test_periodic_mean_of_constant_stiffness_has_its_limits() -> None:
    V_1, zeta, F_C, f = 1.0, 0.3, 55.0, 20e3
    stiff = reference_constant.periodic_mean(1e22, F_C, zeta, V_1, f)
    assert float(stiff / F_C) == pytest.approx(float(2 / MP.pi * MP.asin(MP.mpf(zeta))), abs=1e-6)
    soft = reference_constant.periodic_mean(1.0, F_C, zeta, V_1, f)
    mean_speed = MP.quad(
        lambda x: abs(zeta + MP.cos(x)), [0, MP.acos(-zeta), 2 * MP.pi - MP.acos(-zeta), 2 * MP.pi]
    )
    assert float(soft / F_C) == pytest.approx(float(zeta / (mean_speed / (2 * MP.pi))), abs=1e-6)


def test_periods_are_powers_of_one_period() -> None:
    scene = SCENES["soft, all moving"]
    delta, impulse = reference.EXTENDED.real(1e-6), 0
    for k in range(7):
        delta, part, _ = reference.solve(scene, k * scene.period, (k + 1) * scene.period, delta)
        impulse += part
    at_once = reference.solve(scene, 0, 7 * scene.period, 1e-6)
    assert abs(at_once[0] - delta) < 1e-15 * abs(delta)
    assert abs(at_once[1] - impulse) < 1e-15 * abs(impulse)


def test_work_obeys_the_cycle_identity_where_the_velocity_keeps_its_sign() -> None:
    scene = Scene(V=2.0, V_1=0.7, a_d=1e-6, contact=MEDIUM)
    h = MP.mpf(PERIOD) / 3
    delta, _, work = reference.solve(scene, 0, h, 2e-6)
    omega = 2 * MP.pi * scene.f
    path = scene.V * h + scene.V_1 * MP.sin(omega * h) / omega
    expected = scene.F_C * (path - (multiprecision(delta) - MP.mpf(2e-6)))
    assert abs(multiprecision(work) - expected) < 1e-15 * abs(expected)


def test_coulomb_work_is_the_limit_of_the_dahl_work() -> None:
    stiff = Scene(V=0.3, V_1=1.0, contact=Contact(model="Constant", sigma=1e18))
    coulomb = Scene(V=0.3, V_1=1.0, friction="Coulomb")
    for dahl_value, coulomb_value in zip(
        reference.solve(stiff, 0, 4e-5, 5.5e-17)[1:], reference.solve(coulomb, 0, 4e-5, 0)[1:], strict=True
    ):
        assert abs(multiprecision(dahl_value) - coulomb_value) < 1e-7 * abs(coulomb_value)
