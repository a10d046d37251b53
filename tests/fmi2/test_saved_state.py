"""Saving, restoring and serializing the state: replay to the last bit. tests/unit damages the bytes."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import byref, c_void_p

import pytest
from fmi_library import ERROR, OK, Instance

OUTPUTS = ("F_t", "F_y", "F_t_mean", "W_f", "sigma", "delta", "delta_y", "solver.evaluations", "V", "d")
METHODS = {"collocation": 1, "cvode": 2, "backwardEuler": 3, "trapezoid": 4, "rk4": 5, "explicitEuler": 6}


def vibrating(new_instance: Callable[..., Instance], method: int = 1, **values: float) -> Instance:
    """Soft enough for the explicit methods at their internal step."""
    instance = new_instance()
    law = 3 if "friction.staticRatio" in values else 1
    assert instance.choose({"solver.method": method, "friction.model": law}) == OK
    soft = {"contact.stiffnessScale": 1e-6, "vibration.V_1": 0.4, "vibration.a_d": 5e-7}
    assert instance.set({**soft, "solver.stepSize": 1e-7, **values}) == OK
    assert instance.call("fmi2EnterInitializationMode") == OK
    if instance.call("fmi2ExitInitializationMode") != OK and "SUNDIALS" in instance.last_message.text:
        pytest.skip("this build has no cvode, and says so")
    return instance


def run(instance: Instance, first: int, last: int, h: float = 1.3e-5) -> list[list[float]]:
    rows = []
    for step in range(first, last):
        assert instance.set({"V": 0.05 * (step % 3) - 0.04}) == OK
        if step % 4 == 1:
            assert instance.set_input_rates({"V": 100.0, "d": 1e-2}) == OK
        assert instance.step(step * h, h) == OK, instance.messages
        rows.append(instance.get(*OUTPUTS))
    return rows


@pytest.mark.parametrize("method", METHODS)
def test_replay_gives_the_same_bits(new_instance: Callable[..., Instance], method: str) -> None:
    """In the same instance, and from the bytes in another one in any state."""
    across = {"V_y": 0.02, "vibration.V_2": 0.3, "friction.staticRatio": 1.3, "friction.V_S": 0.1}
    values = across if method in ("collocation", "cvode") else {}
    instance = vibrating(new_instance, METHODS[method], **values)
    run(instance, 0, 5)
    assert instance.set_input_rates({"V": -50.0}) == OK
    data, state = instance.fingerprint(), instance.save()
    first = run(instance, 5, 15)
    assert instance.restore(state) == OK and instance.drop(state) == OK
    assert run(instance, 5, 15) == first
    for place in ("instantiated", "initialization", "step complete", "terminated"):
        other = new_instance().start(state=place).become(data)
        assert other.fingerprint() == data
        assert run(other, 5, 15) == first


def test_a_saved_state_outlives_its_instance(new_instance: Callable[..., Instance]) -> None:
    instance, other = vibrating(new_instance), new_instance()
    run(instance, 0, 3)
    state, expected = instance.save(), instance.fingerprint()
    instance.free()
    assert other.restore(state) == OK
    assert other.fingerprint() == expected
    assert other.drop(state) == OK


def test_the_buffer_is_used_again(instance: Instance) -> None:
    assert instance.call("fmi2FreeFMUstate", None) == OK
    assert instance.call("fmi2FreeFMUstate", byref(c_void_p())) == OK
    instance.initialize()
    state = instance.save()
    address = state.value
    assert instance.step(0.0, 1e-5) == OK
    assert instance.save(state).value == address
    assert instance.step(1e-5, 1e-5) == OK
    assert instance.restore(state) == OK
    assert instance.step(1e-5, 1e-5) == OK
    data = instance.fingerprint()
    assert instance.call("fmi2DeSerializeFMUstate", data, len(data), byref(state)) == OK
    assert state.value == address
    assert instance.call("fmi2DeSerializeFMUstate", b"FRICTION" * 50, 400, byref(state)) == ERROR
    assert instance.serialize(state) == data
    assert instance.drop(state) == OK
    assert state.value is None


def test_equal_states_give_equal_bytes(new_instance: Callable[..., Instance]) -> None:
    """Whatever was read, and whatever the name and the log are."""
    one, other = vibrating(new_instance), vibrating(new_instance)
    for instance in (one, other):
        run(instance, 0, 4)
        assert instance.set({"d": 15e-6, "F_C": 40.0}) == OK
    one.get(*OUTPUTS)
    assert one.fingerprint() == other.fingerprint()
    assert other.set({"F_C": 40.000000000000007}) == OK
    assert one.fingerprint() != other.fingerprint()
    quiet, loud = new_instance(name="a"), new_instance(name="another", logging_on=True)
    assert quiet.fingerprint() == loud.fingerprint()


@pytest.mark.parametrize(
    ("state", "follow_up"),
    [("initialization", ("fmi2ExitInitializationMode",)), ("step complete", ("fmi2DoStep", 0.0, 1e-5, 1))],
)
def test_a_state_with_inputs_that_do_not_go_together_can_be_saved(
    new_instance: Callable[..., Instance], state: str, follow_up: tuple[object, ...]
) -> None:
    one, other = new_instance(), new_instance()
    for instance in (one, other):
        instance.bring_to(state)
        assert instance.set({"d": 15e-6, "F_C": 50.0}) == OK
        if instance is one:
            instance.get(*OUTPUTS)
        assert instance.set({"d": 16e-6, "vibration.a_d": 1.0}) == OK
    assert one.fingerprint() == other.fingerprint()
    one.become(one.fingerprint())
    assert one.call(*follow_up) == ERROR
    assert one.output_rate("F_t")[0] == one.directional(["F_t"], {"d": 1.0})[0] == ERROR
    assert "vibration.a_d" in one.last_message.text or state == "initialization"
    assert one.set({"vibration.a_d": 0.0}) == OK
    assert one.call(*follow_up) == OK
