"""Which function may be called in which state: every function in every state that an instance can be in."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from ctypes import byref, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p

import pytest
from fmi_library import (
    CO_SIMULATION,
    ERROR,
    INDICATORS,
    LAST_SUCCESSFUL_TIME,
    MODEL_EXCHANGE,
    OK,
    SIGNATURES,
    TERMINATED_STATUS,
    EventInfo,
    Instance,
    Library,
)
from fmi_library import STATES as CONTINUOUS_STATES

# FMI 2.0, section 4.2.4, the columns of the states that a synchronous slave without fmi2Discard can be in.
TABLE = """
                               instantiated   initialization   step complete   terminated
fmi2SetDebugLogging                 x               x                x              x
fmi2SetupExperiment                 x               -                -              -
fmi2EnterInitializationMode         x               -                -              -
fmi2ExitInitializationMode          -               x                -              -
fmi2Terminate                       -               -                x              -
fmi2Reset                           x               x                x              x
fmi2GetReal                         -               x                x              x
fmi2GetInteger                      -               x                x              x
fmi2GetBoolean                      -               x                x              x
fmi2GetString                       -               x                x              x
fmi2SetReal                         x               x                x              -
fmi2SetInteger                      x               x                x              -
fmi2SetBoolean                      x               x                x              -
fmi2SetString                       x               x                x              -
fmi2GetFMUstate                     x               x                x              x
fmi2SetFMUstate                     x               x                x              x
fmi2FreeFMUstate                    x               x                x              x
fmi2SerializedFMUstateSize          x               x                x              x
fmi2SerializeFMUstate               x               x                x              x
fmi2DeSerializeFMUstate             x               x                x              x
fmi2GetDirectionalDerivative        -               x                x              x
fmi2SetRealInputDerivatives         x               x                x              -
fmi2GetRealOutputDerivatives        -               -                x              x
fmi2DoStep                          -               -                x              -
fmi2CancelStep                      -               -                -              -
fmi2GetStatus                       -               -                x              x
fmi2GetRealStatus                   -               -                x              x
fmi2GetIntegerStatus                -               -                x              x
fmi2GetBooleanStatus                -               -                x              x
fmi2GetStringStatus                 -               -                x              x
fmi2EnterEventMode                  -               -                -              -
fmi2NewDiscreteStates               -               -                -              -
fmi2EnterContinuousTimeMode         -               -                -              -
fmi2CompletedIntegratorStep         -               -                -              -
fmi2SetTime                         -               -                -              -
fmi2SetContinuousStates             -               -                -              -
fmi2GetDerivatives                  -               -                -              -
fmi2GetEventIndicators              -               -                -              -
fmi2GetContinuousStates             -               -                -              -
fmi2GetNominalsOfContinuousStates   -               -                -              -
"""
# FMI 2.0, section 3.2.3.
MODEL_EXCHANGE_TABLE = """
                               instantiated   initialization   event mode   continuous-time mode   terminated
fmi2SetDebugLogging                 x               x              x                x                  x
fmi2SetupExperiment                 x               -              -                -                  -
fmi2EnterInitializationMode         x               -              -                -                  -
fmi2ExitInitializationMode          -               x              -                -                  -
fmi2Terminate                       -               -              x                x                  -
fmi2Reset                           x               x              x                x                  x
fmi2GetReal                         -               x              x                x                  x
fmi2GetInteger                      -               x              x                x                  x
fmi2GetBoolean                      -               x              x                x                  x
fmi2GetString                       -               x              x                x                  x
fmi2SetReal                         x               x              x                x                  -
fmi2SetInteger                      x               x              x                -                  -
fmi2SetBoolean                      x               x              x                -                  -
fmi2SetString                       x               x              x                -                  -
fmi2GetFMUstate                     x               x              x                x                  x
fmi2SetFMUstate                     x               x              x                x                  x
fmi2FreeFMUstate                    x               x              x                x                  x
fmi2SerializedFMUstateSize          x               x              x                x                  x
fmi2SerializeFMUstate               x               x              x                x                  x
fmi2DeSerializeFMUstate             x               x              x                x                  x
fmi2GetDirectionalDerivative        -               x              x                x                  x
fmi2SetRealInputDerivatives         -               -              -                -                  -
fmi2GetRealOutputDerivatives        -               -              -                -                  -
fmi2DoStep                          -               -              -                -                  -
fmi2CancelStep                      -               -              -                -                  -
fmi2GetStatus                       -               -              -                -                  -
fmi2GetRealStatus                   -               -              -                -                  -
fmi2GetIntegerStatus                -               -              -                -                  -
fmi2GetBooleanStatus                -               -              -                -                  -
fmi2GetStringStatus                 -               -              -                -                  -
fmi2EnterEventMode                  -               -              x                x                  -
fmi2NewDiscreteStates               -               -              x                -                  -
fmi2EnterContinuousTimeMode         -               -              x                -                  -
fmi2CompletedIntegratorStep         -               -              -                x                  -
fmi2SetTime                         -               -              x                x                  -
fmi2SetContinuousStates             -               -              -                x                  -
fmi2GetDerivatives                  -               -              x                x                  x
fmi2GetEventIndicators              -               x              x                x                  x
fmi2GetContinuousStates             -               x              x                x                  x
fmi2GetNominalsOfContinuousStates   x               -              x                x                  x
"""


def rows(table: str) -> dict[str, list[str]]:
    return {line.split()[0]: line.split()[1:] for line in table.strip().splitlines()[1:]}


STATES = {
    CO_SIMULATION: ["instantiated", "initialization", "step complete", "terminated"],
    MODEL_EXCHANGE: ["instantiated", "initialization", "event mode", "continuous-time mode", "terminated"],
}
TABLES = {CO_SIMULATION: rows(TABLE), MODEL_EXCHANGE: rows(MODEL_EXCHANGE_TABLE)}
NAMES = {CO_SIMULATION: "co-simulation", MODEL_EXCHANGE: "model exchange"}
PLACES = [
    pytest.param(kind, state, id=f"{NAMES[kind]}-{state}".replace(" ", "_"))
    for kind in STATES
    for state in STATES[kind]
]
CASES = [
    pytest.param(kind, function, state, cell == "x", id=f"{NAMES[kind]}-{function}-{state}".replace(" ", "_"))
    for kind, table in TABLES.items()
    for function, cells in table.items()
    for state, cell in zip(STATES[kind], cells, strict=True)
]

# Legal in their state, but without an answer in a slave that never leaves a step pending.
ALWAYS_REFUSED = {"fmi2GetStatus", "fmi2GetIntegerStatus", "fmi2GetStringStatus"}


def good_arguments(instance: Instance, function: str) -> tuple[object, ...]:
    """Arguments with which the function succeeds wherever the call is legal."""
    real = (c_double * 1)(0.01)
    one_input = (c_uint * 1)(instance.library.variables["V"].reference)
    one_output = (c_uint * 1)(instance.library.variables["F_t"].reference)
    states = (c_double * CONTINUOUS_STATES)()
    indicators = (c_double * INDICATORS)()
    if function.startswith(("fmi2GetFMU", "fmi2SetFMU", "fmi2FreeFMU", "fmi2Serialize", "fmi2DeSerialize")):
        return state_arguments(instance, function)
    arguments: dict[str, tuple[object, ...]] = {
        "fmi2SetDebugLogging": (0, 0, None),
        "fmi2SetupExperiment": (0, 0.0, 0.0, 0, 0.0),
        "fmi2GetReal": (one_output, 1, (c_double * 1)()),
        "fmi2SetReal": (one_input, 1, (c_double * 1)(0.02)),
        "fmi2GetDirectionalDerivative": (one_output, 1, one_input, 1, real, (c_double * 1)()),
        "fmi2SetRealInputDerivatives": (one_input, 1, (c_int * 1)(1), real),
        "fmi2GetRealOutputDerivatives": (one_output, 1, (c_int * 1)(1), (c_double * 1)()),
        "fmi2DoStep": (0.0, 1e-5, 1),
        "fmi2GetStatus": (0, (c_int * 1)()),
        "fmi2GetRealStatus": (LAST_SUCCESSFUL_TIME, (c_double * 1)()),
        "fmi2GetIntegerStatus": (0, (c_int * 1)()),
        "fmi2GetBooleanStatus": (TERMINATED_STATUS, (c_int * 1)()),
        "fmi2GetStringStatus": (1, (c_char_p * 1)()),
        "fmi2NewDiscreteStates": (byref(EventInfo()),),
        "fmi2CompletedIntegratorStep": (1, (c_int * 1)(), (c_int * 1)()),
        "fmi2SetTime": (0.0,),
        "fmi2SetContinuousStates": (states, CONTINUOUS_STATES),
        "fmi2GetDerivatives": (states, CONTINUOUS_STATES),
        "fmi2GetEventIndicators": (indicators, INDICATORS),
        "fmi2GetContinuousStates": (states, CONTINUOUS_STATES),
        "fmi2GetNominalsOfContinuousStates": (states, CONTINUOUS_STATES),
    }
    if function in ("fmi2GetInteger", "fmi2SetInteger", "fmi2GetBoolean", "fmi2SetBoolean"):
        return (None, 0, None)
    if function in ("fmi2GetString", "fmi2SetString"):
        return (None, 0, None)
    return arguments.get(function, ())


def state_arguments(instance: Instance, function: str) -> tuple[object, ...]:
    state = instance.save()
    data = instance.serialize(state)
    return {
        "fmi2GetFMUstate": (byref(state),),
        "fmi2SetFMUstate": (state,),
        "fmi2FreeFMUstate": (byref(state),),
        "fmi2SerializedFMUstateSize": (state, byref(c_size_t())),
        "fmi2SerializeFMUstate": (state, ctypes.create_string_buffer(len(data)), len(data)),
        "fmi2DeSerializeFMUstate": (data, len(data), byref(state)),
    }[function]


def assert_usable(instance: Instance, state: str) -> None:
    """The instance does what it can do in this state and in no other."""
    if state == "instantiated":
        assert instance.call("fmi2EnterInitializationMode") == OK
    elif state == "initialization":
        assert instance.call("fmi2ExitInitializationMode") == OK
    elif state == "step complete":
        assert instance.step(0.0, 1e-5) == OK
    elif state == "event mode":
        assert instance.call("fmi2EnterContinuousTimeMode") == OK
    elif state == "continuous-time mode":
        instance.event()
    else:
        assert instance.step(0.0, 1e-5) == ERROR
        instance.get("F_t")


def test_the_table_has_every_function() -> None:
    assert all(set(table) == set(SIGNATURES) for table in TABLES.values())


@pytest.mark.parametrize(("kind", "function", "state", "legal"), CASES)
def test_call_in_state(
    new_instance: Callable[..., Instance], kind: int, function: str, state: str, legal: bool
) -> None:
    instance = new_instance(kind=kind)
    instance.bring_to(state)
    arguments = good_arguments(instance, function)
    before = instance.fingerprint()
    instance.messages.clear()
    status = instance.call(function, *arguments)
    if legal and function not in ALWAYS_REFUSED:
        assert status == OK, instance.messages
        assert not [message for message in instance.messages if message.status == ERROR]
        return
    assert status == ERROR
    assert len(instance.messages) == 1
    assert instance.last_message.category == "logStatusError"
    assert instance.last_message.status == ERROR
    assert instance.last_message.text.startswith(f"{function}: ")
    if "x" not in TABLES[kind][function] and function != "fmi2CancelStep":
        assert f"this instance is for {NAMES[kind]}" in instance.last_message.text
    elif function != "fmi2CancelStep":
        assert ("not allowed in state" in instance.last_message.text) == (not legal)
    assert instance.fingerprint() == before
    assert_usable(instance, state)


def test_a_refusal_names_the_state_and_the_allowed_ones(instance: Instance) -> None:
    instance.bring_to("step complete")
    instance.call("fmi2SetupExperiment", 0, 0.0, 0.0, 0, 0.0)
    assert (
        instance.last_message.text
        == "fmi2SetupExperiment: not allowed in state 'step complete', only in: instantiated"
    )
    instance.call("fmi2ExitInitializationMode")
    assert instance.last_message.text.endswith("only in: initialization mode")
    instance.call("fmi2SetTime", 0.0)
    assert (
        instance.last_message.text
        == "fmi2SetTime: belongs to model exchange; this instance is for co-simulation"
    )


def test_a_refusal_names_the_states_of_its_own_interface(new_instance: Callable[..., Instance]) -> None:
    instance = new_instance(kind=MODEL_EXCHANGE)
    assert instance.call("fmi2Terminate") == ERROR
    assert instance.last_message.text == (
        "fmi2Terminate: not allowed in state 'instantiated', only in: event mode, continuous-time mode"
    )
    assert instance.call("fmi2DoStep", 0.0, 1e-5, 1) == ERROR
    assert (
        instance.last_message.text
        == "fmi2DoStep: belongs to co-simulation; this instance is for model exchange"
    )


def test_a_state_of_the_other_interface_is_refused(new_instance: Callable[..., Instance]) -> None:
    stepped, exchanged = new_instance(), new_instance(kind=MODEL_EXCHANGE)
    state = stepped.save()
    before = exchanged.fingerprint()
    assert exchanged.restore(state) == ERROR
    assert "one of co-simulation; this instance is for model exchange" in exchanged.last_message.text
    assert exchanged.fingerprint() == before
    assert stepped.drop(state) == OK


@pytest.mark.parametrize("function", sorted(SIGNATURES))
def test_no_instance_is_an_error_and_no_crash(library: Library, instance: Instance, function: str) -> None:
    instance.bring_to("step complete")
    arguments = good_arguments(instance, function)
    assert getattr(library.dll, function)(None, *arguments) == ERROR


def test_functions_without_an_instance(library: Library) -> None:
    assert library.dll.fmi2GetVersion() == b"2.0"
    assert library.dll.fmi2GetTypesPlatform() == b"default"
    library.dll.fmi2FreeInstance(None)


@pytest.mark.parametrize(("kind", "state"), PLACES)
def test_free_in_every_state(new_instance: Callable[..., Instance], kind: int, state: str) -> None:
    instance = new_instance(kind=kind)
    instance.bring_to(state)
    instance.free()
    assert not [message for message in instance.messages if message.status == ERROR]


@pytest.mark.parametrize(("kind", "state"), PLACES)
def test_reset_gives_a_fresh_instance(new_instance: Callable[..., Instance], kind: int, state: str) -> None:
    used = new_instance(kind=kind)
    assert used.set({"V": 0.3, "contact.R": 2e-6, "solver.tolerance": 1e-8}) == OK
    assert used.choose({"contact.model": 2}) == OK
    used.bring_to(state)
    if state == "step complete":
        assert used.step(0.0, 1e-4) == OK
    assert used.call("fmi2Reset") == OK
    assert used.fingerprint() == new_instance(kind=kind).fingerprint()


def test_a_saved_state_carries_the_place_in_the_call_order(instance: Instance) -> None:
    instance.bring_to("step complete")
    between_steps: c_void_p = instance.save()
    assert instance.call("fmi2Terminate") == OK
    assert instance.step(0.0, 1e-5) == ERROR
    assert instance.restore(between_steps) == OK
    assert instance.step(0.0, 1e-5) == OK
    assert instance.drop(between_steps) == OK


CONTACT = ("stiffnessScale", "R_q", "R", "eta", "A_n", "nu", "Y", "c", "lambda")


@pytest.mark.parametrize("name", CONTACT)
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


def test_an_experiment_may_have_no_length(library: Library) -> None:
    with Instance(library) as instance:
        assert instance.call("fmi2SetupExperiment", 0, 0.0, 2.0, 1, 2.0) == OK
