"""Model exchange by its raw functions: rates and their derivatives, events, nominal values, saved states."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from fmi_library import ERROR, MODEL_EXCHANGE, OK, Instance

DAHL, ELASTIC_PLASTIC, LUGRE = 1, 3, 4
RATES = ("der(delta)", "der(W_f)", "der(Q_f)", "der(delta_y)")
CONTINUOUS = "continuous-time mode"
BLOCK = {"contact.sigma": 2.5e6, "F_C": 50.0}  # bound at 20 um with contact.model = Constant


def started(
    new_instance: Callable[..., Instance], choices: dict[str, int], values: dict[str, float]
) -> Instance:
    return new_instance(kind=MODEL_EXCHANGE).start(choices, values, CONTINUOUS)


def block(new_instance: Callable[..., Instance], law: int, **values: float) -> Instance:
    """A contact of constant stiffness and limit."""
    return started(new_instance, {"friction.model": law, "contact.model": 2}, {**BLOCK, **values})


def test_rates_of_the_same_names_in_co_simulation(new_instance: Callable[..., Instance]) -> None:
    instance, exchanged = new_instance(), new_instance(kind=MODEL_EXCHANGE)
    for each, state in ((instance, "step complete"), (exchanged, CONTINUOUS)):
        values = {"V": 0.1, "vibration.V_1": 0.02, "friction.sigma_2": 3.0}
        each.start({"friction.model": LUGRE}, values, state)
    for step in range(5):
        assert instance.step(step * 1e-5, 1e-5) == OK
        assert exchanged.call("fmi2SetTime", (step + 1) * 1e-5) == OK
        assert exchanged.put_states(*instance.get("delta", "W_f", "Q_f", "delta_y")) == OK
        assert instance.get(*RATES) == pytest.approx(exchanged.rates(), rel=1e-12)


def test_a_bristle_reaches_its_bound_and_leaves_it(new_instance: Callable[..., Instance]) -> None:
    """Stick, slip, stick: each event moves the indicators back above 0, and asks for no second one."""
    instance = block(new_instance, ELASTIC_PLASTIC, V=0.1)
    assert all(z > 0 for z in instance.indicators())
    assert instance.put_states(20e-6 * (1 - 1e-9), 0.0, 0.0) == OK
    assert all(z > 0 for z in instance.indicators())
    assert instance.put_states(20e-6 * (1 + 1e-9), 0.0, 0.0) == OK
    assert instance.indicators()[1] < 0
    assert instance.step_completed()
    assert instance.event().valuesOfContinuousStatesChanged
    assert instance.states()[0] == pytest.approx(20e-6, rel=1e-15)
    assert all(z > 0 for z in instance.indicators()) and not instance.step_completed()
    assert instance.rates() == pytest.approx([0.0, 5.0, 5.0, 0.0], rel=1e-15)
    assert instance.set({"V": 1e-12}) == OK
    assert all(z > 0 for z in instance.indicators())
    assert instance.set({"V": -1e-12}) == OK
    assert instance.indicators()[2] < 0 and instance.step_completed()
    instance.event()
    assert all(z > 0 for z in instance.indicators())
    assert instance.rates()[0] == -1e-12
    assert not instance.event().valuesOfContinuousStatesChanged


def test_a_bristle_breaks_away_and_sticks_again(new_instance: Callable[..., Instance]) -> None:
    """Stuck to the static bound of 30 um, then along 20 um (1 + e^-(V / V_S)^2 / 2) until V is 0."""
    static = {"friction.staticRatio": 1.5, "friction.V_S": 0.1, "friction.sigma_1": 3.0}
    instance = block(new_instance, ELASTIC_PLASTIC, V=0.1, **static)
    D_s, D_k = 30e-6, 20e-6 * (1 + 0.5 * math.exp(-1))
    assert instance.put_states(D_s * (1 - 1e-9), 0.0, 0.0) == OK
    assert all(z > 0 for z in instance.indicators()) and not instance.step_completed()
    assert instance.put_states(D_s * (1 + 1e-9), 0.0, 0.0) == OK
    assert instance.indicators()[1] < 0 and instance.step_completed()
    assert instance.event().valuesOfContinuousStatesChanged
    delta, W_f, Q_f, _ = instance.states()
    drop = D_k - D_s * (1 + 1e-9)
    assert delta == pytest.approx(D_k, rel=1e-15)
    assert W_f == pytest.approx(3.0 * 0.1 * drop, rel=1e-12)  # by the damper, at once
    assert Q_f == pytest.approx(0.5 * 2.5e6 * (D_s**2 * (1 + 1e-9) ** 2 - D_k**2) + W_f, rel=1e-12)
    assert all(z > 0 for z in instance.indicators()) and not instance.step_completed()
    assert instance.get("F_t")[0] == pytest.approx(2.5e6 * D_k, rel=1e-14)
    assert instance.set({"V": 0.05}) == OK  # along the bound, wherever delta is
    assert instance.get("F_t")[0] == pytest.approx(50 * (1 + 0.5 * math.exp(-0.25)), rel=1e-14)
    assert instance.set({"V": 0.0}) == OK
    assert instance.indicators()[2] <= 0 and instance.step_completed()
    instance.event()
    assert instance.states()[0] == pytest.approx(30e-6, rel=1e-14)
    assert instance.set({"V": 1e-3}) == OK
    instance.event()
    assert all(z > 0 for z in instance.indicators()) and instance.rates()[0] == 1e-3  # it sticks


def test_a_parameter_set_in_continuous_time_mode_acts_like_an_input(
    new_instance: Callable[..., Instance],
) -> None:
    """The bristle slips along the bound of the present F_C until the event, which puts it there."""
    instance = block(new_instance, ELASTIC_PLASTIC, V=0.1, delta_0=1e-3, **{"contact.sigma": 1e6})
    for F_C in (50.0, 60.0):
        assert instance.set({"F_C": F_C}) == OK
        assert instance.get("F_t", "der(delta)") == [pytest.approx(F_C, rel=1e-14), 0.0]
        instance.event()
        assert instance.get("F_t", "delta") == pytest.approx([F_C, F_C / 1e6], rel=1e-12)


@pytest.mark.parametrize("contact", [1, 2, 3])
def test_a_contact_opens_and_closes_at_events(new_instance: Callable[..., Instance], contact: int) -> None:
    choices = {"friction.model": LUGRE, "friction.limit": 2, "contact.input": 2, "contact.model": contact}
    values = {"V": 0.1, "load": 100.0, "friction.sigma_2": 7.0, "contact.stiffnessScale": 1e-6}
    instance = started(new_instance, choices, values)
    sizes = nominals(instance)
    assert instance.put_states(1e-9, 0.0, 0.0) == OK
    for load, opens in ((1e-9, False), (0.0, True), (-50.0, False), (0.0, False), (1e-9, True)):
        assert instance.set({"load": load}) == OK
        assert (instance.indicators()[3] <= 0) == opens
        if opens:
            assert instance.step_completed()
            instance.event()
            assert all(z > 0 for z in instance.indicators()[1:]) and not instance.step_completed()
        if load <= 0:
            assert instance.get("F_t", "F_n", "A_r", "delta") == [7.0 * 0.1, 0.0, 0.0, 0.0]
            assert instance.rates() == pytest.approx([0.0, 0.07, 0.07, 0.0], rel=1e-14)
            assert nominals(instance) == sizes
    assert instance.rates()[0] == pytest.approx(0.1, rel=1e-12)


def announced(instance: Instance, t: float) -> float | None:
    assert instance.call("fmi2SetTime", t) == OK
    info = instance.event()
    return info.nextEventTime if info.nextEventTimeDefined else None


@pytest.mark.parametrize("V", [0.0, 0.01, -0.019])
def test_the_turns_of_the_vibration_are_announced(new_instance: Callable[..., Instance], V: float) -> None:
    """ElasticPlastic turns back from the bound it is near to where V + V_1 cos(2 pi f t) changes sign."""
    omega, V_1, period = 2e3 * math.pi, 0.02, 1e-3
    instance = block(new_instance, ELASTIC_PLASTIC, V=V, **{"vibration.V_1": V_1, "vibration.f": 1e3})
    forward = math.acos(-V / V_1) / omega  # V turns negative
    for side, first, turn in ((1, 0.0, forward), (-1, forward * 1.01, period - forward)):
        begin = max(first, turn - 0.2 * period)
        way = V * (turn - begin) + V_1 / omega * (math.sin(omega * turn) - math.sin(omega * begin))
        for k in range(3):
            assert instance.put_states(side * 19.9e-6 - way, 0.0, 0.0) == OK
            found = announced(instance, k * period + begin)
            assert found == pytest.approx(k * period + turn, abs=1e-11) and found > k * period + turn
    assert instance.put_states(-0.5 * V * period, 0.0, 0.0) == OK
    assert announced(instance, 0.0) == pytest.approx(period / 3, rel=1e-8)  # near no bound


@pytest.mark.parametrize("law", [DAHL, ELASTIC_PLASTIC, LUGRE], ids=["Dahl", "ElasticPlastic", "LuGre"])
@pytest.mark.parametrize("limit", [1, 2], ids=["Constant", "Load"])
@pytest.mark.parametrize("across", [0.0, 0.3])
def test_the_next_time_event_is_a_third_of_a_period_ahead_at_most(
    new_instance: Callable[..., Instance], law: int, limit: int, across: float
) -> None:
    """In every law, along a line and in the plane."""
    choices = {"friction.model": law, "friction.limit": limit}
    instance = started(new_instance, choices, {"vibration.V_1": 0.2, "vibration.V_2": across})
    for k in range(8):
        t = k * 0.37 / 20e3
        assert t < announced(instance, t) <= t + (1 / 3 + 1e-8) / 20e3
    assert announced(block(new_instance, law, V=0.1), 0.0) is None  # without vibration


def test_the_stop_time_is_refused_at_once(new_instance: Callable[..., Instance]) -> None:
    """An integrator may look beyond it from before, and not by more than the run is long."""
    instance = new_instance(kind=MODEL_EXCHANGE)
    instance.set_up(0.0, 0.5)
    instance.bring_to(CONTINUOUS)
    assert instance.call("fmi2SetTime", 0.6) == OK
    assert instance.call("fmi2SetTime", 1.1) == ERROR
    assert "after the stop time 0.5 s" in instance.last_message.text
    assert instance.call("fmi2SetTime", 0.5) == OK
    assert not instance.step_completed()
    assert instance.call("fmi2SetTime", 0.50001) == ERROR
    assert instance.call("fmi2SetTime", 0.4) == OK


def test_a_load_that_falls_on_a_bristle_at_rest(new_instance: Callable[..., Instance]) -> None:
    """V is 0 and the bound comes nearer: the bristle goes with it, and the host gets no thousand events."""
    choices = {"friction.model": ELASTIC_PLASTIC, "friction.limit": 2, "contact.input": 2, "contact.model": 2}
    instance = started(new_instance, choices, {"V": 0.0, "load": 100.0, "delta_0": 17e-6 / 2.5, **BLOCK})
    events = 0
    for step in range(1, 1001):
        assert instance.call("fmi2SetTime", step * 1e-3) == OK
        assert instance.set({"load": 100.0 - 0.05 * step}) == OK
        if instance.step_completed() or min(instance.indicators()[1:]) <= 0:
            instance.event()
            events += 1
    instance.event()  # gives the heat of what has slipped since the last one
    assert instance.get("F_t")[0] == pytest.approx(0.176 * 50.0, rel=1e-12)
    assert instance.get("Q_f")[0] == pytest.approx((17.0**2 - (0.176 * 50.0) ** 2) / (2 * 2.5e6), rel=1e-11)
    assert 1 <= events <= 3


def test_an_indicator_of_the_kink(new_instance: Callable[..., Instance]) -> None:
    """V with its vibration in Dahl and LuGre; ElasticPlastic has no kink."""
    for law, expected in ((DAHL, 0.3 - 0.2), (LUGRE, 0.3 - 0.2), (ELASTIC_PLASTIC, 1.0)):
        instance = block(new_instance, law, V=0.3, **{"vibration.V_1": 0.2, "vibration.f": 1.0})
        assert instance.call("fmi2SetTime", 0.5) == OK
        assert instance.indicators()[0] == pytest.approx(expected, rel=1e-14)


def nominals(instance: Instance) -> list[float]:
    return instance.vector("fmi2GetNominalsOfContinuousStates")


def test_nominal_values_are_the_scene_s(new_instance: Callable[..., Instance]) -> None:
    """delta: F / sigma; the energies: F times that, or times the amplitude of a vibration if larger."""
    instance = block(new_instance, DAHL)
    assert nominals(instance) == pytest.approx([20e-6, 1e-3, 1e-3, 20e-6], rel=1e-14)
    assert instance.call("fmi2EnterEventMode") == OK
    assert not instance.new_discrete_states().nominalsOfContinuousStatesChanged
    assert instance.set({"F_C": 100.0, "vibration.V_1": 50.0}) == OK
    assert instance.new_discrete_states().nominalsOfContinuousStatesChanged
    amplitude = 50.0 / (2 * math.pi * 20e3)
    assert nominals(instance) == pytest.approx([40e-6, 100 * amplitude, 100 * amplitude, 40e-6], rel=1e-14)
    by_load = started(
        new_instance,
        {"friction.limit": 2, "contact.input": 2, "contact.model": 2},
        {"load": 200.0, "vibration.a_d": 1e-6, **BLOCK},
    )
    assert nominals(by_load)[0] == pytest.approx(0.176 * 200.0 / 2.5e6, rel=1e-12)


@pytest.mark.parametrize("law", [DAHL, ELASTIC_PLASTIC, LUGRE])
def test_a_saved_state_replays_to_the_bit(new_instance: Callable[..., Instance], law: int) -> None:
    """In the same instance and, from its bytes, in another; the regime is part of it."""

    def run(instance: Instance) -> list[float]:
        seen = []
        for step in range(1, 40):
            rates = instance.rates()
            assert instance.call("fmi2SetTime", step * 2e-6) == OK
            x = [a + 2e-6 * b for a, b in zip(instance.states(), rates, strict=True)]
            assert instance.put_states(*x) == OK
            if instance.step_completed():
                instance.event()
            seen += [*instance.get("F_t", *RATES), *instance.indicators()]
        return seen

    choices = {"friction.model": law, "contact.model": 2, "friction.limit": 2}
    values = {"V": 0.5, "vibration.a_d": 1e-6, "vibration.V_1": 1.0, "delta_0": 21e-6, **BLOCK}
    instance = started(new_instance, choices, values)
    data, state = instance.fingerprint(), instance.save()
    first = run(instance)
    assert instance.restore(state) == OK
    assert run(instance) == first
    assert instance.drop(state) == OK
    assert run(new_instance(kind=MODEL_EXCHANGE).become(data)) == first
