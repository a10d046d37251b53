"""Steps of hours to decades: their end has the phase of t + h, and a time that tells no phase is refused."""

from __future__ import annotations

import pytest
from mpmath import mp, mpf

from frictioncontact.fmu import FrictionError, FrictionFmu

F = 20e3  # Hz
LARGEST = 2.0**46 / F  # s, 3.5e9
HOURS_TO_DECADES = [1e3, 1e7, 3e9]

# Table 1, soft; the separation at a phase in (0, 2 pi).
V, V_1, D, A_D, PHASE_D, SCALE = 0.5, 1.44, 14e-6, 1.1e-6, 0.3, 4.4e-7
START = {"V": V, "vibration.V_1": V_1, "vibration.a_d": A_D, "vibration.phase_d": PHASE_D}
START |= {"contact.stiffnessScale": SCALE, "solver.tolerance": 1e-11}


def angle(t: float, h: float) -> mpf:
    """2 pi f (t + h) modulo 2 pi, of the doubles as they are."""
    with mp.workdps(60):
        cycles = mpf(F) * (mpf(t) + mpf(h))
        return +(2 * mp.pi * (cycles - mp.floor(cycles)))


def stiffness_ratio(theta: mpf) -> mpf:
    """sigma(d) / sigma(d_0), d_0 = 14 um, Eq. 3 and 20: (d_0 / d)^3 exp(-2 lambda (d - d_0) / R_q)."""
    d = mpf(D) + mpf(A_D) * mp.cos(theta + mpf(PHASE_D))
    return (mpf(D) / d) ** 3 * mp.exp(-2 * mpf(3) * (d - mpf(D)) / mpf(6e-6))


@pytest.mark.parametrize("t", [0.0, 1.7e5])
@pytest.mark.parametrize("h", HOURS_TO_DECADES)
def test_stiffness_at_the_end_has_the_phase_of_the_end(fmu: FrictionFmu, t: float, h: float) -> None:
    h += 1.3e-5
    with fmu.session({"contact.stiffnessScale": SCALE}) as session:
        sigma_0 = session.get("sigma")
    with fmu.session(START, start=t) as session:
        session.step(h)
        F_t, sigma, delta = session.read(("F_t", "sigma", "delta"))
        assert sigma == pytest.approx(sigma_0 * float(stiffness_ratio(angle(t, h))), rel=1e-13)
        assert F_t == pytest.approx(sigma * delta, rel=1e-15)
        session.set("V", V)
        again = session.read(("F_t", "sigma"))
    assert (F_t, sigma) == tuple(again)


@pytest.mark.parametrize("law", ["Dahl", "ElasticPlastic", "LuGre"])
def test_a_run_that_starts_whole_periods_later_gives_the_same_bits(fmu: FrictionFmu, law: str) -> None:
    """Local time keeps even a late step exact. f is a power of two, h of 2^-36 s: nothing is rounded."""
    start = START | {"vibration.f": 16384.0, "friction.model": law}
    start |= {"friction.staticRatio": 1.2, "delta_0": 1e-8}
    for h in (2.0**-20, 1234567 * 2.0**-36, 0.0625):
        runs = []
        for periods in (0, 1, 12345, 2**30):
            with fmu.session(start, periods / 16384.0) as session:
                session.set_rates(V=0.1 / h)
                session.step(h)
                session.step(h)
                runs.append(session.read(("F_t", "F_t_mean", "W_f", "Q_f", "delta")).tolist())
        assert runs.count(runs[0]) == len(runs)


LAWS = [
    {"friction.model": "Coulomb"},
    {"friction.model": "Dahl", "solver.method": "cvode"},
    {"friction.model": "Dahl", "solver.method": "backwardEuler", "solver.stepSize": 1e300},
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: "-".join(str(value) for value in law.values()))
@pytest.mark.parametrize("h", [LARGEST * (1 + 1e-9), 9.1e11, 1e100, 1.7e308])
def test_a_time_that_tells_no_phase_is_refused(
    fmu: FrictionFmu, h: float, law: dict[str, str | float]
) -> None:
    with fmu.session({"V": 0.1, "vibration.V_1": 0.4, **law}) as session:
        before = session.read(("F_t", "delta", "W_f"))
        with pytest.raises(
            FrictionError, match=r"time = .* too large for vibration\.f = 20000 Hz: beyond 3\.51843721e\+09 s"
        ):
            session.step(h)
        assert tuple(session.read(("F_t", "delta", "W_f"))) == tuple(before)
        session.step(1e-5)


def test_a_start_that_tells_no_phase_is_refused(fmu: FrictionFmu) -> None:
    with pytest.raises(FrictionError, match="too large"), fmu.session({"vibration.V_1": 0.4}, start=-1e10):
        pass
    with fmu.session({"V": 0.1}, start=1e10) as session:
        session.step(1e5)
        session.set("vibration.V_1", 0.4)
        with pytest.raises(FrictionError, match="too large"):
            session.get("F_t")
        session.set("vibration.f", 1e3)
        session.step(1e5)


def test_a_step_below_the_normal_numbers_is_refused(fmu: FrictionFmu) -> None:
    with fmu.session({"V": 0.005}) as session:
        with pytest.raises(FrictionError, match=r"at least 2\.22507386e-308 s"):
            session.step(5e-324)
        session.step(2.3e-308)
        session.step(0.0)
