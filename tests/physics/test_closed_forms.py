"""hunt/reference.c and the FMU against closed forms: both by the FMU's names, each with its own precision.

What has no closed form is then graded against the reference.
"""

from __future__ import annotations

import math
import random
import re
from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import pytest
from mpmath import mp, mpf
from physics.closed_forms import (
    MEANS,
    ZETA,
    Contact,
    coulomb_across,
    coulomb_along,
    coulomb_around,
    soft_across,
    soft_along,
)
from solver.test_tolerance import drawn, turned_back

from frictioncontact.fmu import FrictionFmu, Value
from tools import reference
from tools.project import ROOT
from tools.reference import CHOICES, LAWS_WITH_A_STATE, changed, scene_of

F, F_C, V_2, SIGMA = 2e4, 55.0, 0.8, 2.5e6
OMEGA, D = 2 * math.pi * F, F_C / SIGMA
RESULTS = ("F_t", "F_y", "F_t_mean", "F_y_mean", "W_f", "Q_f", "delta", "delta_y")
CONSTANT: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": SIGMA, "V": 0.0}
STATIC: dict[str, Value] = CONSTANT | {"friction.model": "ElasticPlastic", "friction.staticRatio": 1.5}
CIRCLE: dict[str, Value] = {"vibration.V_1": V_2, "vibration.V_2": V_2, "vibration.phase_2": math.pi / 2}


class Graded:
    """The reference or the FMU."""

    def __init__(self, fmu: FrictionFmu | None) -> None:
        self.fmu, self.error = fmu, 1e-8 if fmu else 1e-13

    def steps(self, values: Mapping[str, Value], *durations: float) -> list[dict[str, float]]:
        """Results after each duration [s]; energies of each step."""
        if self.fmu is None:
            found = reference.follow(changed(scene_of(values), h=h) for h in durations)
            return [{name: getattr(each, name) for name in RESULTS} for each in found]
        rows = []
        with self.fmu.session({"solver.tolerance": 1e-8, **values}) as session:
            before = session.read(("W_f", "Q_f"))
            for h in durations:
                session.step(h)
                rows.append(dict(zip(RESULTS, session.read(RESULTS), strict=True)))
                after = session.read(("W_f", "Q_f"))
                rows[-1] |= dict(zip(("W_f", "Q_f"), after - before, strict=True))
                before = after
        return rows

    def settled(self, values: Mapping[str, Value]) -> tuple[float, float]:
        """Over F_C."""
        if self.fmu is None:
            t, y = reference.settled(scene_of(values))
        else:
            with self.fmu.session({"solver.tolerance": 1e-8, **values}) as session:
                t, y = session.read(("F_t_settled", "F_y_settled"))
        return t / F_C, y / F_C


@pytest.fixture(params=["reference", "fmu"])
def graded(request: pytest.FixtureRequest, fmu: FrictionFmu) -> Graded:
    return Graded(fmu if request.param == "fmu" else None)


def vibrating(law: str, kappa: float, zeta: float, circular: bool = False) -> dict[str, Value]:
    """Over a constant stiffness: kappa = sigma V_2 / (2 pi f F_C), zeta = V / V_2."""
    moves: dict[str, Value] = {"V": zeta * V_2, "vibration.V_2": V_2, "vibration.f": F, "friction.model": law}
    return CONSTANT | moves | {"contact.sigma": kappa * OMEGA * F_C / V_2} | (CIRCLE if circular else {})


def along(law: str, kappa: float, zeta: float) -> dict[str, Value]:
    return vibrating(law, kappa, zeta) | {"vibration.V_1": V_2, "vibration.V_2": 0.0}


# ---- the contact ----

_NAMES = ("R_q", "R", "eta", "A_n", "nu", "Y", "c", "lambda")
TABLE_1 = dict(zip(_NAMES, (6e-6, 1.7e-6, 47e9, 1e-4, 0.33, 410e6, 17.0, 3.0), strict=True))
CONTACTS = [  # x = lambda omega_c / R_q from 1e-4 to 1e2
    TABLE_1,
    TABLE_1 | {"R_q": 1e-7, "R": 1e-3, "eta": 1e11, "Y": 2e9},
    TABLE_1 | {"R_q": 2e-8, "R": 1e-2, "nu": 0.0, "Y": 5e9, "c": 11.0, "lambda": 2.5},
    TABLE_1 | {"nu": 0.5, "A_n": 3e-3},
]


@pytest.mark.parametrize("E", [1e9, 58.556936170e9, 3e11])
@pytest.mark.parametrize("parameters", CONTACTS)
def test_contact(fmu: FrictionFmu, parameters: dict[str, float], E: float) -> None:
    """A_r, F_n and sigma of both models, and the FMU's derivatives of A_r and sigma."""
    d = 2.5 * parameters["R_q"]
    start: dict[str, Value] = {f"contact.{name}": value for name, value in parameters.items()}
    right = Contact(parameters, d, E)
    with mp.workdps(30):
        h_d, h_E = (mpf(x) / 10**8 for x in (d, E))
        ends = [
            [Contact(parameters, mpf(d) + s * h_d, E) for s in (-1, 1)],
            [Contact(parameters, d, mpf(E) + s * h_E) for s in (-1, 1)],
        ]
    for model in ("Asperities", "Mindlin"):
        values = start | {"d": d, "E": E, "contact.model": model, "contact.stiffnessScale": 1e-6}
        sigma = 1e-6 * getattr(right, model.lower())
        assert reference.rest(scene_of(values))[1] == pytest.approx(float(sigma), rel=1e-14)
        by_load = scene_of(values | {"friction.limit": "Load", "friction.mu": 0.3})
        assert reference.rest(by_load)[0] == pytest.approx(float(0.3 * right.F_n), rel=1e-14)
        with fmu.session(values | {"delta_0": 0.0}) as session:
            expected = [float(each) for each in (right.A_r, right.F_n, sigma)]
            assert session.read(("A_r", "F_n", "sigma")).tolist() == pytest.approx(expected, rel=1e-12)
            for name, (low, high), h in zip("dE", ends, (h_d, h_E), strict=True):
                for output, attribute, scale in (("A_r", "A_r", 1), ("sigma", model.lower(), 1e-6)):
                    slope = scale * float((getattr(high, attribute) - getattr(low, attribute)) / (2 * h))
                    size = session.get(output) / (d if name == "d" else E)
                    assert session.slope(output, name) == pytest.approx(slope, rel=1e-9, abs=1e-12 * size)


def test_table_1(fmu: FrictionFmu) -> None:
    """The start values of the FMU, and the numbers of docs/physics.md that follow from them."""
    page = (ROOT / "docs" / "physics.md").read_text(encoding="utf-8")
    full, soft = (
        1 / ((1 - 0.33**2) / (part * 71.3e9) + (1 - 0.29**2) / 200e9) for part in (1.0, 0.7)
    )  # Eq. 4
    assert f"{full / 1e9:.3f} GPa; {soft / 1e9:.3f} GPa" in page
    with fmu.session() as session:
        assert {name: session.get(f"contact.{name}") for name in TABLE_1} == TABLE_1
        assert session.read(("d", "F_C", "vibration.f")).tolist() == [14e-6, F_C, F]
        assert session.get("E") == pytest.approx(full, rel=1e-10)
        at = [Contact(TABLE_1, d, session.get("E")) for d in (14e-6, 17e-6)]
        truth = [float(at[0].A_r), float(at[0].asperities)]
        assert session.read(("A_r", "sigma")).tolist() == pytest.approx(truth, rel=1e-12)
    numbers = [f"{float(x):.4e}" for x in (at[0].A_r, at[0].asperities, at[1].asperities)]
    A_r, stiff, lifted = (re.sub(r"e([-+])0?(\d+)", r"e\1\2", text).replace("e+", "e") for text in numbers)
    assert f"{A_r} m²" in page and f"{stiff} N/m; {lifted} N/m" in page


# ---- means of a vibration ----


@pytest.mark.parametrize("zeta", [-1.0, -0.9, 0.0, 0.999, 1.0])
def test_coulomb_along_is_the_arc_sine(graded: Graded, zeta: float) -> None:
    mean = coulomb_along(zeta) + 3.0 * zeta * V_2 / F_C
    values = along("Coulomb", 1.0, zeta) | {"friction.sigma_2": 3.0}
    error = 1e-9 if abs(zeta) == 1.0 else 1e-12  # a time of the root of rounding, where V only touches 0
    assert graded.settled(values) == pytest.approx((mean, 0.0), abs=error)


@pytest.mark.parametrize("zeta", ZETA)
def test_coulomb_in_the_plane_by_elliptic_integrals(graded: Graded, zeta: float) -> None:
    for circular, formula in ((False, coulomb_across), (True, coulomb_around)):
        values = vibrating("Coulomb", 1.0, zeta, circular)
        assert graded.settled(values) == pytest.approx((formula(zeta), 0.0), abs=max(1e-11, graded.error))
        for found in graded.steps(values, 1 / F, 1000 / F):
            assert found["F_t_mean"] / F_C == pytest.approx(formula(zeta), abs=max(1e-12, graded.error))


@pytest.mark.parametrize("zeta", ZETA[:3])
def test_a_soft_dahl_bristle_averages(graded: Graded, zeta: float) -> None:
    """Errors go with kappa^2; a relaxation that takes 1e12 periods, too."""
    for make, formula in ((vibrating, soft_across), (along, soft_along)):
        error = [graded.settled(make("Dahl", kappa, zeta))[0] - formula(zeta) for kappa in (1e-3, 1e-12)]
        assert abs(error[0]) < 1e-5 and abs(error[1]) < 1e-8


@pytest.mark.parametrize("law", LAWS_WITH_A_STATE)
def test_a_stiff_bristle_is_coulomb(graded: Graded, law: str) -> None:
    for zeta in ZETA:
        found = graded.settled(vibrating(law, 1e5, zeta))
        assert found == pytest.approx((coulomb_across(zeta), 0.0), abs=3e-5)


@pytest.mark.parametrize("kappa", [0.6, 0.95])
def test_what_a_vibration_below_break_away_leaves(graded: Graded, kappa: float) -> None:
    """ElasticPlastic, V -> 0: the swing across costs a chord of the disc, a circular one its radius."""
    for circular, left in ((False, math.sqrt(1 - kappa**2)), (True, 1 - kappa)):
        zeta, error = (1e-4, 2e-3) if graded.fmu else (1e-8, 2e-7)
        found = graded.settled(vibrating("ElasticPlastic", kappa, zeta, circular))
        assert found[0] == pytest.approx(left, abs=error)


@pytest.mark.parametrize(("law", "kappa", "circular", "means"), MEANS)
def test_means_to_six_digits(
    graded: Graded, law: str, kappa: float, circular: bool, means: tuple[float, ...]
) -> None:
    found = [graded.settled(vibrating(law, kappa, zeta, circular))[0] for zeta in ZETA]
    assert found == pytest.approx(means, abs=6e-7)


# ---- steps ----


@pytest.mark.parametrize("angle", [0.3, 2.8])
def test_a_slip_turns_as_a_towed_wheel(graded: Graded, angle: float) -> None:
    """A constant V: the tangent of half the angle between deflection and V falls as e^(-V t / D)."""
    V, chord = 0.4, max(0.0, -2 * D * math.cos(angle))  # first it sticks
    start = min(angle, math.pi - angle)
    values = CONSTANT | {"friction.model": "ElasticPlastic", "V_y": V}
    values |= {"delta_0": D * math.sin(angle), "delta_y_0": D * math.cos(angle)}
    for way in (0.2 * D, 4 * D):
        (found,) = graded.steps(values, (chord + way) / V)
        turned = 2 * math.atan(math.tan(start / 2) * math.exp(-way / D))
        # D times the integral of the cotangent; what the bristle stores is the same at both ends
        work = F_C * D * math.log(math.sin(start) / math.sin(turned))
        for name, truth in (("F_t", F_C * math.sin(turned)), ("F_y", F_C * math.cos(turned))):
            assert found[name] == pytest.approx(truth, abs=graded.error * F_C)
        for name in ("W_f", "Q_f"):
            assert found[name] == pytest.approx(work, abs=graded.error * F_C * (chord + way))


@pytest.mark.parametrize("ratio", [1.0, 1.5])
@pytest.mark.parametrize("angle", [0.0, 0.5])
def test_break_away_is_anywhere_on_a_disc(graded: Graded, ratio: float, angle: float) -> None:
    """Loaded across, then pushed along: it holds in the disc, then drops along its direction, into heat."""
    V, side = 1e-3, ratio * D * math.sin(angle)
    reach = ratio * D * math.cos(angle)
    values = STATIC | {"friction.staticRatio": ratio, "friction.V_S": 1e-6, "V": V, "delta_y_0": side}
    before, after = graded.steps(values, (1 - 1e-7) * reach / V, 2e-7 * reach / V)
    assert math.hypot(before["F_t"], before["F_y"]) == pytest.approx(ratio * F_C, rel=1e-6)
    assert before["F_y"] == pytest.approx(SIGMA * side, rel=1e-12) and before["Q_f"] == 0.0
    assert (after["F_t"], after["F_y"]) == pytest.approx(
        (F_C * math.cos(angle), F_C * math.sin(angle)), rel=1e-6
    )
    heat = (ratio**2 - 1) * F_C**2 / (2 * SIGMA)
    assert after["Q_f"] == pytest.approx(heat, rel=1e-5, abs=1e-6 * F_C * D)


@pytest.mark.parametrize("h", [3e-6, 7e-5])
def test_dahl_lags_as_far_as_its_force_acts(graded: Graded, h: float) -> None:
    """integral F |V| dt = F_C (integral V dt - change of delta), where |V| is constant: around a circle."""
    (found,) = graded.steps(vibrating("Dahl", 0.7, 0.0, circular=True), h)
    angle, radius = OMEGA * h, V_2 / OMEGA
    way = (radius * math.sin(angle), radius * (math.cos(angle) - 1))
    lags = [way[0] - found["delta"], way[1] - found["delta_y"]]
    means = [found["F_t_mean"] / F_C, found["F_y_mean"] / F_C]
    assert means == pytest.approx([lag / (V_2 * h) for lag in lags], abs=graded.error)


@pytest.mark.parametrize("initial", ["Given", "Settled"])
@pytest.mark.parametrize("h", [1e-5, 1e-3])
def test_held_sliding_relaxes_toward_its_direction(graded: Graded, initial: str, h: float) -> None:
    """Dahl without vibration: delta - n D falls as e^(-V t / D) as a vector, n the direction of V."""
    V = (0.03, -0.04)
    size = math.hypot(*V)
    n = [v / size for v in V]
    begin = [part * D for part in n] if initial == "Settled" else [0.4 * D, 0.7 * D]
    values = CONSTANT | {"V": V[0], "V_y": V[1], "initialState": initial}
    values |= {"delta_0": 0.4 * D, "delta_y_0": 0.7 * D}
    (found,) = graded.steps(values, h)
    z = size * h / D
    end = [D * a + (b - D * a) * math.exp(-z) for a, b in zip(n, begin, strict=True)]
    mean = [F_C * a + SIGMA * (b - D * a) * -math.expm1(-z) / z for a, b in zip(n, begin, strict=True)]
    work = F_C * (size * h - sum(a * (x - b) for a, x, b in zip(n, end, begin, strict=True)))
    stored = SIGMA / 2 * (math.hypot(*end) ** 2 - math.hypot(*begin) ** 2)
    truth = [SIGMA * end[0], SIGMA * end[1], *mean, work, work - stored, *end]
    assert [found[name] for name in RESULTS] == pytest.approx(truth, rel=1e-11)
    assert graded.settled(values) == pytest.approx(tuple(n), rel=1e-12)


def test_a_push_of_zero_at_the_start_goes_on_slipping_if_V_rises() -> None:
    """The reference at V = 0 just after break-away; the limit of a ramp. A V that stays 0 sticks."""
    now = changed(scene_of(STATIC), h=1e-4, delta_0=1.5 * D, V_rate=10.0, slips=1)
    assert reference.step(now).slips == 1
    assert reference.step(changed(now, V_rate=0.0)).slips == 0


# ---- the reference in turned and finer scenes ----


def assert_same(one: Any, two: Any, part: float) -> None:
    for name in RESULTS[:6]:
        scale = two.S * (two.path if name in ("W_f", "Q_f") else 1.0)
        assert getattr(one, name) == pytest.approx(getattr(two, name), abs=part * scale), name


@pytest.mark.parametrize("law", CHOICES["law"])
@pytest.mark.parametrize("limit", CHOICES["limit"])
def test_one_dimension_in_any_direction(law: str, limit: str) -> None:
    """With exact reversals of V, and the deflection in one line with it."""
    rng = random.Random(3)
    for _ in range(10):
        now = drawn(rng, law, limit, planar=False, kappa=(-2, 5))
        truth, angle = reference.step(now), rng.uniform(-3, 3)
        x, y = math.cos(angle), math.sin(angle)
        turned = changed(now)
        for first, second in (("V", "V_y"), ("V_rate", "V_y_rate"), ("V_1", "V_2"), ("delta_0", "delta_y_0")):
            setattr(turned, first, getattr(now, first) * x)
            setattr(turned, second, getattr(now, first) * y)
        found = reference.step(turned)
        back = turned_back({name: getattr(found, name) for name in RESULTS}, angle)
        assert_same(SimpleNamespace(**back), truth, 1e-10)


@pytest.mark.parametrize("law", LAWS_WITH_A_STATE)
@pytest.mark.parametrize("limit", CHOICES["limit"])
def test_energy_and_a_finer_mesh_over_oblique_ellipses(law: str, limit: str) -> None:
    rng = random.Random(4)
    for _ in range(10):
        now = drawn(rng, law, limit, planar=False, kappa=(-2, 5))
        now.V_y, now.V_2 = now.V_1 * rng.uniform(-1, 1), now.V_1 * rng.random()
        now.phase_2 = rng.uniform(-3, 3)
        usual = reference.step(now)
        assert_same(usual, reference.step(now, fineness=2), 1e-13)
        if now.contact == 2:
            squares = usual.delta**2 + usual.delta_y**2 - now.delta_0**2
            stored = now.contact_sigma * squares / 2
            assert usual.W_f - usual.Q_f == pytest.approx(stored, abs=1e-12 * usual.S * usual.path)
