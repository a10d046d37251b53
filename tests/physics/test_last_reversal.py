"""The end of a step at or just behind a reversal: a stiff bristle knows the way behind it.

Its length is D = staticRatio F_C / sigma, the way behind the reversal X. A bristle that has slid
up to the reversal lies on its bound there, with the force -S, S = staticRatio F_C. With u = X / D,

    Dahl, LuGre       F = S (1 - 2 e^-u)
    ElasticPlastic    F = S min(1, u - 1)
"""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from frictioncontact.fmu import FrictionFmu

TOLERANCE = 1e-6
F_C = 10.0
RELAXING = ("Dahl", "LuGre")
LAWS = (*RELAXING, "ElasticPlastic")
FAR = 1e6  # m/s, V_S: the Stribeck curve is flat

powers = st.floats(-3.0, 1.0)  # of ten: V in m/s, h in s
stiff = st.floats(11.0, 24.0)  # of ten: the path of the step over D
behind = st.just(0.0) | st.floats(-3.0, 4.0)  # of the time in which X grows to D
ratios = st.sampled_from((1.0, 1.5))
sides = st.sampled_from((1.0, -1.0))


def bristle(law: str, ratio: float, D: float) -> dict[str, float | str]:
    """The start values of a bristle of the length D [m]."""
    limit = {"F_C": F_C, "friction.staticRatio": ratio, "friction.V_S": FAR, "friction.model": law}
    return {**limit, "contact.model": "Constant", "contact.sigma": ratio * F_C / D}


def force_behind(law: str, u: mpf) -> mpf:
    """Over S, behind a reversal to V > 0."""
    return 1 - 2 * mp.exp(-u) if law in RELAXING else min(mpf(1), u - 1)


def length(ratio: float, D: float) -> mpf:
    """D [m] of the numbers that the FMU gets."""
    return mpf(ratio) * mpf(F_C) / mpf(ratio * F_C / D)


@pytest.mark.parametrize("law", LAWS)
def test_a_ramp_of_V_that_ends_near_0(fmu: FrictionFmu, law: str) -> None:
    """Also at 0 within rounding. X is that of the numbers that the FMU gets, without rounding."""

    @settings(max_examples=500, deadline=None, database=None)
    @given(powers, powers, stiff, behind, ratios, sides)
    def check(speed: float, time: float, path: float, late: float, ratio: float, side: float) -> None:
        V, h = side * 10.0**speed, 10.0**time
        ratio = 1.0 if law == "Dahl" else ratio
        D = 0.5 * abs(V) * h / 10.0**path
        rate = -V / (h - late * math.sqrt(2.0 * D * h / abs(V)))
        with fmu.session({**bristle(law, ratio, D), "V": V}) as session:
            session.set_rates(V=rate)
            session.step(h)
            found = side * session.get("F_t") / (ratio * F_C)
        with mp.workdps(40):
            after = max(mpf(0), mpf(h) + mpf(V) / mpf(rate))
            truth = -force_behind(law, abs(mpf(rate)) * after**2 / 2 / length(ratio, D))
            assert abs(found - truth) < TOLERANCE

    check()


@pytest.mark.parametrize("law", LAWS)
def test_a_vibration_that_ends_near_a_reversal(fmu: FrictionFmu, law: str) -> None:
    """The phase, and so the time of the reversal, is rounded by some eps of itself."""

    @settings(max_examples=200, deadline=None, database=None)
    @given(st.floats(-0.95, 0.95), powers, st.floats(1.0, 5.0), stiff, behind, ratios)
    def check(zeta: float, speed: float, tone: float, path: float, late: float, ratio: float) -> None:
        V_1, f = 10.0**speed, 10.0**tone
        V = zeta * V_1
        ratio = 1.0 if law == "Dahl" else ratio
        D = V_1 / f / 10.0**path
        time = math.sqrt(D / (math.pi * f * V_1 * math.sqrt(1.0 - zeta**2)))  # in which X grows to D
        with mp.workdps(40):
            omega = 2 * mp.pi * mpf(f)
            turn = mp.acos(-mpf(V) / mpf(V_1)) / omega
            h = float(turn + late * time)
            after = max(mpf(0), h - turn)
            swing = mp.sin(omega * (turn + after)) - mp.sin(omega * turn)
            X = abs(mpf(V) * after + mpf(V_1) / omega * swing)
            truth = force_behind(law, X / length(ratio, D))
        vibration = {"V": V, "vibration.V_1": V_1, "vibration.f": f}
        with fmu.session({**bristle(law, ratio, D), **vibration}) as session:
            session.step(h)
            found = -session.get("F_t") / (ratio * F_C)
        rounding = 16 * 2.0**-52 / (2.0 * math.pi * f * time)
        assert abs(found - truth) < TOLERANCE + rounding

    check()


@pytest.mark.parametrize("law", RELAXING)
def test_a_ramp_in_the_plane_past_a_small_V_y(fmu: FrictionFmu, law: str) -> None:
    """delta = the integral of V e^(-s / D) with the path s to the end; |V| has a closed integral."""

    @settings(max_examples=10, deadline=None, database=None)
    @given(powers, powers, st.floats(16.0, 22.0), st.floats(-3.0, 4.0), st.floats(-2.0, 1.0), sides)
    def check(speed: float, time: float, path: float, late: float, across: float, side: float) -> None:
        V, h = side * 10.0**speed, 10.0**time
        D = 0.5 * abs(V) * h / 10.0**path
        layer = math.sqrt(2.0 * D * h / abs(V))
        rate = -V / (h - late * layer)
        V_y = abs(rate) * layer * 10.0**across
        with fmu.session({**bristle(law, 1.0, D), "V": V, "V_y": V_y}) as session:
            session.set_rates(V=rate)
            session.step(h)
            found = session.read(("F_t", "F_y")) / F_C
        with mp.workdps(30):
            a, D_ = abs(mpf(rate)), length(1.0, D)
            least = mpf(V_y) / a  # the time in which V moves by V_y
            end = mpf(h) + mpf(V) / mpf(rate)

            def path_to(x: mpf) -> mpf:
                return a / 2 * (x * mp.sqrt(x**2 + least**2) + least**2 * mp.asinh(x / least))

            def kept(x: mpf) -> mpf:
                return mp.exp((path_to(x) - path_to(end)) / D_) / D_

            places = mp.linspace(end - 20 * mpf(layer), end, 30)
            along = mp.quad(lambda x: -side * a * x * kept(x), places)
            over = mp.quad(lambda x: mpf(V_y) * kept(x), places)
        assert found == pytest.approx([float(along), float(over)], abs=TOLERANCE)

    check()


def test_coulombs_law_has_no_force_at_the_end_of_a_ramp_to_0(fmu: FrictionFmu) -> None:
    """Rounding would leave the sum of V and its rate on either side of 0; the next step holds that V."""

    @settings(max_examples=500, deadline=None, database=None)
    @given(powers, powers)
    def check(speed: float, time: float) -> None:
        V, h = 10.0**speed, 10.0**time
        with fmu.session({"friction.model": "Coulomb", "F_C": F_C, "V": V}) as session:
            session.set_rates(V=-V / h)
            session.step(h)
            assert session.get("F_t") == 0.0
            session.step(h)
            assert session.get("F_t") == 0.0 and session.get("F_t_mean") == 0.0

    check()
