"""A mass inside the FMU: balances, closed motions and limits; the reference of the hunts against scipy."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from frictioncontact.errors import FrictionError
from frictioncontact.fmu import FrictionFmu, Value, simulate
from tools.bench.mass_inside import HELD, INSIDE, ROWS, coupled, error
from tools.reference import scene, step

SIGMA, F_C, M = 6e6, 55.0, 1.0  # N/m, N, kg
OMEGA, D = math.sqrt(SIGMA / M), F_C / SIGMA
BODY: dict[str, Value] = {
    "contact.model": "Constant",
    "contact.sigma": SIGMA,
    "F_C": F_C,
    "V": 0.0,
    "body.m": M,
}
STICKS: dict[str, Value] = {**BODY, "friction.model": "ElasticPlastic", "solver.tolerance": 1e-8}
LAWS = ("Dahl", "Coulomb", "ElasticPlastic", "LuGre")


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("V_1", [0.0, 0.7])
def test_momentum_is_kept_to_rounding(fmu: FrictionFmu, law: str, V_1: float) -> None:
    """m times the change of v is H times the mean of body.F less F_t_mean, also where body.F is linear."""
    static: dict[str, Value] = {} if law in ("Dahl", "Coulomb") else {"friction.staticRatio": 1.3}
    start = {**BODY, "friction.model": law, "vibration.V_1": V_1, "body.v_0": 0.1, **static}
    H, force = 3e-4, np.array([80.0, -30.0, 60.0, 60.0, 10.0])
    outputs = ("body.v", "F_t_mean")
    rows = simulate(fmu, start, H, 4, {"body.F": force}, linear=True, outputs=outputs)
    pushed = 0.5 * (force[1:] + force[:-1]) - rows["F_t_mean"][1:]
    assert M * np.diff(rows["body.v"]) == pytest.approx(H * pushed, abs=1e-14 * F_C * H + 1e-15 * M)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("V", [0.0, -0.02])
def test_energy_is_kept(fmu: FrictionFmu, law: str, V: float) -> None:
    """In the frame of the other surface m w^2 / 2 grows by the work of body.F less W_f."""
    start: dict[str, Value] = {"friction.model": law, "V": V, "body.F": 70.0, "solver.tolerance": 1e-8}
    damping: dict[str, Value] = {} if law == "Coulomb" else {"friction.sigma_1": 400.0}
    with fmu.session({**BODY, **start, **damping, "friction.sigma_2": 3.0}) as session:
        for H in (1e-4, 1e-3, 7e-4):
            names = ("body.v", "body.x", "W_f", "Q_f", "delta")
            v, x, W, Q, delta = session.read(names)
            session.step(H)
            to_v, to_x, to_W, to_Q, to_delta = session.read(names)
            path = abs(to_x - x + V * H) + D
            gained = 0.5 * M * ((to_v + V) ** 2 - (v + V) ** 2)
            assert gained == pytest.approx(70.0 * (to_x - x + V * H) - (to_W - W), abs=1e-8 * F_C * path)
            stored = 0.0 if law == "Coulomb" else 0.5 * SIGMA * (to_delta**2 - delta**2)
            assert to_W - W == pytest.approx(to_Q - Q + stored, abs=1e-8 * F_C * path)


def test_a_pull_on_dahl_from_rest_by_the_path(fmu: FrictionFmu) -> None:
    """F_t = F_C (1 - e^(-x/D)) while x grows, and m v^2 / 2 = F x - integral of F_t over x."""
    pull = 80.0
    with fmu.session({**BODY, "body.F": pull, "solver.tolerance": 1e-8}) as session:
        for H in (1e-5, 3e-4, 2e-3):
            session.step(H)
            v, x, F_t = session.read(("body.v", "body.x", "F_t"))
            relaxed = -math.expm1(-x / D)
            assert F_t == pytest.approx(F_C * relaxed, abs=2e-8 * F_C)
            assert v == pytest.approx(math.sqrt(2.0 / M * (pull * x - F_C * (x - D * relaxed))), rel=1e-7)


@pytest.mark.parametrize("zeta", [0.0, 0.1, 0.9])
@pytest.mark.parametrize("H", [1e-5, 1e-3, 7e-3])
def test_a_stuck_mass_is_an_oscillator(fmu: FrictionFmu, zeta: float, H: float) -> None:
    """Under a force that begins to pull: delta = F/sigma (1 - e^(-at) (cos wt + a/w sin wt))."""
    pull, a = 20.0, zeta * OMEGA
    w, damping = math.sqrt(OMEGA**2 - a**2), 2.0 * zeta * M * OMEGA
    with fmu.session({**STICKS, "friction.sigma_1": damping, "body.F": pull}) as session:
        session.step(H)
        fall = math.exp(-a * H)
        x = pull / SIGMA * (1.0 - fall * (math.cos(w * H) + a / w * math.sin(w * H)))
        v = pull / (M * w) * fall * math.sin(w * H)
        assert session.get("body.v") == pytest.approx(v, abs=1e-8 * F_C * H / M)
        assert session.get("body.x") == pytest.approx(x, abs=1e-8 * F_C * H * H / M)
        assert session.get("F_t") == pytest.approx(SIGMA * x + damping * v, abs=1e-8 * F_C)
        assert session.get("Q_f") == 0.0 or zeta > 0.0


@pytest.mark.parametrize("zeta", [0.0, 0.1, 0.5])
def test_a_sudden_force_slips_by_its_overshoot(fmu: FrictionFmu, zeta: float) -> None:
    """An undamped contact of 55 N slips from 27.5 N on."""
    least = F_C / (1.0 + math.exp(-math.pi * zeta / math.sqrt(1.0 - zeta**2)))
    for pull, slips in ((0.9999 * least, False), (1.0001 * least, True)):
        scene_ = {**STICKS, "friction.sigma_1": 2.0 * zeta * M * OMEGA, "body.F": pull}
        with fmu.session(scene_) as session:
            session.step(4.0 / OMEGA)
            x, delta = session.read(("body.x", "delta"))
            assert (x - delta > 1e-6 * D) == slips


@pytest.mark.parametrize("zeta", [0.0, 0.01, 0.5])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-6])
def test_the_fastest_ringing_is_solved_or_refused(fmu: FrictionFmu, zeta: float, tolerance: float) -> None:
    """Dahl's law on 1 g and 6e12 N/m, 12 000 cycles in a step of 1 ms, within 1 s (sanitizers: 10)."""
    m, sigma, pull = 1e-3, 6e12, 30.0
    stiff: dict[str, Value] = {**BODY, "contact.sigma": sigma, "body.m": m, "body.F": pull}
    damped: dict[str, Value] = {"friction.sigma_1": 2.0 * zeta * math.sqrt(sigma * m)}
    with fmu.session({**stiff, **damped, "solver.tolerance": tolerance}) as session:
        refused, begin = "", time.process_time()
        try:
            session.step(1e-3)
        except FrictionError as error:
            refused = str(error)
        assert time.process_time() - begin < 10.0
        if refused:
            assert "body.m = 0.001 kg: the step of 0.001 s is refused" in refused
            session.step(1e-8)  # the instance is as before
        else:
            assert session.get("F_t") == pytest.approx(pull, abs=tolerance * F_C)


def test_coulomb_stops_a_mass_and_holds_it(fmu: FrictionFmu) -> None:
    """It rests after m v / (g - F), and F_t is then body.F, held or linear."""
    v_0, pull = 0.02, 30.0
    stop = M * v_0 / (F_C - pull)
    start = {**BODY, "friction.model": "Coulomb", "body.v_0": v_0, "body.F": pull}
    with fmu.session(start) as session:
        session.step(0.5 * stop)
        assert session.get("body.v") == pytest.approx(0.5 * v_0, rel=1e-12)
        session.step(stop)
        assert session.read(("body.v", "F_t")) == pytest.approx((0.0, pull), abs=1e-15)
        assert session.get("body.x") == pytest.approx(0.5 * v_0 * stop, rel=1e-12)
        assert session.get("F_t_mean") == pytest.approx((0.5 * F_C + 0.5 * pull), rel=1e-12)
        session.set_rates(**{"body.F": 2.0 * (F_C - pull) / stop})  # it passes the limit at half of the step
        session.step(stop)
        assert session.get("body.v") == pytest.approx(0.25 * (F_C - pull) * stop / M, rel=1e-10)


def test_a_stiffer_bristle_tends_to_coulomb(fmu: FrictionFmu) -> None:
    """The largest difference of v over the largest v falls as the time of ringing, to a tenth each."""
    coulomb = coupled(fmu, replace(ROWS[0], law="Coulomb"), INSIDE)["v"]
    off = [coupled(fmu, replace(ROWS[0], sigma=s), INSIDE)["v"] - coulomb for s in (6e6, 6e8, 6e10)]
    found = [float(np.abs(each).max() / np.abs(coulomb).max()) for each in off]
    assert found[0] < 0.063 and found[1] < found[0] / 8.0 and found[2] < found[1] / 8.0


@pytest.mark.parametrize("law", LAWS)
def test_a_heavy_mass_is_none(fmu: FrictionFmu, law: str) -> None:
    """It keeps its velocity: a contact with that V."""
    moves: dict[str, Value] = {"friction.model": law, "vibration.V_1": 0.3, "solver.tolerance": 1e-8}
    outputs = ("F_t", "F_t_mean", "W_f", "Q_f")
    heavy = {**BODY, **moves, "body.m": 1e12, "body.v_0": 0.1, "V": 0.02}
    alone = {**BODY, **moves, "body.m": 0.0, "V": 0.12}
    found, right = (simulate(fmu, start, 1.3e-4, 5, outputs=outputs) for start in (heavy, alone))
    for name in outputs[:2]:
        assert found[name] == pytest.approx(right[name], abs=2e-8 * F_C)
    for name in outputs[2:]:
        assert found[name] == pytest.approx(right[name], abs=2e-8 * F_C * 5e-4)


@pytest.mark.parametrize("law", LAWS)
def test_one_long_step_is_ten_short_ones(fmu: FrictionFmu, law: str) -> None:
    start = {**BODY, "friction.model": law, "body.F": 90.0, "body.v_0": -0.05, "solver.tolerance": 1e-8}
    short, long = (simulate(fmu, start, 1e-2 / n, n, outputs=("F_t", "body.v", "body.x")) for n in (10, 1))
    for name, allowed in (("F_t", F_C), ("body.v", F_C * 1e-2 / M), ("body.x", F_C * 1e-4 / M)):
        assert short[name][-1] == pytest.approx(long[name][-1], abs=1e-7 * allowed)


@pytest.mark.parametrize(("row", "end"), [(0, 0.1), (1, 0.1), (2, 4e-3), (4, 4e-3)])
def test_the_master_of_the_page_errs_by_the_forces_that_it_holds(
    fmu: FrictionFmu, row: int, end: float
) -> None:
    """Held to linear, and where the contact vibrates under a constant pull nothing is left."""
    short = replace(ROWS[row], end=end)
    held, linear = error(fmu, short, HELD), error(fmu, short, INSIDE)
    assert linear < (1e-6 if short.vibrates else 2.25e-3)  # 2.2e-3, as the page rounds
    assert held < 1e-6 if short.vibrates else held > 20.0 * linear


# ---- The reference, by another program and method ----

SCENES: list[dict[str, float | str]] = [
    {"law": "Dahl", "F": 70.0, "F_rate": -4e4, "sigma_1": 500.0, "sigma_2": 3.0},
    {"law": "Dahl", "F": 30.0, "V_1": 0.3, "V": 0.05, "contact_sigma": 6e5, "m": 0.1, "h": 2e-4},
    {"law": "LuGre", "F": 80.0, "F_rate": -1e5, "staticRatio": 1.5},
    {"law": "ElasticPlastic", "F": 80.0, "F_rate": -1.5e5, "sigma_2": 5.0},
    {"law": "ElasticPlastic", "F": 95.0, "F_rate": -2e5, "staticRatio": 1.5, "sigma_2": 5.0},
    {"law": "Coulomb", "F": 10.0, "V_1": 0.03, "m": 0.1, "sigma_2": 1.0, "h": 2e-4},
]


@pytest.mark.parametrize("of", SCENES, ids=lambda of: str(of["law"]))
def test_the_reference_agrees_with_scipy(of: dict[str, float | str]) -> None:
    """DOP853 at 1e-13 from event to event; what slips, sticks or turns is decided here anew."""
    usual = {"contact": "Constant", "contact_sigma": SIGMA, "F_C": F_C, "V": 0.0, "m": M, "h": 1e-3}
    s = scene(**{**usual, **of})
    y, side, t, law = np.zeros(4), 1.0, 0.0, of["law"]  # delta, v, x and the impulse
    slips = law == "Coulomb"

    def drive(t: float) -> tuple[float, float]:
        """V and its rate."""
        turns = 2.0 * math.pi * s.f
        return s.V + s.V_1 * math.cos(turns * t), -s.V_1 * turns * math.sin(turns * t)

    def excess(w: float) -> float:
        return (s.staticRatio - 1.0) * math.exp(-((w / s.V_S) ** 2)) if s.staticRatio > 1.0 else 0.0

    def rates(t: float, y: np.ndarray) -> list[float]:
        w, g = y[1] + drive(t)[0], s.F_C * (1.0 + excess(y[1] + drive(t)[0]))
        if law == "Coulomb" and not slips:
            held = s.F + s.F_rate * t + s.m * drive(t)[1]
            return [0.0, -drive(t)[1], y[1], held]
        own = 0.0 if slips else w if law == "ElasticPlastic" else w - s.contact_sigma * side * w / g * y[0]
        force = (side * g if slips else s.contact_sigma * y[0] + s.sigma_1 * own) + s.sigma_2 * w
        return [own, (s.F + s.F_rate * t - force) / s.m, y[1], force]

    def event(t: float, y: np.ndarray) -> float:
        w = y[1] + drive(t)[0]
        if law == "Coulomb" and not slips:
            return s.F_C - abs(rates(t, y)[3])
        if law == "ElasticPlastic" and not slips:
            return (s.F_C * s.staticRatio / s.contact_sigma) ** 2 - y[0] ** 2
        slope = -2.0 * w / s.V_S**2 * s.F_C / s.contact_sigma * excess(w) * (law == "ElasticPlastic")
        return side * w - slope * (rates(t, y)[1] + drive(t)[1])

    event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
    scale = np.array([D, F_C * s.h / s.m, F_C * s.h**2 / s.m, F_C * s.h])
    while True:
        how = {"rtol": 1e-13, "atol": 1e-14 * scale, "events": event, "max_step": s.h / 50}
        piece = solve_ivp(rates, (t, s.h), y, "DOP853", **how)
        y, t = piece.y[:, -1].copy(), piece.t[-1]
        w = y[1] + drive(t)[0]
        kinetic = side * s.F_C * (1.0 + excess(w)) / s.contact_sigma
        y[0] = kinetic if law == "ElasticPlastic" and slips else y[0]
        if t >= s.h:
            break
        if law == "ElasticPlastic":
            side, slips = math.copysign(1.0, y[0]), not slips
        elif law == "Coulomb":
            held = s.F + s.F_rate * t + s.m * drive(t)[1]
            slips = not slips or abs(held) > s.F_C
            side = math.copysign(1.0, held)
        else:
            side = -side
    right = step(s)
    found = [rates(s.h, y)[3], y[3] / s.h, y[1] / (s.h / s.m), y[2] / (s.h**2 / s.m)]
    assert found == pytest.approx(
        [right.F_t, right.F_t_mean, right.v * s.m / s.h, right.x * s.m / s.h**2], abs=2e-12 * F_C
    )
