"""F_t_settled, the mean force of a settled period, against formulas and runs that resolve the vibration.

The hunt grades it in every sequence (tests/hunt/test_scenes.py).
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from frictioncontact.fmu import FrictionFmu, Value

F_C = 55.0
LAWS = ("Dahl", "Coulomb", "ElasticPlastic", "LuGre")
BY_LOAD = {"friction.limit": "Load", "contact.input": "Load", "load": 200.0}


@pytest.mark.parametrize("V", [1e-300, -3e-3, 1e15])
@pytest.mark.parametrize("law", LAWS)
def test_without_vibration_it_is_steady_sliding(fmu: FrictionFmu, law: str, V: float) -> None:
    has_curve, excess, V_S = law in ("LuGre", "ElasticPlastic"), 0.4, 0.01
    values = {"friction.model": law, "friction.staticRatio": 1.0 + excess, "friction.V_S": V_S, "V": V}
    values |= {"friction.sigma_1": 30.0, "friction.sigma_2": 2.0}
    curve = excess * math.exp(-((V / V_S) ** 2)) if has_curve else 0.0
    with fmu.session(values) as session:
        steady = math.copysign(F_C * (1 + curve), V) + 2.0 * V
        assert session.get("F_t_settled") == pytest.approx(steady, rel=1e-14)
        by_V = -2 * abs(V) / V_S**2 * F_C * curve + 2.0
        assert session.slope("F_t_settled", "V") == pytest.approx(by_V, abs=1e-8 * F_C / V_S)
        assert session.slope("F_t_settled", "E") == session.slope("F_t_settled", "d") == 0.0
    with fmu.session(values | BY_LOAD) as session:
        steady = math.copysign(0.176 * 200.0 * (1 + curve), V)
        assert session.get("F_t_settled") == pytest.approx(steady + 2.0 * V, rel=1e-12)
        if abs(V) < 1.0:
            assert session.slope("F_t_settled", "load") == pytest.approx(steady / 200.0, rel=1e-9)


def test_where_nothing_moves_it_is_the_force_of_delta_0(fmu: FrictionFmu) -> None:
    for law in LAWS:
        constant = {"friction.model": law, "contact.model": "Constant", "contact.sigma": 1e6, "V": 0.0}
        with fmu.session(constant | {"delta_0": 1e-5}) as session:
            session.step(1e-3)
            assert session.get("F_t_settled") == pytest.approx(0.0 if law == "Coulomb" else 10.0, rel=1e-15)
    with fmu.session(constant | BY_LOAD | {"friction.model": "ElasticPlastic", "delta_0": 1e-2}) as session:
        assert session.get("F_t_settled") == pytest.approx(0.176 * 200.0, rel=1e-12)


def test_a_bristle_that_never_slips_keeps_what_delta_0_says(fmu: FrictionFmu) -> None:
    """ElasticPlastic that swings by sigma a below its limit: around sigma delta_0 at V = 0, else around
    F_C - sigma a + sigma V T / 2, since it slips once a period and is carried on by V T until then."""
    f, sigma, swing = 20e3, 1e6, 1e-5
    values = {
        "friction.model": "ElasticPlastic",
        "contact.model": "Constant",
        "contact.sigma": sigma,
        "vibration.V_1": 2 * math.pi * f * swing,
        "delta_0": 7e-6,
    }
    for V, mean in ((0.0, sigma * 7e-6), (1e-300, F_C - sigma * swing), (-1e-300, sigma * swing - F_C)):
        with fmu.session(values | {"V": V}, start=0.37 / f) as session:
            assert session.get("F_t_settled") == pytest.approx(mean, rel=1e-9)
            assert session.slope("F_t_settled", "V") == pytest.approx(sigma / f / 2, rel=1e-3)


@pytest.mark.parametrize("V", [0.005, 1e-12, 1e-15, 1e-17])
@pytest.mark.parametrize("d", [65e-6, 100e-6, 200e-6])
def test_a_nearly_open_contact_in_the_plane(fmu: FrictionFmu, d: float, V: float) -> None:
    """V carries the bristle to its bound, 1e13 m to 1e74 m away: the swing across is rounding there."""
    values: dict[str, Value] = {"friction.model": "ElasticPlastic", "vibration.V_2": 0.1, "d": d, "V": V}
    with fmu.session(values) as session:
        assert session.get("F_t_settled") == pytest.approx(F_C, rel=2e-13)
        assert session.get("F_y_settled") == pytest.approx(0.0, abs=2e-13 * F_C)


def test_a_cycle_in_the_plane_that_forgets_its_start_slowly(fmu: FrictionFmu) -> None:
    """A bristle that sticks and slips in turn forgets 0.8 % of its direction in a period: 1e-10 remains."""
    values: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": 321.0}
    values |= {"V": -0.0007, "V_y": -0.00105}
    values |= {"friction.model": "ElasticPlastic", "friction.staticRatio": 1.065, "friction.V_S": 0.43}
    values |= {"vibration.f": 1.0, "vibration.V_1": 0.327, "vibration.V_2": 0.114, "vibration.phase_2": 1.9}
    with fmu.session(values) as session:
        session.step(3000.0)
        session.step(2.0)
        for axis in "ty":
            settled = session.get(f"F_{axis}_settled")
            assert settled == pytest.approx(session.get(f"F_{axis}_mean"), abs=2e-6 * 1.065 * F_C)


def resolved(mass: float, pull: float, sigma: float, V_1: float, f: float, periods: int) -> np.ndarray:
    """V [m/s] of a mass that a force pulls over Dahl's bristle, vibration and all, after each period."""

    def rate(t: float, at: tuple[float, float]) -> tuple[float, float]:
        total = at[0] + V_1 * math.cos(2 * math.pi * f * t)
        return (pull - sigma * at[1]) / mass, total - sigma * abs(total) * at[1] / F_C

    times = np.arange(1, periods + 1) / f
    return solve_ivp(rate, (0.0, times[-1]), [0.0, 0.0], t_eval=times, max_step=0.02 / f, rtol=1e-6).y[0]


@pytest.mark.parametrize(
    ("mass", "sigma", "periods", "least", "most"), [(0.1, 2.5e6, 300, 0.01, 2.0), (1.0, 2.5e5, 700, 7.0, 9.0)]
)
def test_a_mass_follows_it_but_for_ripple_and_transient(
    fmu: FrictionFmu, mass: float, sigma: float, periods: int, least: float, most: float
) -> None:
    """In ripples F_C / (2 pi f m): within two for kappa = 0.52, some 0.4 / kappa for kappa = 0.052."""
    pull, V_1, f = 40.0, 1.44, 20e3
    contact = {"contact.model": "Constant", "contact.sigma": sigma, "vibration.V_1": V_1}
    with fmu.session(contact) as session:

        def acceleration(_: float, V: np.ndarray) -> list[float]:
            session.set("V", V[0])
            return [(pull - session.get("F_t_settled")) / mass]

        times = np.arange(1, periods + 1) / f
        mean = solve_ivp(acceleration, (0.0, times[-1]), [0.0], t_eval=times, rtol=1e-8, atol=1e-10).y[0]
    error = np.abs(mean - resolved(mass, pull, sigma, V_1, f, periods)).max()
    ripple = F_C / (2 * math.pi * f * mass)
    assert least * ripple < error < most * ripple
