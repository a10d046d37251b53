"""The two interfaces of one contact: loads that open it, inputs that jump, static friction."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from frictioncontact.fmu import FrictionFmu, Value
from workshop.exchange import Host

PERIOD = 5e-5  # s
SEEN = ("F_t", "F_n", "delta", "W_f", "Q_f", "F_y", "delta_y")


def stiff(fmu: FrictionFmu, start: dict[str, Value], stiffness: float) -> dict[str, Value]:
    """With that stiffness [N/m] at the start, whatever the contact is made of."""
    with fmu.session(start) as session:
        return {
            **start,
            "contact.sigma": stiffness,
            "contact.stiffnessScale": stiffness / session.get("sigma"),
        }


def exchanged(
    fmu: FrictionFmu,
    start: dict[str, Value],
    inputs: Callable[[float], dict[str, float]],
    times: np.ndarray,
    tolerance: float,
) -> np.ndarray:
    with Host(
        fmu, start, lambda t, own: inputs(t), tolerance=tolerance, longest_step=times[-1] / 200
    ) as host:
        seen = []
        for time in times[1:]:
            host.advance(time)
            host.event()
            seen.append(host.get(*SEEN))
    return np.array(seen)


def stepped(
    fmu: FrictionFmu,
    start: dict[str, Value],
    inputs: Callable[[float], dict[str, float]],
    times: np.ndarray,
) -> np.ndarray:
    """Inputs that are linear between the times."""
    with fmu.session({**start, "solver.tolerance": 1e-8}) as session:
        seen = []
        for now, then in zip(times[:-1], times[1:], strict=True):
            here, there = inputs(now), inputs(then)
            for name, value in here.items():
                session.set(name, value)
            session.set_rates(**{name: (there[name] - here[name]) / (then - now) for name in here})
            session.step(then - now)
            seen.append([session.get(name) for name in SEEN])
    return np.array(seen)


@pytest.mark.parametrize(
    ("limit", "contact", "across"),
    [
        ("Constant", "Asperities", 0.0),
        ("Constant", "Constant", 1.0),
        ("Constant", "Mindlin", 1.0),
        ("Load", "Asperities", 1.0),
        ("Load", "Constant", 0.0),
        ("Load", "Mindlin", 0.0),
    ],
)
@pytest.mark.parametrize(
    ("law", "ratio"), [("Dahl", 1.0), ("LuGre", 1.5), ("ElasticPlastic", 1.0), ("ElasticPlastic", 1.5)]
)
def test_a_load_that_falls_to_zero_and_comes_back(
    fmu: FrictionFmu, law: str, ratio: float, limit: str, contact: str, across: float
) -> None:
    """While V turns. How fast they move a bound, and its part of Q_f, is taken from the host's steps."""
    corners = np.array([0.0, 0.4, 0.6, 1.0]) * 4 * PERIOD
    times = np.linspace(0.0, 1.0, 101) * 4 * PERIOD

    def inputs(t: float) -> dict[str, float]:
        load = float(np.interp(t, corners, [300.0, -20.0, -20.0, 300.0]))
        V_y = across * float(np.interp(t, corners, [-0.1, 0.2, 0.1, 0.3]))
        return {"load": load, "V": float(np.interp(t, corners, [0.3, 0.2, -0.1, -0.3])), "V_y": V_y}

    start: dict[str, Value] = {
        "friction.model": law,
        "friction.limit": limit,
        "friction.staticRatio": ratio,
        "friction.V_S": 0.2,
        "contact.model": contact,
        "contact.input": "Load",
        "vibration.V_1": 0.2,
        "vibration.V_2": 0.1 * across,
        "vibration.a_d": 0.2e-6,
        **inputs(0.0),
    }
    start = stiff(fmu, start, 20e6)
    found = exchanged(fmu, start, inputs, times, 1e-8)
    expected = stepped(fmu, start, inputs, times)
    opened = expected[:, 1] == 0.0
    assert 20 < opened.sum() < 30
    assert not expected[opened, 2].any() or (limit == "Constant" and contact == "Constant")
    energy = 80.0 * 0.3 * times[-1]
    sizes = [80.0, 300.0, 80.0 / 20e6, energy, energy, 80.0, 80.0 / 20e6]
    off = np.abs((found - expected) / sizes).max(0)
    assert (off < [1e-5, 1e-14, 1e-5, 1e-6, 1e-4, 1e-5, 1e-5]).all(), off


def jumped(rng: np.random.Generator, now: dict[str, float]) -> dict[str, float]:
    """Inputs of which some differ."""
    chosen = rng.choice(list(now), rng.integers(2, 5), replace=False)
    then = {name: now[name] * rng.uniform(0.4, 1.2) for name in chosen}
    if "d" in then:
        then["d"] = now["d"] * rng.uniform(0.95, 1.1)
    if "load" in then and rng.random() < 0.2:
        then["load"] = 0.0
    return {**now, **then}


def heats_of_jumps(fmu: FrictionFmu, number: int) -> list[float]:
    """Of three jumps in a row [J], after looking that both interfaces have them and delta to rounding."""
    rng = np.random.default_rng([37, number])
    now = {"V": rng.uniform(-0.3, 0.3), "d": 14e-6, "E": 58e9, "load": 300.0}
    law = ["ElasticPlastic", "Dahl", "LuGre"][number % 5 % 3]
    start: dict[str, Value] = {
        "friction.model": law,
        "friction.limit": rng.choice(["Constant", "Load"]).item() if law == "ElasticPlastic" else "Load",
        "friction.staticRatio": 1.0 if number % 2 else 1.5,
        "friction.V_S": 0.1,
        "contact.model": rng.choice(["Asperities", "Constant", "Mindlin"]).item(),
        "contact.input": rng.choice(["Separation", "Load"]).item(),
        "vibration.V_1": rng.choice([0.0, 0.1]),
        "vibration.a_d": rng.choice([0.0, 0.2e-6]),
        **now,
    }
    start = stiff(fmu, start, 20e6)
    start["delta_0"] = rng.uniform(-2, 2) * 55.0 / 20e6
    with (
        fmu.session(start) as session,
        Host(fmu, start, lambda t, own: now, tolerance=1e-8) as host,
    ):
        session.step(0.0)
        heats = [session.get("Q_f")]
        for _ in range(3):
            now = jumped(rng, now)
            for name, value in now.items():
                session.set(name, value)
            session.step(0.0)
            host.event()
            delta, Q_f = host.get("delta", "Q_f")
            assert delta == pytest.approx(session.get("delta"), rel=1e-12)
            assert Q_f == pytest.approx(session.get("Q_f"), rel=1e-11)
            heats.append(Q_f)
    return list(np.diff(heats))


def test_inputs_that_jump_at_an_event(fmu: FrictionFmu) -> None:
    """As between two steps of co-simulation."""
    heats = [heat for number in range(120) for heat in heats_of_jumps(fmu, number)]
    assert sum(heat > 0.0 for heat in heats) > 30


@pytest.mark.parametrize(("load", "rate"), [(50.0, 0.0), (500.0, -25e3)])
def test_inputs_whose_speed_changes_at_an_event(fmu: FrictionFmu, load: float, rate: float) -> None:
    """A falling load lets a bristle slip against V. Held, it sticks; raised, it moves to its other bound."""
    start: dict[str, Value] = {
        "friction.model": "ElasticPlastic",
        "friction.limit": "Load",
        "friction.mu": 0.1,
        "friction.staticRatio": 1.02,
        "friction.V_S": 1.0,
        "contact.model": "Constant",
        "contact.sigma": 1e6,
        "contact.input": "Load",
        "V": -0.002,
        "load": 100.0,
    }
    event, end = 1e-3, 20e-3
    start["delta_0"] = 10.2e-6
    now = [100.0, -50e3, 0.0]
    with (
        fmu.session(start) as session,
        Host(
            fmu,
            start,
            lambda t, own: {"V": -0.002, "load": now[0] + now[1] * (t - now[2])},
            tolerance=1e-8,
            longest_step=1e-3,
        ) as host,
    ):
        session.set_rates(load=-50e3)
        session.step(event)
        host.advance(event)
        now[:] = load, rate, event
        host.event()
        for time in np.linspace(event, end, 20)[1:]:
            session.set("load", load + rate * (session.time - event))
            session.set_rates(load=rate)
            session.step(time - session.time)
            host.advance(time)
            assert host.get("F_t")[0] == pytest.approx(session.get("F_t"), abs=1e-5 * load)


def test_no_slip_is_stepped_over(fmu: FrictionFmu) -> None:
    """A vibration that exceeds the bound by 1e-4 to 3 % slips for a while that a host may step over."""
    worst = []
    for number in range(60):
        rng = np.random.default_rng([5, number])
        amplitude = 55.0 / 50e6 * (1.0 + 10.0 ** rng.uniform(-4.0, -1.5))
        start: dict[str, Value] = {
            "friction.model": "ElasticPlastic",
            "contact.model": "Constant",
            "contact.sigma": 50e6,
            "V": 0.0,
        }
        if number % 3 == 1:
            amplitude *= 1.3
            start |= {"friction.staticRatio": 1.3, "friction.V_S": 0.1}
        if number % 3 == 2:
            phase = rng.uniform(0.0, 2.0 * np.pi)
            start |= {"friction.limit": "Load", "vibration.a_d": 0.3e-6, "vibration.phase_d": phase}
        start["vibration.V_1"] = amplitude * 2.0 * np.pi / PERIOD
        stop = rng.uniform(0.6, 1.4) * PERIOD
        with (
            fmu.session({**start, "solver.tolerance": 1e-8}) as session,
            Host(fmu, start, lambda t, own: {}, tolerance=1e-6) as host,
        ):
            session.step(stop)
            host.advance(stop)
            host.event()
            worst.append(abs(host.get("Q_f")[0] - session.get("Q_f")) / (55.0 * 4.0 * amplitude))
    assert max(worst) < 5e-5


@pytest.mark.parametrize("V", [0.02, -0.2, 0.5])
def test_a_settled_start_with_static_friction(fmu: FrictionFmu, V: float) -> None:
    """It may slip from the start: the first period after it is that of co-simulation."""
    start: dict[str, Value] = {
        "initialState": "Settled",
        "friction.model": "ElasticPlastic",
        "friction.staticRatio": 1.4,
        "friction.V_S": 0.1,
        "contact.model": "Constant",
        "contact.sigma": 50e6,
        "V": V,
        "vibration.V_1": 0.3,
    }
    times = np.linspace(0.0, PERIOD, 21)
    found = exchanged(fmu, start, lambda t: {}, times, 1e-9)
    expected = stepped(fmu, start, lambda t: {}, times)
    energy = 55.0 * 0.3 * PERIOD
    assert np.abs((found - expected) / [55.0, 1e3, 1.1e-6, energy, energy, 55.0, 1.1e-6]).max() < 1e-6
