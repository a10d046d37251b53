"""A wrong call is fmi2Error with one message, and leaves the instance like an untouched twin."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from bad_calls import CALLS, BadCall
from fmi_library import ERROR, MODEL_EXCHANGE, OK, Instance

OUTPUTS = ("F_t", "F_t_mean", "W_f", "sigma", "A_r", "delta")


def continue_run(instance: Instance, state: str) -> list[float]:
    """The bits of a short run from the state on."""
    if instance.kind == MODEL_EXCHANGE:
        return continue_exchange(instance, state)
    if state == "instantiated":
        assert instance.call("fmi2EnterInitializationMode") == OK
    if state != "step complete":
        assert instance.call("fmi2ExitInitializationMode") == OK
    for step in range(3):
        assert instance.step(step * 1e-5, 1e-5) == OK, instance.messages
    return instance.get(*OUTPUTS)


def continue_exchange(instance: Instance, state: str) -> list[float]:
    """By the simplest of integrators."""
    if state == "initialization":
        assert instance.call("fmi2ExitInitializationMode") == OK
    if state != "continuous-time mode":
        instance.new_discrete_states()
        assert instance.call("fmi2EnterContinuousTimeMode") == OK
    h = 1e-9
    for step in range(3):
        rates = instance.rates()
        assert instance.call("fmi2SetTime", (step + 1) * h) == OK
        states = zip(instance.states(), rates, strict=True)
        assert instance.put_states(*(x + h * rate for x, rate in states)) == OK
        instance.step_completed()
    return instance.get(*OUTPUTS)


@pytest.mark.parametrize("bad", CALLS, ids=lambda bad: f"{bad.title} ({bad.state})")
def test_bad_call(
    new_instance: Callable[..., Instance], capfd: pytest.CaptureFixture[str], bad: BadCall
) -> None:
    touched, twin = new_instance(kind=bad.kind), new_instance(kind=bad.kind)
    for each in (touched, twin):
        bad.setup(each)
        each.bring_to(bad.state)
        bad.prepare(each)
    assert touched.messages == []
    assert bad.call(touched) == ERROR
    assert len(touched.messages) == 1
    message = touched.last_message
    assert (message.name, message.status, message.category) == ("contact", ERROR, "logStatusError")
    for part in bad.named:
        assert part in message.text
    assert touched.fingerprint() == twin.fingerprint()
    bad.mend(touched)
    bad.mend(twin)
    assert continue_run(touched, bad.state) == continue_run(twin, bad.state)
    assert capfd.readouterr() == ("", "")
