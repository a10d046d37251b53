"""The reference against closed forms, tiny steps, and numbers that were computed by others."""

from __future__ import annotations

from dataclasses import replace

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
from workshop.reference.course import Course, jump
from workshop.reference.settled import settled
from workshop.reference.solution import MP, Contact, Scene

UM = 1e-6


def cycle(scene: Scene) -> reference.StepResult:
    """One period of the periodic state."""
    return reference.advance(scene, 0, scene.period, settled(scene, 0, 0.0).delta)


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


@pytest.mark.parametrize(
    ("kappa", "zeta", "printed"), [(1.0, 0.1, 0.122328249), (2.0, 0.25, 0.227294259), (5.0, 0.5, 0.379341496)]
)
def test_periodic_means(kappa: float, zeta: float, printed: float) -> None:
    contact = Contact(model="Constant", sigma=kappa * 2 * np.pi * 20e3 * 55.0)
    scene = Scene(V=zeta, V_1=1.0, contact=contact)
    assert float(cycle(scene).impulse) * 20e3 / 55.0 == pytest.approx(printed, abs=1e-9)


SPRING = Contact(model="Constant", sigma=2.5e6)
STATIC = Scene(friction="ElasticPlastic", staticRatio=1.5, V_S=0.01, contact=SPRING)


def in_tiny_steps(scene: Scene, h: float, count: int) -> tuple[float, float, float, float]:
    """ElasticPlastic with static friction from 0, by its rules: deflection, impulse, work, heat."""
    drive = reference.Drive(scene, scene.start, reference.EXTENDED)
    t = np.longdouble(h) * np.arange(count + 1) / count
    V, sigma, static, kinetic = (
        np.asarray(f(t), float) for f in (drive.V, drive.sigma, drive.static_bound, drive.bound)
    )
    dt, delta, slips, sums = h / count, 0.0, 0, np.zeros(3)
    for k in range(count):
        before, mean_V, stiff = delta, (V[k] + V[k + 1]) / 2, (sigma[k] + sigma[k + 1]) / 2
        delta += mean_V * dt
        heat = 0.0
        if slips and slips * mean_V * dt <= kinetic[k + 1] - kinetic[k]:
            slips = 0
        if slips == 0 and abs(delta) > static[k + 1]:
            slips = int(np.sign(delta))
            heat, delta = stiff * (delta**2 - kinetic[k + 1] ** 2) / 2, slips * kinetic[k + 1]
        elif slips and slips * delta > kinetic[k + 1]:
            heat, delta = (
                stiff * (kinetic[k] + kinetic[k + 1]) / 2 * (slips * delta - kinetic[k + 1]),
                slips * kinetic[k + 1],
            )
        force = stiff * (before + delta) / 2
        sums += [force * dt, force * mean_V * dt, heat]
    return (delta, *sums)


@pytest.mark.parametrize("moves", [{}, {"limit": "Load", "a_d": 0.8e-6, "phase_d": 1.0}, {"V_rate": -4e3}])
def test_static_friction_against_tiny_steps(moves: dict[str, object]) -> None:
    scene = replace(STATIC, V=0.5, V_1=2.0, V_S=0.3, **moves)
    h = 3.3 / scene.f
    found = reference.advance(scene, 0, h, 0.0)
    expected = in_tiny_steps(scene, h, 200_000)
    scales = 33e-6, 82.5 * h, 82.5 * 2 * h, 82.5 * 2 * h
    assert found.heat > 0
    for one, other, scale in zip(found, expected, scales, strict=False):
        assert abs(float(one) - other) < 2e-4 * scale


@pytest.mark.parametrize("V", [1e-5, 5e-3, 1.0])
def test_break_away(V: float) -> None:
    """A drop from F_s to F_k; what the spring loses is heat."""
    scene, reach, slid = replace(STATIC, V=V), MP.mpf(82.5) / SPRING.sigma, MP.mpf("1e-6")
    F_k = 55 * (1 + MP.exp(-((MP.mpf(V) / scene.V_S) ** 2)) / 2)
    done = reference.advance(scene, 0, (reach + slid) / MP.mpf(V), 0.0)
    assert float(done.delta * SPRING.sigma / F_k) == pytest.approx(1.0, rel=1e-15)
    assert float(done.work) == pytest.approx(float(82.5 * reach / 2 + F_k * slid), rel=1e-14)
    assert float(done.heat) == pytest.approx(
        float((82.5**2 - F_k**2) / 2 / SPRING.sigma + F_k * slid), rel=1e-14
    )
    assert done.slips == 1


def test_a_jump_is_a_fast_ramp() -> None:
    """d alone moves a bound mu F_n / sigma: integral of g |dD| by the formulas; of many jumps, the same."""
    scene = Scene(d=14e-6, limit="Load", friction="ElasticPlastic", V=0.0)
    far = replace(scene, d=15e-6)

    def limit(d: object) -> object:
        return scene.mu * normal_force(Contact(), d, scene.E)

    D = [limit(d) / stiffness(Contact(), d, scene.E) for d in (14e-6, 15e-6)]
    delta, _, heat = jump(far, scene, 0, D[1])
    middle = (MP.mpf(14e-6) + MP.mpf(15e-6)) / 2

    def slope(d: object) -> object:
        return limit(d) * MP.diff(lambda x: limit(x) / stiffness(Contact(), x, scene.E), d)

    expected = MP.mpf(1e-6) / 6 * (slope(MP.mpf(14e-6)) + 4 * slope(middle) + slope(MP.mpf(15e-6)))
    assert float(delta / D[0]) == pytest.approx(1.0, rel=1e-15)
    assert float(heat) == pytest.approx(float(expected), rel=1e-12)
    now, held, total = far, D[1], 0
    for k in range(1, 11):
        following = replace(scene, d=15e-6 - k * 1e-7)
        held, _, part = jump(now, following, 0, held)
        now, total = following, total + part
    assert float(total) == pytest.approx(float(heat), rel=1e-12)


def test_an_open_contact_keeps_nothing() -> None:
    """A load that falls to 0 and comes back: the stored energy of a constant stiffness is heat."""
    scene = Scene(V=0.0, friction="ElasticPlastic", limit="Load", input="Load", load=100.0, contact=SPRING)
    course = Course(scene, 7e-6)
    opened = course.step(replace(scene, load_rate=-2e5, sigma_2=3.0, V=0.1), 1e-3)
    assert opened.delta == 0 and float(opened.F_t) == pytest.approx(0.3)
    assert float(opened.Q_f - opened.W_f) == pytest.approx(2.5e6 * 49e-12 / 2, rel=1e-12)
    pressed = course.step(replace(scene, load=-50.0, load_rate=1e5, V=0.01), 1e-3)
    assert float(pressed.F_t) == pytest.approx(0.176 * 50.0, rel=1e-12)
