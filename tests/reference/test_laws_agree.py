"""Every law by two references of different kind: quadrature and collocation, event search and bisection.

The scenes are those of the data files: every limit, contact and input, kappa from 1e-3 to 1e8, any start.
"""

from __future__ import annotations

from dataclasses import replace

import pytest
from data.make_laws import SEEDS, Draw, random_scene, random_steps, resting_limit

from workshop.reference import collocation, stop_bisection
from workshop.reference import solution as reference
from workshop.reference.arithmetic import EXTENDED, multiprecision
from workshop.reference.coulomb import mean_limit, path
from workshop.reference.quadrature import interval_map
from workshop.reference.settled import settled
from workshop.reference.solution import MP, Scene


def first_step(law: str, number: int) -> tuple[Scene, float, float]:
    draw = Draw([SEEDS[law], number])
    scene, h = random_steps(random_scene(law, draw), draw)[0]
    bound = resting_limit(scene)[0] / float(reference.sigma(scene, scene.start))
    return scene, h, draw.uniform(-1.5, 1.5) * bound


def deviations(scene: Scene, h: float, one: tuple, other: tuple) -> dict[str, float]:
    """Of F_t, F_t_mean, W and Q, over the limit and the limit times path."""
    end = MP.mpf(scene.start) + MP.mpf(h)
    limit, way = float(mean_limit(scene, scene.start, h)), float(path(scene, scene.start, h))
    forces = [reference.force(scene, end, values[0]) for values in (one, other)]
    pairs = {"F_t": (*forces, limit)}
    for name, k, scale in (("F_t_mean", 1, limit * h), ("W_f", 2, limit * way), ("Q_f", 3, limit * way)):
        pairs[name] = (one[k], other[k], scale)
    return {
        name: abs(float(multiprecision(a) - multiprecision(b))) / max(scale, 1e-300)
        for name, (a, b, scale) in pairs.items()
    }


def short(law: str, count: int, longest: float) -> list[int]:
    """The first scenes whose first step takes at most so many periods."""
    found = []
    for number in range(500):
        scene, h, _ = first_step(law, number)
        if h * scene.f <= longest and (path(scene, scene.start, h) > 0 or law == "ElasticPlastic"):
            found.append(number)
        if len(found) == count:
            break
    return found


@pytest.mark.parametrize("law", ["Dahl", "LuGre"])
def test_quadrature_and_collocation(law: str) -> None:
    """Without the bound."""
    for number in short(law, 3, 0.03):
        scene, h, delta_0 = first_step(law, number)
        one = interval_map(scene, scene.start, MP.mpf(h), EXTENDED).apply(EXTENDED.real(delta_0))
        other = collocation.trajectory(scene, scene.start, h, delta_0)
        found = deviations(scene, h, one, other)
        assert max(found.values()) < 1e-12, (number, found)


def test_event_search_and_bisection() -> None:
    for number in short("ElasticPlastic", 12, 2.0):
        scene, h, delta_0 = first_step("ElasticPlastic", number)
        if path(scene, scene.start, h) == 0:
            continue
        one = reference.advance(scene, scene.start, h, delta_0)
        other = stop_bisection.advance(scene, scene.start, h, delta_0)
        found = deviations(scene, h, one, other)
        assert max(found.values()) < 1e-12, (number, found)


def test_coulomb_is_stiff_dahl_under_every_limit() -> None:
    for limit in ("Constant", "Load"):
        scene = Scene(V=0.3, V_1=1.0, a_d=1e-6, phase_d=2.0, limit=limit, sigma_2=7.0)
        scene = replace(scene, contact=replace(scene.contact, stiffnessScale=1e6))
        h = float(scene.period) * 1.3
        one = reference.advance(replace(scene, friction="Coulomb"), 0, h, 0)
        other = reference.advance(scene, 0, h, settled(scene, 0, 0))
        found = deviations(scene, h, one, other)
        assert found["F_t_mean"] < 1e-6 and found["W_f"] < 1e-8 and found["Q_f"] < 1e-8, found


def test_lugre_without_static_excess_is_dahl() -> None:
    for number in range(3):
        scene, h, delta_0 = first_step("Dahl", number)
        dahl = reference.advance(scene, scene.start, h, delta_0)
        assert reference.advance(replace(scene, friction="LuGre"), scene.start, h, delta_0) == dahl


@pytest.mark.parametrize("law", ["Dahl", "LuGre", "ElasticPlastic"])
def test_settled_is_where_many_periods_lead(law: str) -> None:
    for number in range(15):
        scene, _, delta_0 = first_step(law, number)
        scene = replace(scene, V_rate=0.0, d_rate=0.0, E_rate=0.0, load_rate=0.0)
        if not scene.vibrates:
            continue
        delta = settled(scene, scene.start, delta_0)
        scale = resting_limit(scene)[0] / float(reference.sigma(scene, scene.start))
        again = reference.advance(scene, scene.start, scene.period, delta).delta
        assert abs(again - delta) < 1e-15 * scale * (1 + abs(delta) / scale), number
        if law == "ElasticPlastic" and abs(scene.V) * 30 > scale * scene.f:
            late = reference.advance(scene, scene.start, 40 * scene.period, delta_0).delta
            assert abs(late - delta) < 1e-11 * scale, number


def test_the_heat_of_a_start_beyond_the_bound_is_the_energy_given_up() -> None:
    scene = Scene(V=0.0, V_rate=0.0, friction="ElasticPlastic")
    sigma = float(reference.sigma(scene, 0))
    bound = scene.F_C / sigma
    delta, impulse, work, heat = reference.advance(scene, 0, 1e-5, -3 * bound)
    assert float(delta) == pytest.approx(-bound, rel=1e-15)
    assert float(heat) == pytest.approx(sigma * (9 - 1) * bound**2 / 2, rel=1e-14)
    assert float(work) == 0.0
    assert float(impulse) == pytest.approx(-scene.F_C * 1e-5, rel=1e-14)
