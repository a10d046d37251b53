"""The two interfaces of one contact: inputs that jump and turn at events, slips that a host may step over."""

from __future__ import annotations

import numpy as np
import pytest

from frictioncontact import ModelExchange
from frictioncontact.fmu import FrictionFmu, Value

PERIOD = 5e-5  # s


def stiff(fmu: FrictionFmu, start: dict[str, Value], stiffness: float) -> dict[str, Value]:
    """With that stiffness [N/m] at the start, whatever the contact is made of."""
    with fmu.session(start) as session:
        scale = stiffness / session.get("sigma")
    return start | {"contact.sigma": stiffness, "contact.stiffnessScale": scale}


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
    planar = number % 2
    now |= {"V_y": rng.uniform(-0.3, 0.3)} if planar else {}
    law = ["ElasticPlastic", "Dahl", "LuGre"][number % 5 % 3]
    start: dict[str, Value] = {
        "friction.model": law,
        "friction.limit": rng.choice(["Constant", "Load"]).item() if law == "ElasticPlastic" else "Load",
        "friction.staticRatio": rng.choice([1.0, 1.5]),
        "friction.V_S": 0.1,
        "contact.model": rng.choice(["Asperities", "Constant", "Mindlin"]).item(),
        "contact.input": rng.choice(["Separation", "Load"]).item(),
        "vibration.V_1": rng.choice([0.0, 0.1]),
        "vibration.a_d": rng.choice([0.0, 0.2e-6]),
        **now,
    }
    start = stiff(fmu, start, 20e6)
    start["delta_0"], start["delta_y_0"] = rng.uniform(-2, 2, 2) * [1.0, planar] * 55.0 / 20e6
    with fmu.session(start) as session, ModelExchange(start, inputs=lambda t, own: now, fmu=fmu) as host:
        session.step(0.0)
        heats = [session.get("Q_f")]
        for _ in range(3):
            now = jumped(rng, now)
            for name, value in now.items():
                session.set(name, value)
            session.step(0.0)
            host.event()
            delta, delta_y, Q_f = map(host.get, ("delta", "delta_y", "Q_f"))
            assert [delta, delta_y] == pytest.approx(session.read(("delta", "delta_y")), rel=1e-12)
            assert Q_f == pytest.approx(session.get("Q_f"), rel=1e-11)
            heats.append(Q_f)
    return list(np.diff(heats))


def test_inputs_that_jump_at_an_event(fmu: FrictionFmu) -> None:
    """As between two steps of co-simulation."""
    heats = [heat for number in range(60) for heat in heats_of_jumps(fmu, number)]
    assert sum(heat > 0.0 for heat in heats) > 20


@pytest.mark.parametrize(("load", "rate"), [(50.0, 0.0), (500.0, -25e3)])
def test_inputs_whose_speed_changes_at_an_event(fmu: FrictionFmu, load: float, rate: float) -> None:
    """A falling load lets a bristle slip against V. Held, it sticks; raised, it moves to its other bound."""
    start: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": 1e6, "contact.input": "Load"}
    start |= {"friction.model": "ElasticPlastic", "friction.limit": "Load", "friction.mu": 0.1}
    start |= {"friction.staticRatio": 1.02, "friction.V_S": 1.0}
    start |= {"V": -0.002, "load": 100.0, "delta_0": 10.2e-6}
    event, end = 1e-3, 20e-3
    now = [100.0, -50e3, 0.0]
    with (
        fmu.session(start) as session,
        ModelExchange(
            start,
            inputs=lambda t, own: {"V": -0.002, "load": now[0] + now[1] * (t - now[2])},
            tolerance=1e-8,
            fmu=fmu,
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
            assert host.get("F_t") == pytest.approx(session.get("F_t"), abs=1e-5 * load)


@pytest.mark.parametrize("planar", [False, True], ids=["line", "plane"])
def test_no_slip_is_stepped_over(fmu: FrictionFmu, planar: bool) -> None:
    """A vibration that exceeds the bound by 1e-4 to 3 % slips for a while that a host may step over."""
    worst = []
    for number in range(18):
        rng = np.random.default_rng([5, number])
        amplitude = 55.0 / 50e6 * (1.0 + 10.0 ** rng.uniform(-4.0, -1.5))
        start: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": 50e6, "V": 0.0}
        start["friction.model"] = "ElasticPlastic"
        if number % 3 == 1:
            amplitude *= 1.3
            start |= {"friction.staticRatio": 1.3, "friction.V_S": 0.1}
        if number % 3 == 2:
            phase = rng.uniform(0.0, 2.0 * np.pi)
            start |= {"friction.limit": "Load", "vibration.a_d": 0.3e-6, "vibration.phase_d": phase}
        angle = rng.uniform(0.0, 0.5 * np.pi) if planar else 0.0
        speed = amplitude * 2.0 * np.pi / PERIOD
        start |= {"vibration.V_1": speed * np.cos(angle), "vibration.V_2": speed * np.sin(angle)}
        start["vibration.phase_2"] = rng.choice([0.0, 0.3, 1.5, np.pi])
        stop = rng.uniform(0.6, 1.4) * PERIOD
        with (
            fmu.session({**start, "solver.tolerance": 1e-8}) as session,
            ModelExchange(start, tolerance=1e-8 if planar else 1e-6, fmu=fmu) as host,
        ):
            session.step(stop)
            host.advance(stop)
            host.event()
            worst.append(abs(host.get("Q_f") - session.get("Q_f")) / (55.0 * 4.0 * amplitude))
    assert max(worst) < (1e-4 if planar else 5e-5)
