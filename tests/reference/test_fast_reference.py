"""The fast reference in C against the one in Python, closed forms and tiny steps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from data.laws import LAWS, LawScene, is_bounded, law_scenes
from data.make_laws import SEEDS, Draw, random_scene, rates, resting_limit
from reference.fast_reference import advance

from workshop.reference import solution as python
from workshop.reference.arithmetic import EXTENDED, MP
from workshop.reference.solution import Contact, Drive, Scene, sigma

EPSILON = 2.0**-52


def deviations(scene: LawScene) -> dict[str, float]:
    """The largest of all steps over their scales, less the rounding of what is handed over between steps."""
    found: dict[str, float] = {}
    delta, work, heat = scene.delta_0, 0.0, 0.0
    for k, step in enumerate(scene.steps):
        settled = scene.settled is not None and k == 0
        now = replace(step.scene, staticRatio=1.0) if step.scene.friction == "ElasticPlastic" else step.scene
        fast = advance(now, step.h, delta, settled=settled, binds=False)
        delta, work, heat = fast.delta, work + fast.work, heat + fast.heat
        rounding = EPSILON * abs(delta)
        # the reference in Python finds the rate of a soft bristle's bound to so much
        of_rate = 1e-18 * abs(delta) * 2 * np.pi * now.f
        low, high = sorted((fast.F_t, fast.F_t_other))
        errors = {
            "F_t": (min(max(step.F_t, low), high) - step.F_t, of_rate * now.sigma_1, step.limit),
            "F_t_mean": (fast.F_t_mean - step.F_t_mean, rounding * now.sigma_1 / step.h, step.limit),
            "W_f": (work - step.W_f, rounding * step.limit, step.limit_path),
            "Q_f": (heat - step.Q_f, rounding * step.limit, step.limit_path),
            "delta": ((delta - step.delta) * fast.sigma, 0.0, step.limit),
        }
        for name, (error, allowed, scale) in errors.items():
            beyond = max(0.0, abs(error) - allowed)
            found[name] = max(found.get(name, 0.0), beyond / scale if beyond else 0.0)
    return found


@pytest.mark.parametrize("law", [*LAWS, "Settled"])
def test_the_same_as_the_reference_in_python(law: str) -> None:
    """Scenes of one to four steps that no limit bounds."""
    free = [scene for scene in law_scenes(law) if not is_bounded(scene.steps[0].scene)]
    for scene in free[:: 1 if law == "Settled" else 5]:
        found = deviations(scene)
        assert max(found.values()) < 1e-12, (scene.number, found)


def bounded_step(law: str, number: int) -> tuple[Scene, float, float]:
    """A random step of a bounded bristle, ElasticPlastic with static friction, from beyond the bound too."""
    draw = Draw([71, SEEDS[law], number])
    scene = random_scene(law, draw)
    if law == "ElasticPlastic":
        top = max(abs(scene.V), scene.V_1, 1e-3)
        scene = replace(scene, staticRatio=1.0 + draw.log(0.01, 2.0), V_S=top * draw.log(1e-3, 10.0))
    else:
        scene = replace(scene, limit="Load")
    h = draw.time(1e-2 / scene.f, 1.0 / scene.f)
    if draw.chance(0.5):
        scene = replace(scene, **rates(scene, h, draw))
    if scene.limit == "Load" and draw.chance(0.5):  # a load that falls
        fall = draw.log(0.01, 0.9) - 1.0
        scene = replace(scene, input="Load", load_rate=fall * scene.load / h, d_rate=0.0)
    bound = scene.staticRatio * resting_limit(scene)[0] / float(sigma(scene, scene.start))
    return scene, h, draw.uniform(-1.2, 1.2) * bound


@pytest.mark.parametrize("law", ["Dahl", "ElasticPlastic", "LuGre"])
def test_a_bounded_bristle_is_the_same_in_python(law: str) -> None:
    """40 random steps of each law: two references that share the law and no code."""
    slips = 0
    for number in range(40):
        scene, h, delta_0 = bounded_step(law, number)
        one, fast = python.advance(scene, scene.start, h, delta_0), advance(scene, h, delta_0)
        slips += law != "ElasticPlastic" and advance(scene, h, delta_0, binds=False).delta != fast.delta
        force = float(python.force(scene, MP.mpf(scene.start) + MP.mpf(h), one.delta))
        work = fast.limit * (fast.path + abs(fast.delta - fast.delta_start))
        low, high = sorted((fast.F_t, fast.F_t_other))
        mean = float(one.impulse) / h
        assert abs(min(max(force, low), high) - force) <= 1e-12 * max(fast.limit, abs(force)), number
        assert abs(mean - fast.F_t_mean) <= 1e-12 * max(fast.limit, abs(mean)), number
        assert abs(float(one.delta) - fast.delta) * fast.sigma <= 1e-12 * fast.limit, number
        for mine, other in ((one.work, fast.work), (one.heat, fast.heat)):
            assert abs(float(mine) - other) <= 1e-12 * max(work, abs(other)), number
    assert law == "ElasticPlastic" or slips > 8


@pytest.mark.parametrize("law", ["Dahl", "ElasticPlastic", "LuGre"])
def test_more_panels_and_stages_give_the_same(law: str) -> None:
    for scene in law_scenes(law)[::25]:
        first = scene.steps[0]
        one, two = (advance(first.scene, first.h, scene.delta_0, fineness=fineness) for fineness in (1, 2))
        assert abs(one.F_t_mean - two.F_t_mean) < 1e-13 * one.limit, scene.number
        assert abs(one.delta - two.delta) * one.sigma < 1e-13 * one.limit, scene.number


FALLING = Scene(
    V=3e-3,
    friction="Dahl",
    limit="Load",
    input="Load",
    mu=0.2,
    load=100.0,
    contact=Contact(model="Constant", sigma=1e5),
)


@pytest.mark.parametrize("last", [90.0, 50.0, 10.0, 1.0, 1e-3, 1e-6])
def test_a_limit_that_falls_linearly(last: float) -> None:
    """Free: F = sigma / (sigma - b) (g1 - g0 (g1/g0)^(sigma/b)), b = (g0 - g1) / (V h); the bound is g1."""
    h, sigma = 0.01, FALLING.contact.sigma
    scene = replace(FALLING, load_rate=(last - FALLING.load) / h)
    mu, g_0 = MP.mpf(scene.mu), MP.mpf(scene.mu) * FALLING.load
    g_1 = mu * (FALLING.load + MP.mpf(scene.load_rate) * h)
    b = (g_0 - g_1) / (MP.mpf(scene.V) * h)
    free = float(sigma / (sigma - b) * (g_1 - g_0 * (g_1 / g_0) ** (sigma / b)))
    assert advance(scene, h, 0.0, binds=False).F_t == pytest.approx(free, rel=1e-12)
    bounded = advance(scene, h, 0.0)
    assert bounded.F_t == pytest.approx(min(free, float(g_1)), rel=1e-12)
    assert bounded.work == pytest.approx(bounded.heat + sigma * bounded.delta**2 / 2, rel=1e-12)


def in_tiny_steps(scene: Scene, h: float, delta: float, count: int) -> tuple[float, float, float]:
    """Elastic force at the end, its mean and its work: the law over each tiny step, then the clamp."""
    drive = Drive(scene, scene.start, EXTENDED)
    t = np.longdouble(h) * (np.arange(count) + np.longdouble(0.5)) / count
    after = np.longdouble(h) * (np.arange(count) + 1) / count
    V, sigma, coulomb = drive.V(t), drive.sigma(t), drive.coulomb(t)
    excess = scene.staticRatio - 1 if scene.friction != "Dahl" else 0.0
    curve = 1 + excess * np.exp(-((V / scene.V_S) ** 2))
    if scene.friction == "ElasticPlastic":
        decay, move = np.ones(count), V * h / count
        curve_after = 1 + excess * np.exp(-((drive.V(after) / scene.V_S) ** 2))
        bound = drive.coulomb(after) * curve_after / drive.sigma(after)
    else:
        exponent = sigma * abs(V) / (coulomb * curve) * h / count
        decay = np.exp(-exponent)
        move = -np.expm1(-exponent) * np.sign(V) * coulomb * curve / sigma
        bound = drive.coulomb(after) * (1 + excess) / drive.sigma(after)
    deltas = np.empty(count + 1)
    deltas[0] = delta
    for k, (p, q, most) in enumerate(zip(decay.tolist(), move.tolist(), bound.tolist(), strict=True)):
        deltas[k + 1] = min(max(p * deltas[k] + q, -most), most)
    force = sigma * (deltas[1:] + deltas[:-1]) / 2
    return (
        float(drive.sigma(np.longdouble(h)) * deltas[-1]),
        float(force.mean()),
        float((force * V).mean() * h),
    )


@pytest.mark.parametrize("law", ["Dahl", "LuGre", "ElasticPlastic"])
@pytest.mark.parametrize("phase", [0.5, 2.0, 4.0])
def test_the_bound_against_tiny_steps(law: str, phase: float) -> None:
    scene = Scene(
        V=0.4,
        V_1=1.0,
        a_d=1.5e-6,
        phase_d=phase,
        friction=law,
        limit="Load",
        staticRatio=1.6 if law == "ElasticPlastic" else 1.02,
        V_S=0.3,
        contact=Contact(model="Constant", sigma=5e7),
    )
    h = 1.7 / scene.f
    force, mean, work = in_tiny_steps(scene, h, 0.0, 100_000)
    fast = advance(scene, h, 0.0)
    unbound = advance(scene, h, 0.0, binds=False)
    assert law == "ElasticPlastic" or abs(fast.F_t_mean - unbound.F_t_mean) > 1e-3 * fast.limit
    assert fast.F_t == pytest.approx(force, abs=1e-6 * fast.limit)
    assert fast.F_t_mean == pytest.approx(mean, abs=1e-6 * fast.limit)
    assert fast.work == pytest.approx(work, abs=1e-6 * fast.limit * fast.path)


def test_a_bound_start_beyond_it_gives_its_energy_up() -> None:
    scene = replace(FALLING, V=0.0)
    bound = scene.mu * scene.load / scene.contact.sigma
    fast = advance(scene, 1e-3, 3 * bound)
    assert fast.delta == pytest.approx(bound, rel=1e-14)
    assert fast.heat == pytest.approx(scene.contact.sigma * 8 * bound**2 / 2, rel=1e-13)
