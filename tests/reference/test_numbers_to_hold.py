"""The reference against numbers that were computed by others, and against limits known in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from frictioncontact.parameters import E_FULL
from workshop.reference import solution as reference
from workshop.reference.arithmetic import multiprecision
from workshop.reference.contact import (
    area,
    critical_interference,
    hardness,
    mindlin_stiffness,
    normal_force,
    rest_separation,
    stiffness,
)
from workshop.reference.settled import settled
from workshop.reference.solution import MP, Contact, Scene

UM = 1e-6


def cycle(scene: Scene) -> reference.StepResult:
    """One period of the periodic state."""
    return reference.advance(scene, 0, scene.period, settled(scene, 0, 0.0))


@pytest.mark.parametrize(
    ("d", "printed"), [(12.9, 541.5402078), (14.0, 312.4415202), (15.1, 180.2630758), (17.0, 69.71512644)]
)
def test_normal_force(d: float, printed: float) -> None:
    assert float(normal_force(Contact(), d * UM, E_FULL)) == pytest.approx(printed, rel=1e-9)


@pytest.mark.parametrize(("d", "printed"), [(14.0, 5.273663570e9), (17.0, 1.176713397e9)])
def test_mindlin_stiffness(d: float, printed: float) -> None:
    assert float(mindlin_stiffness(Contact(), d * UM, E_FULL)) == pytest.approx(printed, rel=1e-9)


@pytest.mark.parametrize("Y", [410e6, 20e9])
def test_force_and_stiffness_are_integrals_over_the_heights(Y: float) -> None:
    """Hertz up to omega_c, a(w) = sqrt(R w); fully plastic beyond, a(w) = sqrt(R (2 w - omega_c))."""
    contact, d, E = Contact(Y=Y), 14 * UM, MP.mpf(E_FULL)
    R, R_q, lam, nu = (MP.mpf(v) for v in (contact.R, contact.R_q, contact.lambda_, contact.nu))
    omega_c = critical_interference(contact, E)

    def over_heights(elastic: object, plastic: object) -> object:
        def density(w: object) -> object:
            return MP.mpf(contact.eta) * MP.mpf(contact.A_n) * contact.c * MP.exp(-lam * (d + w) / R_q) / R_q

        scale = R_q / lam
        marks = [omega_c, omega_c + scale, omega_c + 4 * scale, omega_c + 20 * scale, omega_c + 100 * scale]
        below = MP.quad(lambda w: density(w) * elastic(w), [0, omega_c / 64, omega_c / 8, omega_c])
        return below + MP.quad(lambda w: density(w) * plastic(w), marks)

    force = over_heights(
        lambda w: MP.mpf(4) / 3 * E * MP.sqrt(R * w**3),
        lambda w: MP.pi * R * (2 * w - omega_c) * hardness(contact),
    )
    tangential = 2 * (1 - nu) / (2 - nu)
    tension = over_heights(
        lambda w: tangential * 2 * E * MP.sqrt(R * w),
        lambda w: tangential * 2 * E * MP.sqrt(R * (2 * w - omega_c)),
    )
    assert abs(force / normal_force(contact, d, E) - 1) < 1e-13
    assert abs(tension / mindlin_stiffness(contact, d, E) - 1) < 1e-9  # the root at w = 0 is integrated


def test_separation_under_a_load() -> None:
    d = rest_separation(Contact(), 100.0, E_FULL)
    assert float(d) == pytest.approx(16.27849426e-6, rel=1e-9)
    assert float(normal_force(Contact(), d, E_FULL)) == pytest.approx(100.0, rel=1e-15)
    rise = rest_separation(Contact(), 100.0, E_FULL, 1.1 * UM) - d
    assert float(rise) == pytest.approx(0.1484829e-6, rel=1e-6)


def test_means_under_normal_vibration() -> None:
    contact = Contact()

    def mean(quantity: object) -> float:
        angles = [2 * MP.pi * (k + MP.mpf("0.5")) / 200 for k in range(200)]
        values = [quantity(contact, 14 * UM + 1.1 * UM * MP.cos(angle), E_FULL) for angle in angles]
        return float(MP.fsum(values) / 200 / quantity(contact, 14 * UM, E_FULL))

    assert mean(area) == pytest.approx(1.077066856, rel=1e-9)
    assert mean(area) == pytest.approx(float(MP.besseli(0, MP.mpf("0.55"))), rel=1e-14)
    assert mean(stiffness) == pytest.approx(1.506797919, rel=1e-9)


def test_the_drive_has_the_stiffness_and_force_of_the_formulas() -> None:
    for model in ("Asperities", "Mindlin", "Constant"):
        contact = Contact(model=model, stiffnessScale=0.3, Y=5e9)
        scene = Scene(
            d=15e-6, a_d=1e-6, phase_d=0.4, d_rate=0.01, E_rate=1e14, limit="Load", V_1=1.0, contact=contact
        )
        for arithmetic in (reference.EXTENDED, reference.MULTIPRECISION):
            drive = reference.Drive(scene, 1.3e-5, arithmetic)
            now, t = arithmetic.real(0), MP.mpf(1.3e-5)
            d = scene.d + scene.d_rate * t + scene.a_d * MP.cos(2 * MP.pi * scene.f * t + scene.phase_d)
            E = scene.E + scene.E_rate * t
            for got, expected in (
                (drive.sigma(now), stiffness(contact, d, E)),
                (drive.limit(now), scene.mu * normal_force(contact, d, E)),
            ):
                assert abs(multiprecision(got) / expected - 1) < 1e-16


def test_the_load_is_the_mean_of_the_normal_force() -> None:
    scene = Scene(input="Load", load=123.0, a_d=2 * UM, phase_d=1.0, d=1.0)
    drive = reference.Drive(scene, 0.0, reference.EXTENDED)
    times = reference.EXTENDED.array([scene.period * k / 64 for k in range(64)])
    assert float(drive.normal_force(times).mean()) == pytest.approx(123.0, rel=1e-15)


@pytest.mark.parametrize(
    ("kappa", "zeta", "printed"), [(1.0, 0.1, 0.122328249), (2.0, 0.25, 0.227294259), (5.0, 0.5, 0.379341496)]
)
def test_periodic_means(kappa: float, zeta: float, printed: float) -> None:
    contact = Contact(model="Constant", sigma=kappa * 2 * np.pi * 20e3 * 55.0)
    scene = Scene(V=zeta, V_1=1.0, contact=contact)
    assert float(cycle(scene).impulse) * 20e3 / 55.0 == pytest.approx(printed, abs=1e-9)


# V [m/s], the measured force without vibration [N], ElasticPlastic's mean [N]; L. Luo et al., Scientific
# Reports 14:25847 (2024), doi 10.1038/s41598-024-73652-w, Fig. 5b; 26 kHz, 0.35 um.
DRY = [
    (0.05e-3, 3.27, 0.5613),
    (0.1e-3, 3.23, 0.5285),
    (0.2e-3, 3.06, 0.3725),
    (0.5e-3, 2.93, 0.2835),
    (1.0e-3, 2.86, 0.2787),
]


def dry(V: float, F_C: float, **values: object) -> Scene:
    contact = Contact(model="Constant", sigma=7.76e6)
    V_1 = 2 * np.pi * 26e3 * 0.35e-6
    return Scene(V=V, V_1=V_1, f=26e3, F_C=F_C, friction="ElasticPlastic", contact=contact, **values)


@pytest.mark.parametrize(("V", "F_C", "printed"), DRY)
def test_elastic_plastic_means_of_the_dry_contact(V: float, F_C: float, printed: float) -> None:
    assert float(cycle(dry(V, F_C)).impulse) * 26e3 == pytest.approx(printed, abs=1e-4)


def test_elastic_plastic_mean_at_slow_sliding_is_the_limit_less_the_swing() -> None:
    """k a < F_C: as V -> 0 the mean tends to F_C - k a."""
    F_C, swing = 3.27, 7.76e6 * 0.35e-6
    errors = [float(cycle(dry(V, F_C)).impulse) * 26e3 - (F_C - swing) for V in (1e-6, 1e-8, 1e-10)]
    assert abs(errors[2]) < 1e-5
    assert abs(errors[2]) < 0.05 * abs(errors[0])


def test_work_can_fall_while_heat_is_freed() -> None:
    contact = Contact(stiffnessScale=4.41686e-7)
    phase = float(np.deg2rad(345.0))
    scene = Scene(V=0.5, V_1=1.44, a_d=1.1 * UM, phase_d=phase, contact=contact)
    period = cycle(scene)
    assert float(period.work) == pytest.approx(-0.33827e-3, abs=0.5e-8)
    assert float(period.heat) == pytest.approx(1.7857e-3, abs=0.5e-7)


def test_soft_mean_with_moving_stiffness() -> None:
    """Soft, delta hardly moves: F_t_mean = F_C <V> <sigma> / <sigma V>, not F_C, though V > 0 always."""
    contact = Contact(stiffnessScale=1e-11)
    scene = Scene(V=0.013, V_1=0.0091, a_d=0.5 * UM, phase_d=0.0, contact=contact)
    drive = reference.Drive(scene, 0, reference.EXTENDED)
    times = reference.EXTENDED.array([scene.period * k / 256 for k in range(256)])
    sigma, V = drive.sigma(times), drive.V(times)
    expected = float(V.mean() * sigma.mean() / (sigma * V).mean())
    assert expected > 1.2
    assert float(cycle(scene).impulse) * 20e3 / 55.0 == pytest.approx(expected, rel=1e-8)


def test_five_millimetres_a_second_relax_within_nanoseconds() -> None:
    rate = reference.Drive(Scene(V=0.005), 0, reference.EXTENDED).relaxation_rate(reference.EXTENDED.real(0))
    assert float(1 / rate) == pytest.approx(1.915353e-9, rel=1e-6)
