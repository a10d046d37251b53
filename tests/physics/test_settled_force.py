"""F_t_settled, the mean force of a settled period, and its derivatives: against formulas and differences.

The hunt grades it in every sequence (tests/hunt/test_scenes.py).
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from frictioncontact.fmu import FrictionFmu, Session, Value
from workshop.reference import changed, scene_of, step

F_C = 55.0
LAWS = ("Dahl", "Coulomb", "ElasticPlastic", "LuGre")
BY_LOAD = {"friction.limit": "Load", "contact.input": "Load", "load": 200.0}
VIBRATING = {"V": 0.5, "vibration.V_1": 1.44, "vibration.a_d": 1.1e-6, "vibration.phase_d": 3.9}
SOFT = {"contact.stiffnessScale": 4.4e-7}


def drawn(law: str, number: int) -> dict[str, Value]:
    """The start values of a seeded scene that vibrates."""
    rng = np.random.default_rng([LAWS.index(law), number])

    def between(low: float, high: float) -> float:
        return float(low * (high / low) ** rng.random())

    V_1 = between(1e-2, 3.0)
    scene: dict[str, Value] = {
        "friction.model": law,
        "friction.limit": str(rng.choice(["Constant", "Load"])),
        "contact.input": str(rng.choice(["Separation", "Load"])),
        "contact.model": str(rng.choice(["Asperities", "Constant", "Mindlin"])),
        "contact.stiffnessScale": between(1e-8, 1e-1),
        "contact.sigma": between(1e4, 1e12),
        "friction.staticRatio": 1.0 if law == "ElasticPlastic" else 1.0 + between(1e-2, 2.0),
        "friction.V_S": V_1 * between(1e-2, 3.0),
        "friction.sigma_1": between(1e-2, 10.0),
        "friction.sigma_2": between(1e-2, 10.0),
        "vibration.V_1": V_1,
        "vibration.a_d": float(rng.choice([0.0, between(1e-8, 3e-6)])),
        "vibration.phase_d": float(rng.uniform(-4.0, 4.0)),
        "V": V_1 * float(rng.uniform(-2.0, 2.0)),
        "load": between(1.0, 1e3),
        "delta_0": between(1e-10, 1e-6),
    }
    return scene


def scale_of(session: Session, name: str) -> float:
    """How far the input or parameter moves before the force is another one, within its bounds."""
    if name in ("V", "vibration.V_1"):
        return session.get("vibration.V_1")
    if name == "d":
        return session.get("contact.R_q") / session.get("contact.lambda")
    if name == "friction.staticRatio":
        return session.get(name) - 1.0
    return 1.0 if "phase" in name else session.get(name)


def slope_by_differences(session: Session, name: str, step: float, output: str = "F_t_settled") -> float:
    """Central difference of order 6."""
    start, h, total = session.get(name), step * scale_of(session, name), 0.0
    for k, weight in enumerate((3 / 4, -3 / 20, 1 / 60), start=1):
        for side in (1, -1):
            session.set(name, start + side * k * h)
            total += side * weight * session.get(output) / h
    session.set(name, start)
    return total


PARAMETERS = (
    *("F_C", "friction.mu", "friction.staticRatio", "friction.V_S", "friction.sigma_1", "friction.sigma_2"),
    *("contact.sigma", "contact.stiffnessScale"),
    *("vibration.f", "vibration.V_1", "vibration.a_d", "vibration.phase_d"),
)


@pytest.mark.parametrize("axis", ["t", "y"], ids=["line", "plane"])
@pytest.mark.parametrize("law", LAWS)
def test_derivatives_against_differences(fmu: FrictionFmu, law: str, axis: str) -> None:
    """Eight digits where two differences agree: elsewhere they step over a kink."""
    asked, graded, output = 0, 0, f"F_{axis}_settled"
    for number in range(5 if axis == "t" else 2):
        values = drawn(law, number)
        V_1, by_load = float(values["vibration.V_1"]), values["contact.input"] == "Load"
        moves = ("V", "E", "load" if by_load else "d")
        if axis == "y":
            values |= {"V_y": 0.3 * V_1, "vibration.V_2": 0.5 * V_1, "vibration.phase_2": 0.7}
            moves = ("V", "V_y", "vibration.V_2", "vibration.phase_2")
        limit = step(changed(scene_of(values), h=1e-4, delta_0=0.0)).S
        with fmu.session(values | {"solver.tolerance": 1e-12}) as session:
            for name in (*moves, *PARAMETERS):
                if not scale_of(session, name) > 0.0:
                    continue  # at its bound
                coarse, fine = (slope_by_differences(session, name, h, output) for h in (4e-3, 1e-3))
                unit = abs(fine) + limit / scale_of(session, name)
                asked += 1
                if abs(fine - coarse) < 1e-8 * unit:
                    graded += 1
                    assert abs(session.slope(output, name) - fine) < 1e-8 * unit, (number, name, values)
            assert session.slope("F_t_settled", "d" if by_load else "load") == 0.0
    assert graded > 0.8 * asked > 20


@pytest.mark.parametrize("zeta", [-1.0, 1.0])
@pytest.mark.parametrize("V_1", [0.8, 1e-300])
def test_coulomb_where_V_only_touches_zero(fmu: FrictionFmu, zeta: float, V_1: float) -> None:
    with fmu.session({"friction.model": "Coulomb", "V": zeta * V_1, "vibration.V_1": V_1}) as session:
        assert session.get("F_t_settled") == pytest.approx(zeta * F_C, rel=1e-12)


@pytest.mark.parametrize("V", [1e-300, -3e-3, 1e15])
@pytest.mark.parametrize("law", LAWS)
def test_without_vibration_it_is_steady_sliding(fmu: FrictionFmu, law: str, V: float) -> None:
    has_curve, excess, V_S = law in ("LuGre", "ElasticPlastic"), 0.4, 0.01
    values = {
        "friction.model": law,
        "friction.staticRatio": 1.0 + excess,
        "friction.V_S": V_S,
        "friction.sigma_1": 30.0,
        "friction.sigma_2": 2.0,
        "V": V,
    }
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


def test_it_is_the_same_at_every_time_and_after_every_past(fmu: FrictionFmu) -> None:
    with fmu.session(VIBRATING | SOFT) as session:
        first = session.get("F_t_settled")
        for V in (0.9, -0.2, 0.5):
            session.set("V", V)
            session.set_rates(V=300.0, d=1e-3)
            session.step(1.7e-4)
            assert session.get("F_t_settled") != first
        session.set("V", 0.5)
        session.set("d", 14e-6)
        assert session.get("F_t_settled") == first


def test_a_cycle_in_the_plane_that_forgets_its_start_slowly(fmu: FrictionFmu) -> None:
    """A bristle that sticks and slips in turn forgets 0.8 % of its direction in a period: 1e-10 remains."""
    values: dict[str, Value] = {
        "friction.model": "ElasticPlastic",
        "friction.staticRatio": 1.065,
        "friction.V_S": 0.43,
        "contact.model": "Constant",
        "contact.sigma": 321.0,
        "vibration.f": 1.0,
        "vibration.V_1": 0.327,
        "vibration.V_2": 0.114,
        "vibration.phase_2": 1.9,
        "V": -0.0007,
        "V_y": -0.00105,
    }
    with fmu.session(values) as session:
        session.step(3000.0)
        session.step(2.0)
        for axis in "ty":
            settled = session.get(f"F_{axis}_settled")
            assert settled == pytest.approx(session.get(f"F_{axis}_mean"), abs=2e-6 * 1.065 * F_C)


def resolved(mass: float, pull: float, sigma: float, V_1: float, f: float, periods: int) -> np.ndarray:
    """V [m/s] of a mass that a force pulls over Dahl's bristle, vibration and all, after each period: RK4."""
    h, V, delta, after = 1 / f / 100, 0.0, 0.0, []

    def rate(t: float, V: float, delta: float) -> tuple[float, float]:
        total = V + V_1 * math.cos(2 * math.pi * f * t)
        return (pull - sigma * delta) / mass, total - sigma * abs(total) * delta / F_C

    for k in range(100 * periods):
        t = k * h
        a_1, b_1 = rate(t, V, delta)
        a_2, b_2 = rate(t + h / 2, V + h / 2 * a_1, delta + h / 2 * b_1)
        a_3, b_3 = rate(t + h / 2, V + h / 2 * a_2, delta + h / 2 * b_2)
        a_4, b_4 = rate(t + h, V + h * a_3, delta + h * b_3)
        V += h / 6 * (a_1 + 2 * a_2 + 2 * a_3 + a_4)
        delta += h / 6 * (b_1 + 2 * b_2 + 2 * b_3 + b_4)
        if k % 100 == 99:
            after.append(V)
    return np.array(after)


@pytest.mark.parametrize(
    ("mass", "sigma", "periods", "least", "most"),
    [(0.1, 2.5e6, 300, 0.01, 2.0), (1.0, 2.5e5, 700, 7.0, 9.0)],
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


def test_a_load_that_does_not_count_has_a_derivative_of_0(fmu: FrictionFmu) -> None:
    with fmu.session(SOFT | VIBRATING | {"load": 0.0}) as session:
        assert session.slope("F_t_settled", "load") == 0.0
