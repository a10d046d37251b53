"""Every function in every state: what the standard allows succeeds, what it forbids changes nothing."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from call_table import STATES, allowed, good_arguments
from fmi_library import CO_SIMULATION, ERROR, MODEL_EXCHANGE, OK, SIGNATURES, Instance, Library

PLACES = [(kind, state) for kind in STATES for state in STATES[kind]]


@pytest.mark.parametrize(("kind", "state"), PLACES)
def test_every_function(new_instance: Callable[..., Instance], kind: int, state: str) -> None:
    table = allowed(kind)
    assert set(table) == set(SIGNATURES)
    for function, states in table.items():
        instance = new_instance(kind=kind)
        instance.bring_to(state)
        arguments, before = good_arguments(instance, function), instance.fingerprint()
        instance.messages.clear()
        status = instance.call(function, *arguments)
        errors = [message for message in instance.messages if message.status == ERROR]
        assert (status, len(errors)) == ((OK, 0) if state in states else (ERROR, 1)), function
        if state not in states:
            assert errors[0].category == "logStatusError"
            assert function in errors[0].text
            assert instance.fingerprint() == before
        assert instance.call("fmi2Reset") == OK
        assert instance.fingerprint() == new_instance(kind=kind).fingerprint()


def test_a_state_of_the_other_interface_is_refused(new_instance: Callable[..., Instance]) -> None:
    stepped, exchanged = new_instance(kind=CO_SIMULATION), new_instance(kind=MODEL_EXCHANGE)
    state, before = stepped.save(), exchanged.fingerprint()
    assert exchanged.restore(state) == ERROR
    assert exchanged.fingerprint() == before
    assert stepped.drop(state) == OK


def test_without_an_instance(library: Library, instance: Instance) -> None:
    instance.bring_to("step complete")
    for function in SIGNATURES:
        assert getattr(library.dll, function)(None, *good_arguments(instance, function)) == ERROR
    assert library.dll.fmi2GetVersion() == b"2.0"
    assert library.dll.fmi2GetTypesPlatform() == b"default"
    library.dll.fmi2FreeInstance(None)


@pytest.mark.parametrize("name", ["stiffnessScale", "R_q", "R", "eta", "A_n", "nu", "Y", "c", "lambda"])
def test_a_contact_parameter_set_after_a_reset_counts(
    new_instance: Callable[..., Instance], name: str
) -> None:
    parameter = f"contact.{name}"
    used, fresh, unchanged = new_instance(), new_instance(), new_instance()
    used.initialize()
    value = 0.9 * used.get(parameter)[0]
    assert used.call("fmi2Reset") == OK
    assert used.set({parameter: value}) == fresh.set({parameter: value}) == OK
    for instance in (used, fresh, unchanged):
        instance.initialize()
    assert used.get("sigma", "A_r") == fresh.get("sigma", "A_r")
    assert used.get("sigma", "A_r") != unchanged.get("sigma", "A_r")
