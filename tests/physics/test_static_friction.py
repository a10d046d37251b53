"""ElasticPlastic with static friction: sticking under vibration, stop and go, held samples of a ramp."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from frictioncontact.fmu import FrictionFmu, Value

SIGMA, F_C, RATIO, V_S = 2.5e6, 55.0, 1.5, 0.01
F_S = RATIO * F_C
SPRING: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": SIGMA}
SPRING |= {"friction.model": "ElasticPlastic", "friction.staticRatio": RATIO, "friction.V_S": V_S}


@pytest.mark.parametrize("V_1", [0.02, 4.0])
@pytest.mark.parametrize("h", [1.7e-6, 1000.0])
def test_a_vibration_below_break_away_makes_no_heat_and_no_drift(
    fmu: FrictionFmu, V_1: float, h: float
) -> None:
    """V_1 far above V_S, 160 nm to 32 um of swing at 20 kHz, around 0 and around 77 N less the swing."""
    swing = SIGMA * V_1 / (2 * math.pi * 20e3)
    for force in (0.0, max(0.0, F_S - 1.01 * swing)):
        scene = {**SPRING, "V": 0.0, "vibration.V_1": V_1, "delta_0": force / SIGMA}
        with fmu.session(scene) as session:
            for _ in range(3):
                session.step(h)
            assert session.get("Q_f") == pytest.approx(0.0, abs=1e-11 * F_S * swing / SIGMA)
            phase = math.sin(2 * math.pi * math.fmod(3 * h * 20e3, 1.0))
            assert session.get("F_t") == pytest.approx(force + swing * phase, abs=1e-7 * F_S)
            assert session.get("F_t_settled") == pytest.approx(force, abs=1e-6 * F_S)


@pytest.mark.parametrize("V", [1e-3, 0.5])
def test_stop_and_go_shows_static_friction_again(fmu: FrictionFmu, V: float) -> None:
    with fmu.session({**SPRING, "V": V, "solver.tolerance": 1e-8}) as session:
        session.step(2 * F_S / SIGMA / V)
        F_k = session.get("F_t")
        session.set("V", 0.0)
        session.step(1.0)
        session.set("V", V)
        session.step((1 - 1e-9) * (F_S - F_k) / SIGMA / V)
        assert session.get("F_t") == pytest.approx(F_S, rel=1e-6)
        session.step(2e-8 * F_S / SIGMA / V)
        assert session.get("F_t") == pytest.approx(F_k, rel=1e-6)


@pytest.mark.parametrize(("duration", "peak"), [(1e-5, 100.0), (1e-2, 50.0 * (1 + math.exp(-0.16)))])
def test_held_samples_come_to_the_ramp_that_they_sample(
    fmu: FrictionFmu, duration: float, peak: float
) -> None:
    """V falls from 50 to 20 mm/s. If its bound rises faster than the bristle moves, the bristle sticks."""
    start: dict[str, Value] = {"F_C": 50.0, "contact.sigma": 5e6, "friction.V_S": 0.05}
    with fmu.session({**SPRING, **start, "friction.staticRatio": 2.0, "V": 0.05}) as session:
        session.step(0.1)
        largest = 0.0
        for k in range(1100):
            if k < 100:
                session.set("V", 0.05 - 0.03 * (k + 1) / 100)
            session.step(duration / 100 if k < 100 else 1e-6)
            largest = max(largest, session.get("F_t"))
        assert largest == pytest.approx(peak, abs=0.11)


def test_work_and_heat_of_a_meeting(fmu: FrictionFmu) -> None:
    """Against the integral of F dx: a spring up to its bound, then the limit along V; V grows from 0.

    What a slip along Stribeck's curve keeps is the spring's energy at its end.
    """

    @settings(max_examples=200, deadline=None, database=None)
    @given(st.floats(-15.0, -0.3), st.floats(5.0, 8.0), st.floats(1.05, 2.0), st.floats(-1.0, 1.0))
    def check(room: float, stiffness: float, ratio: float, far: float) -> None:
        sigma, limit, rate, peak = 10.0**stiffness, 10.0, -3.0, 1.0
        D = ratio * limit / sigma
        delta_0 = -(1.0 - 10.0**room) * D
        h = math.sqrt(2.0 * D * (10.0**room + 10.0**far) / -rate)
        start: dict[str, Value] = {"F_C": limit, "contact.sigma": sigma, "friction.V_S": peak, "V": 0.0}
        start |= {"friction.staticRatio": ratio, "delta_0": delta_0}
        with fmu.session({**SPRING, **start}) as session:
            session.set_rates(V=rate)
            session.step(h)
            found = session.read(("W_f", "Q_f"))
        with mp.workdps(40):
            bound = mpf(ratio) * mpf(limit) / mpf(sigma)
            met = -2 * (bound + mpf(delta_0)) * mpf(rate)  # V squared
            end = (mpf(rate) * mpf(h)) ** 2  # as met
            curve = (mpf(ratio) - 1) * mpf(peak) ** 2
            kinetic = limit * (1 + (mpf(ratio) - 1) * mp.exp(-end / mpf(peak) ** 2))
            stuck = mpf(sigma) * (bound**2 - mpf(delta_0) ** 2) / 2
            slid = (
                -limit
                / mpf(rate)
                / 2
                * (end - met + curve * (mp.exp(-met / peak**2) - mp.exp(-end / peak**2)))
            )
            kept = kinetic**2 / mpf(sigma) / 2 - mpf(sigma) * mpf(delta_0) ** 2 / 2
            truth = [float(stuck + slid), float(stuck + slid - kept)]
        scale = ratio * limit * (D + 0.5 * h * h * -rate)
        assert found == pytest.approx(truth, abs=4e-15 * scale)

    check()
