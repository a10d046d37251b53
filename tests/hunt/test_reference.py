"""hunt/reference.c against closed forms, turned and finer scenes, without the FMU."""

from __future__ import annotations

import math
import random
from typing import Any

import pytest
from data.plane_means import MEANS, ZETA, coulomb_across, coulomb_around, soft_dahl
from hunt_library import CHOICES, LAWS_WITH_A_STATE, Scene, scene, settled, step

F, F_C, V_2 = 2e4, 55.0, 0.8
RESULTS = ("F_t", "F_y", "F_t_mean", "F_y_mean", "work", "heat")


def vibrating(law: str, kappa: float, zeta: float, circular: bool = False, **values: Any) -> Scene:
    """Over a constant stiffness: kappa = sigma V_2 / (2 pi f F_C), zeta = V / V_2."""
    sigma = kappa * 2 * math.pi * F * F_C / V_2
    ellipse = {"V_1": V_2, "phase_2": math.pi / 2} if circular else {}
    values = {"contact": "Constant", "contact_sigma": sigma, "V": zeta * V_2, "V_2": V_2, **ellipse, **values}
    return scene(law=law, f=F, F_C=F_C, **values)


def mean(*arguments: Any, **values: Any) -> float:
    """The settled mean of F_t over F_C."""
    return settled(vibrating(*arguments, **values))[0] / F_C


@pytest.mark.parametrize("zeta", ZETA)
def test_coulomb_by_elliptic_integrals(zeta: float) -> None:
    assert mean("Coulomb", 1, zeta) == pytest.approx(coulomb_across(zeta), rel=1e-14)
    assert mean("Coulomb", 1, zeta, circular=True) == pytest.approx(coulomb_around(zeta), rel=1e-13)


@pytest.mark.parametrize("turns", [0.25 - 1e-13, 0.25, 0.25 + 1e-13, 0.3])
@pytest.mark.parametrize(("law", "kappa"), [("Coulomb", 1.0), ("ElasticPlastic", 1e5), ("Dahl", 1e5)])
def test_a_settled_mean_does_not_depend_on_the_phase_of_its_start(
    law: str, kappa: float, turns: float
) -> None:
    """Also where |V| is about the least at the start: at a quarter of a turn."""
    for V, V_y in ((0.0, 0.01 * V_2), (1e-3 * V_2, 0.0)):
        means = [
            settled(vibrating(law, kappa, 0.0, V=V, V_y=V_y, phase_2=2 * math.pi * part))
            for part in (turns, 0.0)
        ]
        assert means[0] == pytest.approx(means[1], abs=1e-12 * F_C)


def test_a_push_of_zero_at_the_start_goes_on_slipping_if_V_rises() -> None:
    """At V = 0 just after break-away; the limit of a ramp. A V that stays 0 sticks."""
    D = F_C / 2.5e6
    values = {"law": "ElasticPlastic", "contact": "Constant", "staticRatio": 1.5, "V": 0.0, "h": 1e-4}
    now = scene(**values, delta_0=1.5 * D, V_rate=10.0, slips=1)
    assert step(now).slips == 1
    now.V_rate = 0.0
    assert step(now).slips == 0


@pytest.mark.parametrize("zeta", ZETA)
def test_a_soft_dahl_bristle_averages(zeta: float) -> None:
    error = [mean("Dahl", kappa, zeta) - soft_dahl(zeta) for kappa in (1e-3, 3e-4)]
    assert abs(error[1]) < 0.1 * abs(error[0]) + 1e-14 and abs(error[0]) < 1e-5


@pytest.mark.parametrize("kappa", [0.1, 0.6, 0.95])
def test_sticking_limits_of_the_elastic_plastic_law(kappa: float) -> None:
    transverse, around = (mean("ElasticPlastic", kappa, 1e-8, circular) for circular in (False, True))
    assert transverse == pytest.approx(math.sqrt(1 - kappa**2), abs=2e-7)
    assert around == pytest.approx(1 - kappa, abs=2e-7)


@pytest.mark.parametrize(("law", "kappa", "circular", "means"), MEANS)
def test_means_to_six_digits(law: str, kappa: float, circular: bool, means: tuple[float, ...]) -> None:
    assert [mean(law, kappa, zeta, circular) for zeta in ZETA] == pytest.approx(means, abs=6e-7)


@pytest.mark.parametrize("angle", [0.3, 1.5, 2.8, 3.1])
def test_a_slip_turns_as_a_towed_wheel(angle: float) -> None:
    """A constant V: the tangent of half the angle between deflection and V falls as e^(-V t / D)."""
    V, D = 0.4, F_C / 2.5e6
    chord = max(0.0, -2 * D * math.cos(angle))  # first it sticks
    for h in ((chord + 0.2 * D) / V, (chord + 4 * D) / V):
        now = scene(law="ElasticPlastic", contact="Constant", V_y=V, V=0.0, h=h)
        now.delta_0, now.delta_y_0 = D * math.sin(angle), D * math.cos(angle)
        start = angle if chord == 0.0 else math.pi - angle
        at_end = 2 * math.atan(math.tan(start / 2) * math.exp(-(V * h - chord) / D))
        end = step(now)
        assert end.delta == pytest.approx(D * math.sin(at_end), abs=1e-13 * D)
        assert end.F_y == pytest.approx(F_C * math.cos(at_end), rel=1e-13)
        assert end.heat == pytest.approx(end.work, rel=1e-13), "the bristle stores as much as at the start"


def test_break_away_drops_along_the_deflection() -> None:
    """Static friction holds in a disc whatever way it is pushed; what the spring loses and slip make heat."""
    V, sigma, ratio = 1e-9, 2.5e6, 1.5
    side, D = 40.0 / sigma, F_C / sigma
    reach = math.sqrt((ratio * D) ** 2 - side**2)
    values = {"law": "ElasticPlastic", "contact": "Constant", "staticRatio": ratio, "V_S": 1e-12, "V": V}
    before = step(scene(**values, delta_y_0=side, h=0.999999 * reach / V))
    assert before.heat == 0.0 and before.slips == 0 and before.F_y == pytest.approx(40.0, rel=1e-14)
    after = step(scene(**values, delta_y_0=side, h=1.000001 * reach / V))
    assert after.slips == 1 and math.hypot(after.F_t, after.F_y) == pytest.approx(F_C, rel=1e-14)
    assert after.F_y / after.F_t == pytest.approx(side / reach, rel=1e-5)
    assert after.heat == pytest.approx((ratio**2 - 1) * F_C**2 / (2 * sigma), rel=1e-5)


@pytest.mark.parametrize("h", [3e-6, 7e-5])
def test_around_a_circle_the_mean_force_is_the_way_that_the_bristle_lags(h: float) -> None:
    """Dahl: integral F |V| dt = F_C (integral V dt - change of delta), and |V| is constant."""
    end = step(vibrating("Dahl", 0.7, 0.0, circular=True, h=h))
    angle = 2 * math.pi * F * h
    way = (V_2 / (2 * math.pi * F) * math.sin(angle), V_2 / (2 * math.pi * F) * (math.cos(angle) - 1))
    assert end.F_t_mean == pytest.approx(F_C * (way[0] - end.delta) / (V_2 * h), rel=1e-13)
    assert end.F_y_mean == pytest.approx(F_C * (way[1] - end.delta_y) / (V_2 * h), rel=1e-13)


def drawn(rng: random.Random, law: str, limit: str) -> Scene:
    """A scene along the sliding."""
    V_1, f = 10 ** rng.uniform(-2, 0), 10 ** rng.uniform(3, 4.5)
    values = {"V": V_1 * rng.uniform(-2, 2), "V_1": V_1, "a_d": rng.choice([0.0, 5e-7]), "f": f}
    values |= {"h": rng.uniform(0.05, 3) / f, "start": rng.random() / f, "phase_d": rng.uniform(-3, 3)}
    now = scene(law=law, limit=limit, contact=rng.choice(CHOICES["contact"]), **values)
    if rng.random() < 0.5:
        now.V_rate, now.d_rate = rng.uniform(-3, 3) * V_1 / now.h, rng.uniform(-1e-6, 1e-6) / now.h
    sigma = 10 ** rng.uniform(-2, 5) * 2 * math.pi * f * F_C / V_1
    now.contact_sigma, now.stiffnessScale = sigma, sigma / {1: 5.7e12, 2: 1.0, 3: 5.3e9}[now.contact]
    now.sigma_1, now.sigma_2 = rng.choice([0.0, 5.0 / V_1]), rng.choice([0.0, 5.0 / V_1])
    if law in ("LuGre", "ElasticPlastic"):
        now.staticRatio, now.V_S = rng.choice([1.0, 1.5]), V_1 * 10 ** rng.uniform(-2, 0.5)
    now.delta_0 = 0.0 if law == "Coulomb" else F_C / sigma * rng.uniform(-1, 1)
    return now


def assert_same(one: Any, two: Any, part: float) -> None:
    for name in RESULTS:
        scale = two.S * (two.path if name in ("work", "heat") else 1.0)
        assert getattr(one, name) == pytest.approx(getattr(two, name), abs=part * scale), name


@pytest.mark.parametrize("law", CHOICES["law"])
@pytest.mark.parametrize("limit", CHOICES["limit"])
def test_one_dimension_in_any_direction(law: str, limit: str) -> None:
    """With exact reversals of V, and the deflection in one line with it."""
    rng = random.Random(3)
    for _ in range(10):
        now = drawn(rng, law, limit)
        truth = step(now)
        turned, angle = Scene.from_buffer_copy(now), rng.uniform(-3, 3)
        x, y = math.cos(angle), math.sin(angle)
        for first, second in (("V", "V_y"), ("V_rate", "V_y_rate"), ("V_1", "V_2"), ("delta_0", "delta_y_0")):
            setattr(turned, first, getattr(now, first) * x)
            setattr(turned, second, getattr(now, first) * y)
        found = step(turned)
        for first, second in (("F_t", "F_y"), ("F_t_mean", "F_y_mean")):
            a, b = getattr(found, first), getattr(found, second)
            setattr(found, first, a * x + b * y)
            setattr(found, second, b * x - a * y)
        found.S = truth.S
        assert_same(found, truth, 1e-10)


@pytest.mark.parametrize("law", LAWS_WITH_A_STATE)
@pytest.mark.parametrize("limit", CHOICES["limit"])
def test_energy_and_a_finer_mesh_over_oblique_ellipses(law: str, limit: str) -> None:
    rng = random.Random(4)
    for _ in range(10):
        now = drawn(rng, law, limit)
        now.V_y, now.V_2, now.phase_2 = (
            now.V_1 * rng.uniform(-1, 1),
            now.V_1 * rng.random(),
            rng.uniform(-3, 3),
        )
        usual = step(now)
        assert_same(usual, step(now, fineness=2), 1e-13)
        if now.contact == 2:
            squares = usual.delta**2 + usual.delta_y**2 - now.delta_0**2
            stored = now.contact_sigma * squares / 2
            assert usual.work - usual.heat == pytest.approx(stored, abs=1e-12 * usual.S * usual.path)
