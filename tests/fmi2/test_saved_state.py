"""Saving, restoring and serializing the state: replay to the last bit. tests/unit damages the bytes."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import byref, c_void_p

import pytest
from fmi_library import ERROR, OK, Instance

OUTPUTS = ("F_t", "F_t_mean", "W_f", "sigma", "A_r", "delta", "solver.evaluations", "V", "d", "E")
METHODS = {"collocation": 1, "cvode": 2, "backwardEuler": 3, "trapezoid": 4, "rk4": 5, "explicitEuler": 6}


def vibrating(new_instance: Callable[..., Instance], method: int = 1) -> Instance:
    """Soft enough for the explicit methods at their internal step."""
    instance = new_instance()
    assert instance.choose({"solver.method": method}) == OK
    soft = {
        "contact.stiffnessScale": 1e-6,
        "vibration.V_1": 0.4,
        "vibration.a_d": 5e-7,
        "solver.stepSize": 1e-7,
    }
    assert instance.set(soft) == OK
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
    instance = vibrating(new_instance, METHODS[method])
    run(instance, 0, 5)
    state = instance.save()
    first = run(instance, 5, 15)
    assert instance.restore(state) == OK
    assert run(instance, 5, 15) == first
    assert instance.restore(state) == OK
    assert run(instance, 5, 15) == first
    assert instance.drop(state) == OK


@pytest.mark.parametrize("method", METHODS)
def test_another_instance_replays_from_the_bytes(new_instance: Callable[..., Instance], method: str) -> None:
    instance = vibrating(new_instance, METHODS[method])
    run(instance, 0, 5)
    assert instance.set_input_rates({"V": -50.0}) == OK
    data = instance.fingerprint()
    first = run(instance, 5, 15)
    for state in ("instantiated", "initialization", "step complete", "terminated"):
        other = new_instance()
        other.bring_to(state)
        status, saved = other.deserialize(data)
        assert status == OK
        assert other.restore(saved) == OK
        assert other.fingerprint() == data
        assert run(other, 5, 15) == first
        assert other.drop(saved) == OK


def test_a_saved_state_outlives_its_instance(new_instance: Callable[..., Instance]) -> None:
    instance, other = vibrating(new_instance), new_instance()
    run(instance, 0, 3)
    state = instance.save()
    expected = instance.fingerprint()
    instance.free()
    assert other.restore(state) == OK
    assert other.fingerprint() == expected
    assert other.drop(state) == OK


def test_the_buffer_is_used_again(instance: Instance) -> None:
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
    assert instance.drop(state) == OK
    assert state.value is None


def test_freeing_nothing_is_allowed(instance: Instance) -> None:
    assert instance.call("fmi2FreeFMUstate", None) == OK
    assert instance.call("fmi2FreeFMUstate", byref(c_void_p())) == OK


def test_equal_states_give_equal_bytes(new_instance: Callable[..., Instance]) -> None:
    one, other = vibrating(new_instance), vibrating(new_instance)
    for instance in (one, other):
        run(instance, 0, 4)
        assert instance.set({"d": 15e-6, "F_C": 40.0}) == OK
    one.get(*OUTPUTS)
    assert one.fingerprint() == other.fingerprint()
    assert other.set({"F_C": 40.000000000000007}) == OK
    assert one.fingerprint() != other.fingerprint()


def test_names_and_log_switches_are_not_part_of_a_state(new_instance: Callable[..., Instance]) -> None:
    quiet, loud = new_instance(name="a"), new_instance(name="another", logging_on=True)
    assert quiet.fingerprint() == loud.fingerprint()


def test_a_refused_state_leaves_the_buffer_alone(instance: Instance) -> None:
    instance.initialize()
    state = instance.save()
    before = instance.serialize(state)
    assert instance.call("fmi2DeSerializeFMUstate", b"FRICTION" * 50, 400, byref(state)) == ERROR
    assert instance.serialize(state) == before
    assert instance.drop(state) == OK


@pytest.mark.parametrize("state", ["initialization", "step complete"])
def test_a_state_with_inputs_that_do_not_go_together_can_be_saved(
    new_instance: Callable[..., Instance], state: str
) -> None:
    one, other = new_instance(), new_instance()
    for instance in (one, other):
        instance.bring_to(state)
        assert instance.set({"d": 15e-6, "F_C": 50.0}) == OK
        if instance is one:
            instance.get(*OUTPUTS)
        assert instance.set({"d": 16e-6, "vibration.a_d": 1.0}) == OK
    assert one.fingerprint() == other.fingerprint()
    status, saved = one.deserialize(one.fingerprint())
    assert status == OK
    assert one.restore(saved) == OK
    follow_up = {
        "initialization": ("fmi2ExitInitializationMode",),
        "step complete": ("fmi2DoStep", 0.0, 1e-5, 1),
    }
    assert one.call(*follow_up[state]) == ERROR
    assert one.set({"vibration.a_d": 0.0}) == OK
    assert one.call(*follow_up[state]) == OK
    assert one.drop(saved) == OK


def test_reading_in_initialization_mode_leaves_the_state_as_it_is(
    new_instance: Callable[..., Instance],
) -> None:
    read, silent = new_instance(), new_instance()
    for instance in (read, silent):
        assert instance.set({"delta_0": 1e-9}) == OK
        assert instance.call("fmi2SetupExperiment", 0, 0.0, 3.5, 0, 0.0) == OK
        instance.bring_to("initialization")
        assert instance.set({"vibration.a_d": 1.0}) == OK
        if instance is read:
            assert instance.set({"vibration.a_d": 0.0}) == OK
            instance.get(*OUTPUTS)
            assert instance.set({"vibration.a_d": 1.0}) == OK
    assert read.fingerprint() == silent.fingerprint()
