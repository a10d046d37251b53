"""Velocity and vibration across the sliding: by closed forms, quadrature, scipy's solver and symmetries."""

from __future__ import annotations

import math

import numpy as np
import pytest
from data.plane_means import MEANS, ZETA, coulomb_across, coulomb_around, soft_dahl
from scipy.integrate import quad, solve_ivp

from frictioncontact.fmu import FrictionFmu, Session, Value

F, F_C, V_2 = 20e3, 55.0, 0.8
OMEGA = 2 * math.pi * F
LAWS = ("Dahl", "Coulomb", "ElasticPlastic", "LuGre")
LAWS_WITH_A_STATE = ("Dahl", "ElasticPlastic", "LuGre")
FINE: dict[str, Value] = {"solver.tolerance": 1e-8, "contact.model": "Constant", "F_C": F_C, "vibration.f": F}
CIRCLE: dict[str, Value] = {"vibration.V_1": V_2, "vibration.V_2": V_2, "vibration.phase_2": math.pi / 2}
OBLIQUE: dict[str, Value] = {
    "V": 0.21,
    "V_y": -0.34,
    "vibration.V_1": 0.6,
    "vibration.V_2": 0.9,
    "vibration.phase_2": 1.1,
}


def across(law: str, kappa: float, zeta: float) -> dict[str, Value]:
    """kappa = sigma V_2 / (2 pi f F_C), zeta = V / V_2."""
    moves = {"V": zeta * V_2, "vibration.V_1": 0.0, "vibration.V_2": V_2}
    return FINE | moves | {"friction.model": law, "contact.sigma": kappa * OMEGA * F_C / V_2}


def settled(fmu: FrictionFmu, values: dict[str, Value]) -> tuple[float, float]:
    """F_t_settled and F_y_settled over F_C."""
    with fmu.session(values) as session:
        return session.get("F_t_settled") / F_C, session.get("F_y_settled") / F_C


def means(session: Session) -> list[float]:
    return [session.get("F_t_mean") / F_C, session.get("F_y_mean") / F_C]


# Means of a vibration, by formulas


@pytest.mark.parametrize("zeta", ZETA)
@pytest.mark.parametrize("circular", [False, True])
def test_coulomb_by_elliptic_integrals(fmu: FrictionFmu, zeta: float, circular: bool) -> None:
    values = across("Coulomb", 1.0, zeta) | (CIRCLE if circular else {}) | {"solver.tolerance": 1e-12}
    truth = [(coulomb_around if circular else coulomb_across)(zeta), 0.0]
    assert settled(fmu, values) == pytest.approx(truth, abs=1e-12)
    with fmu.session(values) as session:
        for periods in (1, 1000):
            session.step(periods / F)
            assert means(session) == pytest.approx(truth, abs=2e-12)


def test_coulomb_around_an_oblique_ellipse(fmu: FrictionFmu) -> None:
    def velocity(angle: float) -> complex:
        along = OBLIQUE["V"] + OBLIQUE["vibration.V_1"] * math.cos(angle)
        return complex(along, OBLIQUE["V_y"] + OBLIQUE["vibration.V_2"] * math.cos(angle + 1.1))

    truth = [
        quad(lambda angle: (velocity(angle) / abs(velocity(angle))).real, 0, 2 * math.pi, epsabs=1e-12)[0],
        quad(lambda angle: (velocity(angle) / abs(velocity(angle))).imag, 0, 2 * math.pi, epsabs=1e-12)[0],
    ]
    found = settled(fmu, FINE | OBLIQUE | {"friction.model": "Coulomb"})
    assert found == pytest.approx([part / (2 * math.pi) for part in truth], abs=1e-8)


@pytest.mark.parametrize("zeta", ZETA)
@pytest.mark.parametrize("law", LAWS_WITH_A_STATE)
def test_a_stiff_bristle_is_coulomb(fmu: FrictionFmu, law: str, zeta: float) -> None:
    """To 1 / kappa, less where the velocity turns slowly."""
    for kappa in (1e5, 1e6):
        found = settled(fmu, across(law, kappa, zeta))
        assert found == pytest.approx((coulomb_across(zeta), 0.0), abs=3 / kappa)


@pytest.mark.parametrize("zeta", ZETA)
def test_a_soft_dahl_bristle_averages(fmu: FrictionFmu, zeta: float) -> None:
    assert settled(fmu, across("Dahl", 1e-3, zeta)) == pytest.approx((soft_dahl(zeta), 0.0), abs=1e-6)


@pytest.mark.parametrize("kappa", [0.1, 0.6, 0.95])
def test_what_a_vibration_below_break_away_leaves(fmu: FrictionFmu, kappa: float) -> None:
    """ElasticPlastic, V -> 0: the swing across costs a chord of the disc, a circular one its radius."""
    values = across("ElasticPlastic", kappa, 1e-4)
    assert settled(fmu, values)[0] == pytest.approx(math.sqrt(1 - kappa**2), abs=2e-3)
    assert settled(fmu, values | CIRCLE)[0] == pytest.approx(1 - kappa, abs=2e-3)


def stepped(values: dict[str, Value], periods: int, ratio: float = 1.0, V_S: float = 1.0) -> np.ndarray:
    """F_t_mean, F_y_mean over F_C of each period, from rest: scipy's Radau on Dahl's and LuGre's law."""
    sigma, zero = float(values["contact.sigma"]), 0.0

    def velocity(t: float) -> np.ndarray:
        angle = OMEGA * t
        return np.array(
            [
                float(values.get("V", zero)) + float(values.get("vibration.V_1", zero)) * math.cos(angle),
                float(values.get("V_y", zero))
                + float(values.get("vibration.V_2", zero))
                * math.cos(angle + float(values.get("vibration.phase_2", zero))),
            ]
        )

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        V = velocity(t)
        speed = math.hypot(*V)
        g = F_C * (1 + (ratio - 1) * math.exp(-((speed / V_S) ** 2)))
        return np.concatenate([V - sigma * speed / g * y[:2], sigma * F / F_C * y[:2]])

    y, found = np.zeros(4), []
    for _ in range(periods):
        y = solve_ivp(rate, (0.0, 1 / F), y, method="LSODA", rtol=1e-11, atol=1e-13 * F_C / sigma).y[:, -1]
        found.append(y[2:].copy())
        y[2:] = 0.0
    return np.array(found)


ELLIPSES = [
    across("Dahl", 1.0, 0.1),
    across("Dahl", 1.0, 0.5) | CIRCLE,
    across("Dahl", 3.0, 0.0) | OBLIQUE,
    across("LuGre", 3.0, 0.0) | OBLIQUE | {"friction.staticRatio": 1.5, "friction.V_S": 0.3},
    across("Dahl", 100.0, 0.1),
]


@pytest.mark.parametrize("values", ELLIPSES)
def test_the_first_periods_and_the_settled_one_by_another_solver(
    fmu: FrictionFmu, values: dict[str, Value]
) -> None:
    ratio, V_S = float(values.get("friction.staticRatio", 1.0)), float(values.get("friction.V_S", 1.0))
    truth = stepped(values, 7, ratio, V_S)
    with fmu.session(values) as session:
        for k in range(3):
            session.step(1 / F)
            assert means(session) == pytest.approx(list(truth[k]), abs=3e-8)
    assert settled(fmu, values) == pytest.approx(tuple(truth[-1]), abs=3e-8)


@pytest.mark.parametrize(("law", "kappa", "circular", "truth"), MEANS)
def test_means_to_six_digits(
    fmu: FrictionFmu, law: str, kappa: float, circular: bool, truth: tuple[float, ...]
) -> None:
    for zeta, mean in zip(ZETA, truth, strict=True):
        values = across(law, kappa, zeta) | (CIRCLE if circular else {})
        assert settled(fmu, values)[0] == pytest.approx(mean, abs=6e-7)


@pytest.mark.parametrize("kappa", [0.3, 3.0])
@pytest.mark.parametrize("law", LAWS)
def test_a_million_periods_are_settled(fmu: FrictionFmu, law: str, kappa: float) -> None:
    values = across(law, kappa, 0.0) | OBLIQUE
    with fmu.session(values) as session:
        session.step(3 / F)
        few = session.get("solver.evaluations")
        session.step(1e6 / F)
        assert means(session) == pytest.approx(settled(fmu, values), abs=1e-6)
        # ElasticPlastic forgets its direction in some 30 periods
        assert session.get("solver.evaluations") - few < 15 * few


# One step, by formulas


@pytest.mark.parametrize("angle", [0.3, 1.5, 2.8, 3.1])
def test_a_slip_turns_as_a_towed_wheel(fmu: FrictionFmu, angle: float) -> None:
    """A constant V: the tangent of half the angle between deflection and V falls as e^(-V t / D)."""
    V, sigma = 0.4, 2.5e6
    D = F_C / sigma
    chord = max(0.0, -2 * D * math.cos(angle))  # first it sticks
    start = min(angle, math.pi - angle)
    scene = FINE | {"friction.model": "ElasticPlastic", "V": 0.0, "V_y": V, "contact.sigma": sigma}
    scene |= {"delta_0": D * math.sin(angle), "delta_y_0": D * math.cos(angle)}
    for way in (0.2 * D, 4 * D):
        with fmu.session(scene) as session:
            session.step((chord + way) / V)
            turned = 2 * math.atan(math.tan(start / 2) * math.exp(-way / D))
            assert session.get("F_t") == pytest.approx(F_C * math.sin(turned), abs=1e-8 * F_C)
            assert session.get("F_y") == pytest.approx(F_C * math.cos(turned), abs=1e-8 * F_C)
            # D times the integral of the cotangent; what the bristle stores is the same at both ends
            work = F_C * D * math.log(math.sin(start) / math.sin(turned))
            assert session.get("W_f") == pytest.approx(work, abs=1e-8 * F_C * (chord + way))
            assert session.get("Q_f") == pytest.approx(work, abs=1e-8 * F_C * (chord + way))


@pytest.mark.parametrize("h", [3e-6, 7e-5])
def test_dahl_lags_as_far_as_its_force_acts(fmu: FrictionFmu, h: float) -> None:
    """integral F |V| dt = F_C (integral V dt - change of delta), where |V| is constant: around a circle."""
    with fmu.session(across("Dahl", 0.7, 0.0) | CIRCLE) as session:
        session.step(h)
        angle, radius = OMEGA * h, V_2 / OMEGA
        lags = (
            radius * math.sin(angle) - session.get("delta"),
            radius * (math.cos(angle) - 1) - session.get("delta_y"),
        )
        assert means(session) == pytest.approx([lag / (V_2 * h) for lag in lags], abs=1e-8)


def test_break_away_is_anywhere_on_a_circle(fmu: FrictionFmu) -> None:
    """Loaded across to 40 N, then pushed along: it holds in the disc, then drops along its direction."""
    sigma, ratio, V = 2.5e6, 1.5, 1e-3
    side, D = 40.0 / sigma, F_C / sigma
    reach = math.sqrt((ratio * D) ** 2 - side**2)
    scene = FINE | {"friction.model": "ElasticPlastic", "friction.staticRatio": ratio, "friction.V_S": 1e-6}
    with fmu.session(scene | {"contact.sigma": sigma, "V": V, "delta_y_0": side}) as session:
        session.step((1 - 1e-9) * reach / V)
        assert math.hypot(session.get("F_t"), session.get("F_y")) == pytest.approx(ratio * F_C, rel=1e-8)
        assert session.get("F_y") == pytest.approx(40.0, rel=1e-12) and session.get("Q_f") == 0.0
        session.step(2e-9 * reach / V)
        assert session.get("F_t") == pytest.approx(F_C * reach / (ratio * D), rel=1e-7)
        assert session.get("F_y") == pytest.approx(F_C * side / (ratio * D), rel=1e-7)
        assert session.get("Q_f") == pytest.approx((ratio**2 - 1) * F_C**2 / (2 * sigma), rel=1e-6)


@pytest.mark.parametrize("h", [1e-5, 1e-3])
@pytest.mark.parametrize("initial", ["Given", "Settled"])
def test_held_sliding_relaxes_toward_its_direction(fmu: FrictionFmu, initial: str, h: float) -> None:
    """Dahl without vibration: delta - n D falls as e^(-V t / D) as a vector, n the direction of V."""
    V, sigma = (0.03, -0.04), 2.5e6
    size, D = math.hypot(*V), F_C / sigma
    n = [v / size for v in V]
    begin = [part * D for part in n] if initial == "Settled" else [0.4 * D, 0.7 * D]
    scene = {"contact.model": "Constant", "contact.sigma": sigma, "V": V[0], "V_y": V[1]}
    start = {"initialState": initial, "delta_0": 0.4 * D, "delta_y_0": 0.7 * D}
    with fmu.session(scene | start) as session:
        session.step(h)
        z = size * h / D
        end = [D * a + (b - D * a) * math.exp(-z) for a, b in zip(n, begin, strict=True)]
        mean = [F_C * a + sigma * (b - D * a) * -math.expm1(-z) / z for a, b in zip(n, begin, strict=True)]
        assert session.read(["delta", "delta_y"]).tolist() == pytest.approx(end, rel=1e-12)
        assert session.read(["F_t", "F_y"]).tolist() == pytest.approx([sigma * x for x in end], rel=1e-12)
        assert session.read(["F_t_mean", "F_y_mean"]).tolist() == pytest.approx(mean, rel=1e-12)
        work = F_C * (size * h - sum(a * (x - b) for a, x, b in zip(n, end, begin, strict=True)))
        assert session.get("W_f") == pytest.approx(work, rel=1e-12)
        stored = sigma / 2 * (math.hypot(*end) ** 2 - math.hypot(*begin) ** 2)
        assert session.get("Q_f") == pytest.approx(work - stored, rel=1e-12)
        settled = session.read(["F_t_settled", "F_y_settled"]).tolist()
        assert settled == pytest.approx([F_C * part for part in n], rel=1e-12)


def test_an_open_contact_has_viscous_friction_alone(fmu: FrictionFmu) -> None:
    scene = {"contact.input": "Load", "friction.limit": "Load", "load": 0.0, "V": 0.3, "V_y": -0.7}
    with fmu.session(scene | {"friction.sigma_2": 2.0, "delta_y_0": 1e-9}) as session:
        session.step(1e-4)
        assert (session.get("F_t"), session.get("F_y")) == pytest.approx((0.6, -1.4), rel=1e-14)
        assert session.get("delta_y") == 0.0


# Symmetries, energy, states

NAMES = ("F_t_mean", "F_t", "delta", "W_f", "Q_f")
TURNED = ("F_y_mean", "F_y", "delta_y", "W_f", "Q_f")
MOVES: dict[str, Value] = {
    "vibration.V_1": 0.6,
    "vibration.a_d": 4e-7,
    "vibration.phase_d": 0.8,
    "friction.staticRatio": 1.3,
    "friction.V_S": 0.2,
    "V": 0.2,
    "delta_0": 1e-8,
    "contact.stiffnessScale": 4e-7,
    "friction.sigma_1": 3.0,
    "friction.sigma_2": 5.0,
}


def course(fmu: FrictionFmu, values: dict[str, Value], names: tuple[str, ...], V: str = "V") -> np.ndarray:
    """Outputs after steps with a rate of V, a jump of it, and many periods."""
    with fmu.session(FINE | values) as session:
        rows = []
        for change, h in ((300.0, 1e-4), (-2e3, 1.3e-4), (0.0, 3.3e-3)):
            session.set_rates(**{V: change})
            session.step(h)
            rows.append(session.read(names))
            session.set(V, -0.1)
        return np.array(rows)


@pytest.mark.parametrize("limit", ["Constant", "Load"])
@pytest.mark.parametrize("contact", ["Constant", "Asperities"])
@pytest.mark.parametrize("law", LAWS)
def test_across_alone_is_along_alone(fmu: FrictionFmu, law: str, contact: str, limit: str) -> None:
    chosen = {"friction.model": law, "contact.model": contact, "friction.limit": limit}
    along: dict[str, Value] = MOVES | chosen
    turned = along | {
        "vibration.V_2": along["vibration.V_1"],
        "V_y": along["V"],
        "delta_y_0": along["delta_0"],
    }
    turned |= {"delta_y_0": along["delta_0"], "vibration.V_1": 0.0, "V": 0.0, "delta_0": 0.0}
    one, other = course(fmu, along, NAMES), course(fmu, turned, TURNED, "V_y")
    assert (np.abs(one - other) <= 1e-6 * np.abs(one).max(axis=0)).all()


@pytest.mark.parametrize("law", LAWS)
def test_a_mirror_turns_the_sign_of_what_is_across(fmu: FrictionFmu, law: str) -> None:
    one = MOVES | OBLIQUE | {"friction.model": law, "delta_0": 0.0}
    other = {**one, "V_y": -float(one["V_y"]), "vibration.phase_2": 1.1 + math.pi}
    names = ("F_t_mean", "F_t", "W_f", "Q_f", "F_y_mean", "F_y")
    left, right = course(fmu, one, names), course(fmu, other, names)
    right[:, 4:] *= -1
    assert (np.abs(left - right) <= 1e-7 * np.abs(left).max(axis=0)).all()


@pytest.mark.parametrize("law", LAWS)
def test_hardly_anything_across_is_one_dimension(fmu: FrictionFmu, law: str) -> None:
    """V_2 = 1e-9 V_1: within 1e-8 F_C; nothing across at all: to the bit."""
    values = MOVES | {"friction.model": law, "delta_0": 0.0}
    along = course(fmu, values, ("F_t", "F_t_mean"))
    little = values | {"vibration.V_2": 1e-9 * 0.6, "vibration.phase_2": 1.0}
    assert np.abs(along - course(fmu, little, ("F_t", "F_t_mean"))).max() < 2e-8 * 1.3 * F_C
    nothing = course(fmu, values | {"vibration.phase_2": 1.0}, ("F_t", "F_t_mean"))
    assert (along == nothing).all()


@pytest.mark.parametrize("law", LAWS_WITH_A_STATE)
@pytest.mark.parametrize("periods", [0.37, 1.0, 2.6])
def test_work_is_heat_and_what_is_stored(fmu: FrictionFmu, law: str, periods: float) -> None:
    values = across(law, 2.0, 0.0) | OBLIQUE | {"friction.staticRatio": 1.4, "friction.V_S": 0.5}
    with fmu.session(values) as session:
        for _ in range(4):
            session.step(periods / F)
            squares = session.get("delta") ** 2 + session.get("delta_y") ** 2
            stored = float(values["contact.sigma"]) * squares / 2
            Q_f = session.get("Q_f")
            assert session.get("W_f") - Q_f - stored == pytest.approx(0.0, abs=1e-9 * (Q_f + stored))


@pytest.mark.parametrize("law", LAWS_WITH_A_STATE)
def test_a_saved_state_holds_both_components(fmu: FrictionFmu, law: str) -> None:
    values = FINE | OBLIQUE | {"friction.model": law, "friction.staticRatio": 1.2, "contact.sigma": 1e7}
    names = (*NAMES, *TURNED)
    with fmu.session(values) as session:
        session.step(3.3e-5)
        state, time = session.slave.getFMUState(), session.time
        session.step(2.1e-5)
        first = session.read(names)
        session.slave.setFMUState(state)
        session.time = time
        session.step(2.1e-5)
        assert (session.read(names) == first).all()
        session.slave.freeFMUState(state)
