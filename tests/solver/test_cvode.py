"""solver.method = cvode: here errors are at most tolerance times F_C, those of W_f also times the path."""

from __future__ import annotations

import cmath
import math

import pytest
from model_exchange.exchange_scenes import drawn, error
from solver.test_tolerance import results

from frictioncontact.fmu import FrictionFmu, Value
from tools.reference import changed, scene_of, step

PERIOD, F_C = 1.0 / 20e3, 55.0
CVODE: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": 1e8, "solver.method": "cvode"}


@pytest.mark.parametrize("tolerance", [1e-5, 1e-9, 1e-11])
@pytest.mark.parametrize("scale", [1e-8, 1e-4, 1.0])
def test_error_follows_the_tolerance(fmu: FrictionFmu, scale: float, tolerance: float) -> None:
    start = {"V": 0.5, "vibration.V_1": 1.44, "vibration.a_d": 1.1e-6, "vibration.phase_d": 1.0}
    start |= {"contact.stiffnessScale": scale}
    h = 0.9 * PERIOD
    truth = step(changed(scene_of(start), h=h))
    with fmu.session(start | {"solver.method": "cvode", "solver.tolerance": tolerance}) as session:
        session.step(h)
        for name, size in (("F_t", 1.0), ("F_t_mean", 1.0), ("W_f", truth.path)):
            bound = max(tolerance, 1e-10) * F_C * size
            assert session.get(name) == pytest.approx(getattr(truth, name), abs=bound)


def test_a_vibration_does_not_slip_between_two_steps(fmu: FrictionFmu) -> None:
    """A settled bristle hardly feels a small one, which counts in the work all the same.

    The force depends on the way x alone, F_C (1 - e^(-x / D)), D = F_C / sigma, and so does the work. Each of
    eight steps a period takes one evaluation at least.
    """
    V, V_1, f, periods = 1.0, 1e-3, 20e3, 200.25
    with fmu.session(CVODE | {"V": V, "vibration.V_1": V_1, "solver.tolerance": 1e-6}) as session:
        session.step(periods / f)
        W_f, evaluations = session.read(("W_f", "solver.evaluations"))
    x = V * periods / f + V_1 / (2.0 * math.pi * f)  # the sine is 1
    D = F_C / 1e8
    assert W_f == pytest.approx(F_C * (x + D * math.expm1(-x / D)), rel=1e-6)
    assert evaluations / periods >= 8 and evaluations == round(evaluations)


@pytest.mark.parametrize("V_S", [1e-4, 1e-2])
@pytest.mark.parametrize("V", [0.01, 0.0999999])  # at the latter V only touches zero
def test_no_step_goes_over_a_stribeck_peak(fmu: FrictionFmu, V: float, V_S: float) -> None:
    start = CVODE | {"V": V, "vibration.V_1": 0.1, "vibration.f": 1e3}
    start |= {"friction.model": "LuGre", "friction.staticRatio": 1.5, "friction.V_S": V_S}
    for h in (0.5e-3, 2.3e-3):  # the larger V touches zero at the first
        truth = step(changed(scene_of(start), h=h))
        for tolerance in (1e-3, 1e-6):
            with fmu.session(start | {"solver.tolerance": tolerance}) as session:
                session.step(h)
                for name in ("F_t", "F_t_mean"):
                    assert session.get(name) == pytest.approx(getattr(truth, name), abs=tolerance * F_C)


def test_every_law_and_limit_along_a_line(fmu: FrictionFmu) -> None:
    """ElasticPlastic holds the promise with any method; else errors add up over the step."""
    for number in range(24):
        scene = drawn(number)
        for tolerance in (1e-4, 1e-8):
            found = results(fmu, scene, tolerance, "cvode")
            most = 1 if scene.law == 3 else 5
            assert error(scene, found) < most * tolerance, number


@pytest.mark.parametrize("law", ["Dahl", "LuGre", "ElasticPlastic"])
@pytest.mark.parametrize("speed", [0.4, 3.0])
def test_every_law_on_a_circle(fmu: FrictionFmu, law: str, speed: float) -> None:
    """V turns at the rate omega, and |V| is speed times omega D, with D = F_C / sigma.

    Of Dahl and LuGre delta' = V e^(i omega t) - r delta has a constant r. ElasticPlastic sticks up to D, and
    comes to slip behind V by the angle asin(1 / speed).
    """
    omega, D, tolerance = 2.0 * math.pi / PERIOD, F_C / 1e8, 1e-6
    V, ratio = speed * omega * D, 1.5 if law == "LuGre" else 1.0
    start = CVODE | {"friction.model": law, "friction.staticRatio": ratio, "friction.V_S": V, "V": 0.0}
    start |= {"vibration.V_1": V, "vibration.V_2": V, "vibration.phase_2": -math.pi / 2.0}
    r = V / D / (1.0 + (ratio - 1.0) / math.e)
    with fmu.session(start | {"solver.tolerance": tolerance}) as session:
        for part in (0.02, 7.9):
            session.step(part * PERIOD)
            turn = cmath.exp(1j * omega * session.time)
            delta = V * (turn - math.exp(-r * session.time)) / (1j * omega + r)
            if law == "ElasticPlastic":
                delta = V * (turn - 1.0) / (1j * omega)
                if abs(delta) > D:
                    delta = D * turn * cmath.exp(-1j * math.asin(1.0 / speed))
            found = complex(session.get("F_t"), session.get("F_y"))
            assert abs(found - 1e8 * delta) < tolerance * F_C
