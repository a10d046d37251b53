"""Model exchange across the sliding: against formulas, and against co-simulation, alone and with a mass."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest

from frictioncontact.fmu import FrictionFmu, Value
from workshop.exchange import Host

F_C, LOAD, PERIOD = 55.0, 312.44, 5e-5
NAMES = ("F_t", "F_y", "delta", "delta_y", "W_f", "Q_f")
BLOCK: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": 2.5e6, "F_C": F_C}
D = F_C / 2.5e6  # m, the bound of such a contact


@dataclass(frozen=True)
class Scene:
    start: dict[str, Value]
    rates: dict[str, float]  # per s, of inputs
    h: float  # s
    speed: float  # m/s


def drawn(number: int, fmu: FrictionFmu) -> Scene:
    """Every law, limit and contact; kappa from 0.1 to 100; half the inputs move, most scenes vibrate."""
    rng = np.random.default_rng([41, number])
    chance = lambda p: bool(rng.random() < p)  # noqa: E731
    law = ("Dahl", "LuGre", "ElasticPlastic", "ElasticPlastic")[number % 4]
    V, V_y = rng.choice([-1.0, 1.0], 2) * 10 ** rng.uniform(-2, 0, 2)
    V_1, V_2 = (10 ** rng.uniform(-2, 0.3) if chance(0.6) else 0.0 for _ in range(2))
    speed = max(abs(V), abs(V_y), V_1, V_2)
    sigma = 10 ** rng.uniform(-1, 2) * F_C * 2 * math.pi / (PERIOD * speed)
    h = rng.uniform(0.3, 2.0) * PERIOD
    moves, pressed = chance(0.5), chance(0.5)
    damped = chance(0.5) and not moves  # the damping would not see how inputs move the bound
    reach, angle = rng.uniform(0, 0.9) * F_C / sigma, rng.uniform(0, 2 * math.pi)
    start: dict[str, Value] = {
        "friction.model": law,
        "friction.limit": rng.choice(["Constant", "Load"]).item(),
        "contact.model": rng.choice(["Asperities", "Constant", "Mindlin"]).item(),
        "contact.input": "Load" if pressed else "Separation",
        "contact.sigma": sigma,
        "V": V,
        "V_y": V_y,
        "vibration.V_1": V_1,
        "vibration.V_2": V_2,
        "vibration.phase_2": rng.uniform(0, 2 * math.pi),
        "vibration.a_d": 10 ** rng.uniform(-7.5, -6) if chance(0.4) else 0.0,
        "vibration.phase_d": rng.uniform(0, 2 * math.pi),
        "friction.staticRatio": rng.uniform(1, 2) if number % 4 in (1, 3) else 1.0,
        "friction.V_S": 10 ** rng.uniform(-2, 0) * speed,
        "friction.sigma_1": rng.uniform(0, 0.02) * F_C / speed if damped else 0.0,
        "friction.sigma_2": rng.uniform(0, 0.1) * F_C / speed if chance(0.4) else 0.0,
        "delta_0": reach * math.cos(angle),
        "delta_y_0": reach * math.sin(angle),
    }
    if start["contact.model"] != "Constant":
        with fmu.session(start) as session:
            start["contact.stiffnessScale"] = sigma / session.get("sigma")
    rates = {"V": rng.uniform(-2, 2) * V / h, "V_y": rng.uniform(-2, 2) * V_y / h}
    rates |= {"load": rng.uniform(-0.5, 0.5) * LOAD / h} if pressed else {"d": rng.uniform(-3e-7, 3e-7) / h}
    return Scene(start, rates if moves else {}, h, speed)


def stepped(fmu: FrictionFmu, scene: Scene) -> tuple[np.ndarray, float]:
    """By co-simulation, and the limit of the force at the start [N]."""
    with fmu.session({**scene.start, "solver.tolerance": 1e-8}) as session:
        by_load = scene.start["friction.limit"] == "Load"
        limit = 0.176 * session.get("F_n") if by_load else F_C
        session.set_rates(**scene.rates)
        session.step(scene.h)
        return session.read(NAMES), limit


def exchanged(fmu: FrictionFmu, scene: Scene, tolerance: float, parts: int = 40) -> np.ndarray:
    at_start = {"d": 14e-6, "load": LOAD} | {name: scene.start[name] for name in ("V", "V_y")}

    def inputs(t: float, own: np.ndarray) -> dict[str, float]:
        return {name: float(at_start[name]) + rate * t for name, rate in scene.rates.items()}

    with Host(fmu, scene.start, inputs, tolerance=tolerance, longest_step=scene.h / parts) as host:
        host.advance(scene.h)
        host.event()
        return host.get(*NAMES)


def test_both_interfaces_agree(fmu: FrictionFmu) -> None:
    """The host's tolerance is 1e-7, which acts on the part of a force that its integrator sees."""
    worst = []
    for number in range(48):
        scene = drawn(number, fmu)
        expected, limit = stepped(fmu, scene)
        length, energy = limit / float(scene.start["contact.sigma"]), limit * scene.speed * scene.h
        sizes = [limit, limit, length, length, energy, energy]
        worst.append(float((np.abs(exchanged(fmu, scene, 1e-7) - expected) / sizes).max()))
    assert max(worst) < 3e-5, int(np.argmax(worst))


def test_a_slip_turns_towards_the_velocity(fmu: FrictionFmu) -> None:
    """D theta' = -V sin theta, so tan(theta / 2) falls by e^(-V t / D); the heat is F_C D times a log."""
    V, theta, t = 0.1, 1.3, 1.5 * D / 0.1
    start = {"delta_0": D * math.cos(theta), "delta_y_0": D * math.sin(theta)}
    with Host(
        fmu,
        BLOCK | start | {"friction.model": "ElasticPlastic", "V": V},
        lambda t, own: {},
        tolerance=1e-10,
    ) as host:
        host.advance(t)
        now = 2 * math.atan(math.tan(0.5 * theta) * math.exp(-V * t / D))
        F_t, F_y, W_f, Q_f = host.get("F_t", "F_y", "W_f", "Q_f")
    assert [F_t, F_y] == pytest.approx([F_C * math.cos(now), F_C * math.sin(now)], rel=1e-7)
    assert W_f == pytest.approx(F_C * D * math.log(math.sin(theta) / math.sin(now)), rel=1e-7)
    assert Q_f == pytest.approx(W_f, rel=1e-7)


def test_it_breaks_away_at_the_disc_of_static_friction(fmu: FrictionFmu) -> None:
    """Stuck along (V, V_y) from delta_y_0 up to |delta| = 1.5 D; there it drops to the kinetic circle."""
    V, V_y, start_y = 0.08, -0.06, 0.5 * D
    static: dict[str, Value] = {
        "friction.model": "ElasticPlastic",
        "friction.staticRatio": 1.5,
        "friction.V_S": 0.1,
        "friction.sigma_1": 3.0,
    }
    along, size = V_y * start_y, 0.1
    t = (-along + math.sqrt(along**2 - size**2 * (start_y**2 - (1.5 * D) ** 2))) / size**2
    n = np.array([V * t, start_y + V_y * t]) / (1.5 * D)
    kinetic = D * (1 + 0.5 * math.exp(-1.0))
    with Host(
        fmu, BLOCK | static | {"V": V, "V_y": V_y, "delta_y_0": start_y}, lambda t, own: {}, tolerance=1e-9
    ) as host:
        host.advance(t * (1 - 1e-6))
        F_t, F_y = host.get("F_t", "F_y") - 3.0 * np.array([V, V_y])
        assert [F_t, F_y] == pytest.approx(1.5 * F_C * n, rel=1e-5)
        before = host.get("Q_f")[0]
        host.advance(t * (1 + 1e-6))
        delta, delta_y, Q_f = host.get("delta", "delta_y", "Q_f")
    assert [delta, delta_y] == pytest.approx(kinetic * n, rel=1e-5)
    drop = (kinetic - 1.5 * D) * (n @ [V, V_y])
    assert Q_f - before == pytest.approx(0.5 * 2.5e6 * (2.25 * D**2 - kinetic**2) + 3.0 * drop, rel=1e-4)


def test_no_slip_is_stepped_over(fmu: FrictionFmu) -> None:
    """A vibration in the plane that exceeds the bound by 1e-4 to 3 % slips for a short while.

    The tolerance is fine, because the moment of a graze, and with it the kinetic bound, is sensitive.
    """
    worst = []
    for number in range(30):
        rng = np.random.default_rng([5, number])
        amplitude = D * (1.0 + 10.0 ** rng.uniform(-4.0, -1.5))
        start = BLOCK | {"friction.model": "ElasticPlastic", "V": 0.0, "V_y": 0.0}
        if number % 3 == 1:
            amplitude *= 1.3
            start |= {"friction.staticRatio": 1.3, "friction.V_S": 0.1}
        if number % 3 == 2:
            start |= {
                "friction.limit": "Load",
                "vibration.a_d": 0.3e-6,
                "vibration.phase_d": rng.uniform(0, 6),
            }
        angle, V = rng.uniform(0, 0.5 * math.pi), amplitude * 2.0 * math.pi / PERIOD
        start |= {"vibration.V_1": V * math.cos(angle), "vibration.V_2": V * math.sin(angle)}
        start["vibration.phase_2"] = rng.choice([0.0, 0.3, 1.5, math.pi])
        scene = Scene({"friction.limit": "Constant"} | start, {}, rng.uniform(0.6, 1.4) * PERIOD, V)
        Q_f = stepped(fmu, scene)[0][5]
        worst.append(abs(exchanged(fmu, scene, 1e-8, parts=1)[5] - Q_f) / (F_C * 4.0 * amplitude))
    assert max(worst) < 1e-4


def test_jumps_at_an_event(fmu: FrictionFmu) -> None:
    """As between two steps of co-simulation, in the direction of the deflection."""
    heats = []
    for number in range(40):
        rng = np.random.default_rng([37, number])
        law = ("ElasticPlastic", "Dahl", "LuGre")[number % 3]
        now = {"V": rng.uniform(-0.3, 0.3), "V_y": rng.uniform(-0.3, 0.3), "load": 300.0}
        start: dict[str, Value] = {
            **BLOCK,
            "friction.model": law,
            "friction.limit": "Load",
            "contact.input": "Load",
            "friction.staticRatio": 1.0 if number % 2 else 1.5,
            "friction.V_S": 0.1,
            "vibration.V_2": rng.choice([0.0, 0.1]),
            "delta_0": rng.uniform(-1.5, 1.5) * D,
            "delta_y_0": rng.uniform(-1.5, 1.5) * D,
            **now,
        }
        with (
            fmu.session(start) as session,
            Host(fmu, start, lambda t, own, now=now: now, tolerance=1e-8) as host,
        ):
            session.step(0.0)
            for _ in range(3):
                for name in rng.choice(list(now), 2, replace=False):
                    now[name] *= rng.uniform(0.3, 1.2)
                for name, value in now.items():
                    session.set(name, value)
                session.step(0.0)
                host.event()
                assert host.get("delta", "delta_y") == pytest.approx(
                    session.read(("delta", "delta_y")), rel=1e-12
                )
                assert host.get("Q_f")[0] == pytest.approx(session.get("Q_f"), rel=1e-11)
                heats.append(host.get("Q_f")[0])
    assert sum(after > before for before, after in pairwise(heats)) > 30


class Dragged:
    """1 kg on a table, on a spring of 10 N/mm in x and y whose end is moved along an oblique ellipse."""

    K, END = 1e4, 0.2  # N/m, s

    def pull(self, t: float, x: np.ndarray) -> np.ndarray:
        end = [8e-3 * math.sin(40.0 * t), 5e-3 * math.sin(55.0 * t + 0.6)]
        return self.K * (np.array(end) - x)

    def start(self, law: str) -> dict[str, Value]:
        return BLOCK | {"friction.model": law, "friction.staticRatio": 1.2, "V": 0.0, "friction.V_S": 0.05}

    def exchange(self, fmu: FrictionFmu, law: str, times: np.ndarray) -> np.ndarray:
        """Rows of x, y, F_t, F_y; x and y are states of the host."""

        def rates(t: float, own: np.ndarray, F_t: float, F_y: float) -> tuple[float, ...]:
            a, a_y = self.pull(t, own[:2]) - [F_t, F_y]
            return own[2], own[3], a, a_y

        with Host(
            fmu,
            self.start(law),
            lambda t, own: {"V": own[2], "V_y": own[3]},
            tolerance=1e-8,
            own=(0.0,) * 4,
            own_nominals=(1e-3, 1e-3, 0.1, 0.1),
            own_rates=rates,
            forces=("F_t", "F_y"),
        ) as host:
            rows = []
            for t in times:
                host.advance(t)
                rows.append((*host.own[:2], *host.get("F_t", "F_y")))
        return np.array(rows)

    def cosimulate(self, fmu: FrictionFmu, law: str, times: np.ndarray, parts: int) -> np.ndarray:
        """With steps in which velocities move as forces and their derivatives at the start say."""
        x, v, t, rows = np.zeros(2), np.zeros(2), 0.0, []
        h = times[0] / parts
        with fmu.session(self.start(law)) as session:
            for _ in times:
                for _ in range(parts):
                    force = session.read(("F_t", "F_y"))
                    rate = np.array([session.force_rate(name) for name in ("F_t", "F_y")])
                    middle = x + 0.5 * h * v
                    a = self.pull(t + 0.5 * h, middle) - force - 0.5 * h * rate
                    session.set("V", float(v[0]))
                    session.set("V_y", float(v[1]))
                    session.set_rates(V=float(a[0]), V_y=float(a[1]))
                    session.step(h)
                    x, v, t = x + h * v + 0.5 * h**2 * a, v + h * a, t + h
                rows.append((*x, *session.read(("F_t", "F_y"))))
        return np.array(rows)


@pytest.mark.parametrize("law", ["Dahl", "LuGre", "ElasticPlastic"])
def test_a_mass_dragged_over_a_table(fmu: FrictionFmu, law: str) -> None:
    """It sticks, breaks away and turns. The steps of co-simulation are of second order."""
    dragged = Dragged()
    times = np.linspace(0.0, dragged.END, 41)[1:]
    exact = dragged.exchange(fmu, law, times)
    coarse, fine = (dragged.cosimulate(fmu, law, times, parts) for parts in (100, 200))
    scale = [F_C / dragged.K] * 2 + [F_C] * 2
    errors = [float((np.abs(rows - exact) / scale).max()) for rows in (coarse, fine)]
    assert errors[1] < 2e-3 and errors[0] > 2.0 * errors[1], errors
