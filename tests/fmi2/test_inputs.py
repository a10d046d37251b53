"""Inputs: those that a scene does not use, those that a tool did not connect, and how long a rate counts."""

from __future__ import annotations

import math
from collections.abc import Callable
from ctypes import c_double

import numpy as np
import pytest
from fmi_library import CO_SIMULATION, ERROR, MODEL_EXCHANGE, OK, Instance

OUTPUTS = ("F_t", "F_y", "F_t_mean", "W_f", "Q_f", "delta", "F_t_settled")
BY_LOAD = {"contact.input": 2}
CONSTANT = {"contact.model": 2}  # with a constant limit neither d nor E nor load counts
COULOMB = {"friction.model": 2}
ANY = (-0.0, -1.0, 1e300, 1e-300)
UNUSED = [
    *((BY_LOAD | law, "d") for law in ({}, {"friction.limit": 2, "friction.model": 3}, CONSTANT, COULOMB)),
    *((law, name) for law in (CONSTANT, COULOMB, CONSTANT | BY_LOAD) for name in ("d", "E", "load")),
    *(({"friction.limit": limit}, "load") for limit in (1, 2)),
]


def outputs(instance: Instance, exchange: bool) -> list[float]:
    """After two steps with a jump, and an input that moves in one; or at the start."""
    if exchange:
        return [*instance.get(*OUTPUTS), *instance.rates(), *instance.indicators()]
    for t in (0.0, 1e-4):
        assert instance.set({"V": 0.02 + t}) == OK
        assert instance.step(t, 1e-4) == OK, instance.messages
    return [*instance.get(*OUTPUTS), instance.output_rate("F_t")[1]]


@pytest.mark.parametrize("kind", [CO_SIMULATION, MODEL_EXCHANGE], ids=["co-simulation", "model exchange"])
@pytest.mark.parametrize(("choices", "name"), UNUSED, ids=str)
def test_what_a_scene_does_not_use_may_be_any_number(
    new_instance: Callable[..., Instance], choices: dict[str, int], name: str, kind: int
) -> None:
    exchange = kind == MODEL_EXCHANGE
    if exchange and choices.get("friction.model") == 2:
        pytest.skip("model exchange has no Coulomb")
    expected = None
    for value in (None, *ANY):
        values = {"vibration.V_1": 0.1, "vibration.a_d": 1e-7} | ({} if value is None else {name: value})
        state = "continuous-time mode" if exchange else "step complete"
        instance = new_instance(kind=kind).start(choices, values, state)
        found = outputs(instance, exchange)
        expected = found if expected is None else expected
        assert found == expected, value


def test_an_unused_input_may_move_through_0(instance: Instance) -> None:
    instance.start(CONSTANT)
    assert instance.set_input_rates({"d": -1.0, "E": -1e12, "load": -1e5}) == OK
    F_n = instance.get("F_n")
    assert instance.step(0.0, 1e-6) == OK
    assert instance.get("F_n") > F_n  # d has moved by 1 um
    assert instance.set_input_rates({"d": -1.0, "E": -1e12, "load": -1e5}) == OK
    assert instance.step(1e-6, 1.0) == OK
    assert instance.get("F_n", "A_r", "sigma") == [0.0, 0.0, 2.5e6]  # there is no such contact
    assert instance.get("W_f") == [pytest.approx(55.0 * (0.005 * 1.000001 - 55.0 / 2.5e6), rel=1e-9)]


@pytest.mark.parametrize("law", [2, 3], ids=["Coulomb", "ElasticPlastic"])
def test_an_unused_load_that_moves_is_the_normal_force(instance: Instance, law: int) -> None:
    instance.start(CONSTANT | BY_LOAD | {"friction.model": law})
    assert instance.set({"load": 100.0}) == OK
    assert instance.set_input_rates({"load": 5e4, "E": 1e12}) == OK
    assert instance.get("F_n") == [pytest.approx(100.0, rel=1e-12)]
    assert instance.step(0.0, 1e-3) == OK
    assert instance.get("F_n", "load") == [pytest.approx(150.0, rel=1e-12)] * 2


@pytest.mark.parametrize("kind", [CO_SIMULATION, MODEL_EXCHANGE], ids=["co-simulation", "model exchange"])
@pytest.mark.parametrize("state", ["instantiated", "initialization"])
def test_a_tool_may_write_0_to_every_input_first(
    new_instance: Callable[..., Instance], state: str, kind: int
) -> None:
    one, other = (new_instance(kind=kind) for _ in range(2))
    connected = {"V": 0.02, "V_y": 0.01, "d": 13e-6, "E": 60e9, "load": 300.0}
    one.bring_to(state)
    other.bring_to(state)
    assert one.set(dict.fromkeys(connected, 0.0)) == OK
    for instance in (one, other):
        assert instance.set(connected) == OK
        if state == "instantiated":
            assert instance.call("fmi2EnterInitializationMode") == OK
        assert instance.call("fmi2ExitInitializationMode") == OK, instance.messages
    if kind == CO_SIMULATION:
        assert [i.step(0.0, 1e-3) for i in (one, other)] == [OK, OK]
    assert one.fingerprint() == other.fingerprint()


@pytest.mark.parametrize("choices", [{}, BY_LOAD, {"friction.limit": 2, "contact.model": 2}], ids=str)
@pytest.mark.parametrize("name", ["d", "E"])
def test_a_used_input_of_0_is_refused_with_a_hint(
    new_instance: Callable[..., Instance], name: str, choices: dict[str, int]
) -> None:
    if choices == BY_LOAD and name == "d":
        pytest.skip("it is not used")
    start = {"d": 14e-6, "E": 58e9}
    for kind in (CO_SIMULATION, MODEL_EXCHANGE):
        for value in (0.0, -0.0, -1.0):
            instance = new_instance(kind=kind).start(choices, {name: value}, "initialization")
            assert instance.call("fmi2ExitInitializationMode") == ERROR
            text = instance.last_message.text
            assert f"{name} = {value:g}" in text and "above 0" in text
            assert ("not connected" in text) == (value == 0.0)
            assert instance.set({name: start[name]}) == OK
            assert instance.call("fmi2ExitInitializationMode") == OK
            assert math.isfinite(*instance.get("F_t"))


BAD = [  # an input that the scene cannot use, and what the message says of it
    ({}, {"d": 0.0}, "d = 0 m must be above 0 m"),
    ({}, {"d": -1e-6}, "d = -1e-06 m must be above 0 m"),
    ({}, {"E": 0.0}, "E = 0 Pa must be above 0 Pa"),
    (BY_LOAD, {"E": -1.0}, "E = -1 Pa must be above 0 Pa"),
    (BY_LOAD, {"load": 1e9}, "load = 1e+09 N presses the surfaces together"),
    ({}, {"d": 1e-6}, "vibration.a_d = 2e-06 m must be below d = 1e-06 m"),
]


@pytest.mark.parametrize("kind", [CO_SIMULATION, MODEL_EXCHANGE], ids=["co-simulation", "model exchange"])
@pytest.mark.parametrize(("choices", "bad", "message"), BAD, ids=str)
def test_an_input_is_judged_by_the_call_that_uses_it(
    new_instance: Callable[..., Instance],
    kind: int,
    choices: dict[str, int],
    bad: dict[str, float],
    message: str,
) -> None:
    """It is taken, so that inputs may be set in any order. Refused calls change nothing."""
    state = "step complete" if kind == CO_SIMULATION else "continuous-time mode"
    values = {"V": 0.02, "vibration.a_d": 2e-6, "vibration.V_1": 0.1}
    one, other = (new_instance(kind=kind).start(choices, values, state) for _ in range(2))
    (name,) = bad
    (good,) = one.get(name)
    assert one.set(bad) == OK and one.set({"V": 0.03}) == OK
    before = one.fingerprint()
    for use in ("F_t", "F_t_settled", "der(delta)", "a derivative", "a step"):
        if use == "a step" and kind == CO_SIMULATION:
            assert one.step(0.0, 1e-4) == ERROR
        elif use == "a derivative":
            assert one.directional(["F_t"], {"V": 1.0})[0] == ERROR
        elif use != "a step":
            assert one.call("fmi2GetReal", one.references([use]), 1, (c_double * 1)()) == ERROR
        assert message in one.last_message.text, use
        assert one.fingerprint() == before
    assert one.set({name: good}) == OK and other.set({"V": 0.03}) == OK
    if kind == CO_SIMULATION:
        assert [each.step(0.0, 1e-4) for each in (one, other)] == [OK, OK]
    assert one.get(*OUTPUTS) == other.get(*OUTPUTS)
    assert one.fingerprint() == other.fingerprint()


# How long a rate counts: mu load + sigma_1 mu load' / sigma for a slipping bristle of constant stiffness.

MU, SIGMA, DAMPING, LOAD, RATE, H = 0.2, 2e6, 500.0, 100.0, 2e4, 1e-3


def slipping(new_instance: Callable[..., Instance], kind: int = CO_SIMULATION) -> Instance:
    choices = {"friction.model": 3, "friction.limit": 2, "contact.model": 2, "contact.input": 2}
    values = {"friction.mu": MU, "contact.sigma": SIGMA, "friction.sigma_1": DAMPING}
    return new_instance(kind=kind).start(choices, values | {"load": LOAD, "V": 0.5}, "instantiated")


def force(load: float, rate: float) -> float:
    return pytest.approx(MU * load + DAMPING * MU * rate / SIGMA, rel=1e-12)


def moved(new_instance: Callable[..., Instance]) -> Instance:
    """After a step in which the load has moved, and V, too."""
    instance = slipping(new_instance)
    instance.initialize()
    assert instance.set_input_rates({"load": RATE, "V": 1.0}) == OK
    assert instance.step(0.0, H) == OK
    assert instance.get("F_t", "load") == [force(LOAD + RATE * H, RATE), LOAD + RATE * H]
    return instance


def test_a_rate_counts_until_the_input_is_set_again(new_instance: Callable[..., Instance]) -> None:
    """A new one is seen at once, and lasts one step. A saved state knows."""
    instance = moved(new_instance)
    fresh = new_instance().become(instance.fingerprint())
    assert fresh.get("F_t") == [force(120.0, RATE)]
    assert fresh.set_input_rates({"load": -RATE}) == OK
    assert fresh.get("F_t") == [force(120.0, -RATE)]
    for t, rate in ((H, -RATE), (2 * H, 0.0)):
        assert fresh.step(t, H) == OK
        assert fresh.get("F_t", "load") == [force(100.0, rate), 100.0]
    assert instance.set({"V": 0.4, "friction.sigma_2": 0.0}) == OK
    assert instance.get("F_t") == [force(120.0, RATE)]
    assert instance.output_rate("F_t") == (OK, pytest.approx(MU * RATE, rel=1e-12))
    assert instance.set({"load": 120.0}) == OK
    assert instance.get("F_t") == [force(120.0, 0.0)]
    assert instance.output_rate("F_t") == (OK, 0.0)


def test_a_rate_may_be_set_before_its_input(new_instance: Callable[..., Instance]) -> None:
    one, other = moved(new_instance), moved(new_instance)
    assert one.set_input_rates({"load": -RATE}) == OK and one.set({"load": 110.0}) == OK
    assert other.set({"load": 110.0}) == OK and other.set_input_rates({"load": -RATE}) == OK
    for instance in (one, other):
        assert instance.get("F_t") == [force(110.0, -RATE)]
        assert instance.step(H, H) == OK
        assert instance.get("load") == [90.0]
    assert one.fingerprint() == other.fingerprint()


def test_the_force_of_model_exchange_knows_no_rates(new_instance: Callable[..., Instance]) -> None:
    instance = slipping(new_instance, MODEL_EXCHANGE)
    assert instance.set({"delta_0": MU * LOAD / SIGMA}) == OK
    instance.bring_to("continuous-time mode")
    for k in range(1, 4):
        assert instance.call("fmi2SetTime", k * H) == OK
        assert instance.set({"load": LOAD + k}) == OK
        assert instance.get("F_t") == [force(LOAD + k, 0.0)]
        instance.step_completed()


@pytest.mark.parametrize(("start", "h"), [(0.0, 0.1), (1e6, 1e-6)])
def test_a_host_may_add_its_steps_up_to_the_stop_time(instance: Instance, start: float, h: float) -> None:
    """The sums err by up to 2 of their steps; a step that begins at the stop time is refused."""
    times = np.cumsum(np.concatenate(([start], np.full(100_000, h))))
    stop = start + 100_000 * h
    instance.initialize(start=start, stop=stop)
    last = float(times[-2])
    assert instance.step(start, last - start) == OK
    assert instance.step(last, h) == OK, instance.messages
    reached = last + h
    if reached < stop:
        assert instance.step(reached, stop - reached) == OK
        reached += stop - reached
    assert instance.step(reached, h) == ERROR
    assert "after the stop time" in instance.last_message.text
