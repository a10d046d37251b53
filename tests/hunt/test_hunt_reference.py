"""hunt/reference.c against closed forms and against itself, without the FMU."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hunt_library import CHOICES, LAWS_WITH_A_STATE, Scene, after, scene, step


def stiffness_under(load: float, **values: Any) -> float:
    """sigma [N/m] by the force of a bristle that sticks: delta_0 times sigma."""
    probe = scene(law="ElasticPlastic", input="Load", load=load, V=0.0, delta_0=1e-18, h=1e-9, **values)
    return float(step(probe).F_t) / 1e-18


@pytest.mark.parametrize("law", LAWS_WITH_A_STATE)
def test_a_constant_velocity_over_a_constant_stiffness(law: str) -> None:
    V, sigma, F_C, h = 0.02, 2.5e6, 55.0, 2.2e-3
    now = step(scene(law=law, contact="Constant", V=V, h=h, contact_sigma=sigma))
    x = sigma * V * h / F_C
    force = min(1.0, x) if law == "ElasticPlastic" else -math.expm1(-x)
    impulse = x - 0.5 if law == "ElasticPlastic" else x - force
    assert now.F_t == pytest.approx(F_C * force, rel=1e-13)
    assert now.F_t_mean == pytest.approx(F_C * impulse / x, rel=1e-13)
    assert now.work == pytest.approx(now.F_t_mean * V * h, rel=1e-13)
    assert now.work == pytest.approx(now.F_t**2 / (2.0 * sigma) + now.heat, rel=1e-13)


@pytest.mark.parametrize("V", [1e-5, 1e-3, 0.02, 1.0])
def test_break_away_comes_at_the_static_limit_and_drops(V: float) -> None:
    sigma, ratio, F_C, V_S = 2.5e6, 1.5, 55.0, 0.01
    static, kinetic = ratio * F_C, F_C * (1.0 + 0.5 * math.exp(-((V / V_S) ** 2)))
    breaks = static / (sigma * V)
    values = {"law": "ElasticPlastic", "contact": "Constant", "V": V, "staticRatio": ratio, "V_S": V_S}
    just_before = step(scene(**values, h=0.999999 * breaks))
    assert just_before.F_t == pytest.approx(0.999999 * static, rel=1e-13) and just_before.slips == 0
    h = 2.0 * breaks
    now = step(scene(**values, h=h))
    assert now.F_t == pytest.approx(kinetic, rel=1e-13) and now.slips == 1
    assert now.F_t_mean == pytest.approx((0.5 * static + kinetic) / 2.0, rel=1e-12)
    drop = (static**2 - kinetic**2) / (2.0 * sigma)
    assert now.heat == pytest.approx(drop + kinetic * V * breaks, rel=1e-12)
    assert now.work == pytest.approx(kinetic**2 / (2.0 * sigma) + now.heat, rel=1e-12)
    left, stops = after(scene(**values, h=h), now, V=0.0, h=1e-3)
    held = step(stops, left)
    assert held.slips == 0 and held.F_t == pytest.approx(now.F_t, rel=1e-15), "what stands still sticks"


@pytest.mark.parametrize("law", LAWS_WITH_A_STATE)
def test_work_is_what_is_stored_and_heat(law: str) -> None:
    """At a constant stiffness, with vibration, damping and static friction; over several steps."""
    now = scene(law=law, contact="Constant", V=0.3, V_1=1.0, f=2e4, h=3.3e-4, staticRatio=1.4, sigma_1=2.0)
    work = heat = 0.0
    past = None
    for V_rate in (0.0, 500.0, -2000.0):
        now.V_rate = V_rate
        result = step(now, past)
        work, heat = work + result.work, heat + result.heat
        stored = 0.5 * now.contact_sigma * result.delta**2
        assert work == pytest.approx(stored + heat, abs=1e-13 * (abs(work) + heat))
        past, now = after(now, result)


def slid(**values: Any) -> Scene:
    return scene(law="ElasticPlastic", V=0.0, **values)


def test_a_jump_makes_the_heat_of_a_ramp() -> None:
    """The closed forms of docs/physics.md: constant g, constant sigma, and g ~ L with sigma = c L^2."""
    before = slid(contact="Constant")
    before.delta_0 = 55.0 / before.contact_sigma
    now = Scene.from_buffer_copy(before)
    now.contact_sigma *= 3.0
    gone = before.delta_0 * (1.0 - 1.0 / 3.0)
    assert step(now, before).heat == pytest.approx(55.0 * gone, rel=1e-14)

    now = Scene.from_buffer_copy(before)
    now.F_C = 20.0
    heat = (55.0**2 - 20.0**2) / (2.0 * before.contact_sigma)
    assert step(now, before).heat == pytest.approx(heat, rel=1e-14)

    # Mindlin's stiffness goes with the load, and so does a factor on it: sigma = c L^2
    low, high = 10.0, 300.0
    at_low = stiffness_under(low, contact="Mindlin", limit="Load")
    before = slid(contact="Mindlin", limit="Load", input="Load", load=low)
    now = Scene.from_buffer_copy(before)
    now.load, now.stiffnessScale = high, high / low
    before.delta_0 = now.delta_0 = before.mu * low / at_low
    heat = before.mu**2 / (at_low / low**2) * math.log(high / low)
    assert step(now, before).heat == pytest.approx(heat, rel=1e-13)


def test_a_jump_beyond_the_static_bound_breaks_away_on_the_ramp() -> None:
    sigma, ratio = 2.5e6, 1.5
    before = slid(contact="Constant", contact_sigma=sigma, staticRatio=ratio)
    before.delta_0 = 60.0 / sigma  # above F_C, below the static limit
    now = Scene.from_buffer_copy(before)
    now.F_C = 20.0
    # it breaks away where ratio F_C is 60 N; V = 0, so that the kinetic limit is the static one: no drop
    result = step(now, before)
    assert result.heat == pytest.approx((60.0**2 - 30.0**2) / (2.0 * sigma), rel=1e-13)
    assert result.slips == 0 and result.F_t == pytest.approx(30.0, rel=1e-13)
    before.V = now.V = 1.0  # now it is F_C
    now.h = 1e-12
    result = step(now, before)
    drop = (60.0**2 - 40.0**2) / (2.0 * sigma) + (40.0**2 - 20.0**2) / (2.0 * sigma)
    assert result.heat == pytest.approx(drop, rel=1e-6) and result.slips == 1


@pytest.mark.parametrize("law", LAWS_WITH_A_STATE)
def test_held_samples_of_a_load_converge_to_the_ramp(law: str) -> None:
    values = {"law": law, "limit": "Load", "input": "Load", "load": 300.0, "h": 1e-3, "V": 0.01}
    values |= {"staticRatio": 1.3, "stiffnessScale": 1e-6}
    ramp = step(scene(**values, load_rate=-299e3, delta_0=2e-5))
    errors = []
    for count in (50, 200):
        heat = work = 0.0
        past: Scene | None = None
        now = scene(**values, delta_0=2e-5)
        now.h = values["h"] / count
        for k in range(count):
            now.load = 300.0 - 299.0 * (k + 0.5) / count
            result = step(now, past)
            work, heat = work + result.work, heat + result.heat
            past, now = after(now, result)
        errors.append(max(abs(heat / ramp.heat - 1.0), abs(work / ramp.work - 1.0)))
    assert errors[1] < 0.4 * errors[0] < 0.1


def test_a_contact_opens_and_closes_in_a_step() -> None:
    """Constant stiffness, limit = Load: the force is mu load in sliding, and nothing while it is open."""
    values = {"law": "ElasticPlastic", "limit": "Load", "input": "Load", "contact": "Constant", "V": 1.0}
    opens = step(scene(**values, load=100.0, load_rate=-2e5, h=1e-3, sigma_2=0.1, contact_sigma=1e9))
    mean = 0.176 * 100.0 / 4.0  # of a triangle over half of the step
    assert opens.F_t == 0.1 and opens.delta == 0.0
    assert opens.F_t_mean == pytest.approx(mean + 0.1, rel=1e-3)
    assert opens.work == pytest.approx(opens.heat, rel=1e-12), "what was stored is heat"
    closes = step(scene(**values, load=-100.0, load_rate=2e5, h=1e-3, sigma_2=0.1, contact_sigma=1e9))
    assert closes.F_t_start == 0.1
    assert closes.F_t == pytest.approx(17.7, rel=1e-9)
    assert closes.F_t_mean == pytest.approx(mean + 0.1, rel=1e-3)


@pytest.mark.parametrize("law", LAWS_WITH_A_STATE)
@pytest.mark.parametrize("limit", CHOICES["limit"])
def test_many_periods_are_as_many_single_ones(law: str, limit: str) -> None:
    values = {"law": law, "limit": limit, "f": 1e3, "V": 0.02, "V_1": 0.5, "a_d": 3e-7, "staticRatio": 1.3}
    values |= {"V_S": 0.1, "delta_0": 3e-5, "stiffnessScale": 1e-6, "phase_d": 0.7}
    whole = step(scene(**values, h=60.4e-3))
    now, past = scene(**values, h=1e-3), None
    sums = [0.0, 0.0, 0.0]
    for k in range(61):
        now.h = 1e-3 if k < 60 else 0.4e-3
        result = step(now, past)
        parts = (result.F_t_mean * now.h / 60.4e-3, result.work, result.heat)
        sums = [a + b for a, b in zip(sums, parts, strict=True)]
        past, now = after(now, result, start=0.0)
    assert result.F_t == pytest.approx(whole.F_t, rel=1e-10)
    assert sums == pytest.approx([whole.F_t_mean, whole.work, whole.heat], rel=1e-10)


@pytest.mark.parametrize("law", LAWS_WITH_A_STATE)
@pytest.mark.parametrize("limit", CHOICES["limit"])
def test_finer_panels_with_more_stages_say_the_same(law: str, limit: str) -> None:
    values = {"law": law, "limit": limit, "f": 1e3, "V": 0.2, "V_1": 0.5, "a_d": 3e-7, "staticRatio": 1.7}
    values |= {"V_S": 0.01, "delta_0": 3e-7, "stiffnessScale": 1e-3, "h": 2.3e-3, "load_rate": -3e4}
    values |= {"V_rate": -100.0, "d_rate": 1e-4, "sigma_1": 0.5}
    usual, fine = (step(scene(**values), fineness=fineness) for fineness in (1, 2))
    for name in ("F_t", "F_t_mean"):
        assert getattr(usual, name) == pytest.approx(getattr(fine, name), abs=1e-13 * fine.S)
    for name in ("work", "heat"):
        assert getattr(usual, name) == pytest.approx(getattr(fine, name), abs=1e-13 * fine.S * fine.path)
