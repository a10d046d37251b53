"""A contact at 2.5 MN/m and 20 kHz that is lifted from 300 N until it is open, and set down again.

kappa = sigma V_1 / (2 pi f mu F_n) runs from 0.5 up to 1e100 on the way if the stiffness stays. Beyond 1e12
the bristle is shorter than rounding can see. The force is Coulomb's, mu F_n(t) s(V) sgn V, with Stribeck's
curve s.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from frictioncontact.fmu import FrictionFmu, Session, Value

LAWS = ("Dahl", "LuGre", "ElasticPlastic")
CONTACTS = ("Asperities", "Constant")
LIMITS = ("Constant", "Load")
START, SIGMA, F, MU, F_C = 300.0, 2.5e6, 20e3, 0.176, 55.0
V, V_1 = 0.5, 1.44
RATIO, V_S = 1.2, 0.2  # of LuGre and ElasticPlastic
H = 20 / F  # s, a step: whole periods
TOLERANCE = 1e-6
STIFF = 1e12  # kappa from which on the force is Coulomb's
NOTHING = 1e-100  # N, of a contact that is open
HEIGHT = 6e-6 / 3.0  # m, R_q / lambda: e times less force for each

# s over a period: V changes its sign at these parts of it.
BACK = math.acos(-V / V_1) / (2 * math.pi)
FORTH = 1.0 - BACK


def start_values(fmu: FrictionFmu, law: str, contact: str, limit: str, by: str) -> dict[str, Value]:
    """With the stiffness of 2.5 MN/m at 300 N."""
    start: dict[str, Value] = {"friction.model": law, "contact.model": contact, "friction.limit": limit}
    start |= {"V": V, "vibration.V_1": V_1, "contact.sigma": SIGMA, "contact.input": "Load", "load": START}
    start |= {"friction.staticRatio": RATIO, "friction.V_S": V_S}
    with fmu.session(start | {"friction.model": "Coulomb"}) as session:
        sigma, F_n = session.read(["sigma", "F_n"])
    assert F_n == pytest.approx(START, rel=1e-12)
    start["contact.stiffnessScale"] = SIGMA / sigma
    return start if by == "load" else start | {"contact.input": "Separation", "d": separation(fmu, START)}


def separation(fmu: FrictionFmu, load: float) -> float:
    """m, F_n = load_0 e^(-d / HEIGHT)."""
    with fmu.session({"friction.model": "Coulomb", "d": 14e-6}) as session:
        return 14e-6 + HEIGHT * math.log(session.get("F_n") / load)


NODE, WEIGHT = np.polynomial.legendre.leggauss(40)


def coulomb(law: str, before: float, after: float, exponential: bool) -> float:
    """The mean of mu F_n s(V) sgn V over H: F_n between both is linear in time, or exponential."""
    periods = round(H * F)
    edges = np.sort([0.0, 1.0, *((k + e) / periods for k in range(periods) for e in (BACK, FORTH))])
    half = 0.5 * np.diff(edges)[:, None]
    t = edges[:-1, None] + half * (1.0 + NODE)
    velocity = V + V_1 * np.cos(2 * np.pi * periods * t)
    curve = 1.0 if law == "Dahl" else 1.0 + (RATIO - 1.0) * np.exp(-((velocity / V_S) ** 2))
    moves = exponential and before != after
    load = before * (after / before) ** t if moves else before + (after - before) * t
    return MU * float(np.sum(half * WEIGHT * load * curve * np.sign(velocity)))


def check(session: Session, constant: bool, limit: str, mean: float, largest: float) -> None:
    """Within the tolerance of Coulomb's force where the bristle cannot be seen, and finite anywhere."""
    F_t, F_t_mean = session.read(["F_t", "F_t_mean"])
    assert math.isfinite(F_t) and math.isfinite(F_t_mean)
    most = max(MU * largest if limit == "Load" else F_C, 0.0) * RATIO * (1 + TOLERANCE)
    if limit == "Load":
        assert abs(F_t) <= most and abs(F_t_mean) <= most
    kappa = SIGMA * V_1 / (2 * math.pi * F * MU * largest) if largest > 0.0 else math.inf
    if constant and limit == "Load" and kappa > STIFF:
        assert F_t_mean == pytest.approx(mean, rel=0, abs=RATIO * TOLERANCE * MU * largest)


@pytest.mark.parametrize("linear", [False, True], ids=["held", "linear"])
@pytest.mark.parametrize("by", ["load", "d"])
@pytest.mark.parametrize("limit", LIMITS)
@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("law", LAWS)
def test_a_lift_off_and_back(
    fmu: FrictionFmu, law: str, contact: str, limit: str, by: str, linear: bool
) -> None:
    """No step is refused, however light the contact is on the way, and none costs more than stiff ones."""
    start = start_values(fmu, law, contact, limit, by)
    d_0 = separation(fmu, 1.0)
    up = [START * 10.0**-decade for decade in range(110)]  # then open
    loads = [*up, -1.0, -1.0, *reversed(up)] if by == "load" else [*up, *reversed(up)]
    with fmu.session(start) as session:
        for now, after in pairwise(loads):
            cost = session.get("solver.evaluations")
            first, last = (load if by == "load" else d_0 - HEIGHT * math.log(load) for load in (now, after))
            session.set(by, first if linear else last)
            if linear:
                session.set_rates(**{by: (last - first) / H})
            session.step(H)
            assert session.get("solver.evaluations") - cost < 2e5
            ends = (max(now, 0.0), max(after, 0.0)) if linear else (max(after, 0.0),) * 2
            mean = coulomb(law, *ends, exponential=by == "d") if max(ends) > NOTHING else 0.0
            opens = max(ends) > NOTHING >= min(ends)  # within the step, which no closed form here has
            check(session, contact == "Constant" and not opens, limit, mean, max(ends))
        session.step(H)
        assert session.get("F_n") == pytest.approx(START, rel=1e-9)
        expected = dict(start) | {"initialState": "Settled", "solver.tolerance": 1e-8}
        with fmu.session(expected) as settled:
            settled.step(H)
            if limit == "Load" or contact == "Constant":
                assert session.get("F_t_mean") == pytest.approx(settled.get("F_t_mean"), abs=1e-3 * F_C)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("d", [150e-6, 200e-6, 352.2e-6])
def test_one_step_of_a_contact_that_nearly_is_open(fmu: FrictionFmu, law: str, d: float) -> None:
    """(2/pi) asin(V/V_1) of the limit, which is 0.225750."""
    start = start_values(fmu, law, "Constant", "Load", "d") | {"friction.staticRatio": 1.0, "d": d}
    with fmu.session(start) as session:
        session.step(1e-3)
        assert session.get("F_t_mean") / (MU * session.get("F_n")) == pytest.approx(
            2 / math.pi * math.asin(V / V_1), abs=2e-6
        )
        assert session.get("F_t_settled") / (MU * session.get("F_n")) == pytest.approx(0.225750, abs=2e-6)
        assert session.get("solver.evaluations") < 1e4


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("contact", CONTACTS)
def test_a_load_that_decays_through_a_lag(fmu: FrictionFmu, law: str, contact: str) -> None:
    """300 N e^(-t / 10 ms), held and in linear steps of 1 ms, through 1e-100 N after 2.4 s."""
    for linear in (False, True):
        with fmu.session(start_values(fmu, law, contact, "Load", "load")) as session:
            for k in range(2500):
                now, after = (START * math.exp(-(k + n) / 10) for n in (0, 1))
                session.set("load", now)
                if linear:
                    session.set_rates(load=(after - now) / H)
                session.step(H)
            assert session.read(["F_t", "F_n", "delta"]).tolist() == [0.0, 0.0, 0.0]
