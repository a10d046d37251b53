"""Which function may be called in which state: every function in every state that an instance can be in."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from ctypes import byref, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p

import pytest
from fmi_library import ERROR, LAST_SUCCESSFUL_TIME, OK, SIGNATURES, TERMINATED_STATUS, Instance, Library

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
STATES = ["instantiated", "initialization", "step complete", "terminated"]
ROWS = {line.split()[0]: line.split()[1:] for line in TABLE.strip().splitlines()[1:]}
CASES = [
    pytest.param(function, state, cell == "x", id=f"{function}-{state.replace(' ', '_')}")
    for function, cells in ROWS.items()
    for state, cell in zip(STATES, cells, strict=True)
]

MODEL_EXCHANGE = set(list(ROWS)[list(ROWS).index("fmi2EnterEventMode") :])

# Legal in their state, but without an answer in a slave that never leaves a step pending.
ALWAYS_REFUSED = {"fmi2GetStatus", "fmi2GetIntegerStatus", "fmi2GetStringStatus"}


def good_arguments(instance: Instance, function: str) -> tuple[object, ...]:
    """Arguments with which the function succeeds wherever the call is legal."""
    real = (c_double * 1)(0.01)
    one_input = (c_uint * 1)(instance.library.variables["V"].reference)
    one_output = (c_uint * 1)(instance.library.variables["F_t"].reference)
    tunable = (c_uint * 1)(instance.library.variables["F_C"].reference)
    if function.startswith(("fmi2GetFMU", "fmi2SetFMU", "fmi2FreeFMU", "fmi2Serialize", "fmi2DeSerialize")):
        return state_arguments(instance, function)
    arguments: dict[str, tuple[object, ...]] = {
        "fmi2SetDebugLogging": (0, 0, None),
        "fmi2SetupExperiment": (0, 0.0, 0.0, 0, 0.0),
        "fmi2GetReal": (one_output, 1, (c_double * 1)()),
        "fmi2SetReal": (tunable, 1, (c_double * 1)(50.0)),
        "fmi2GetDirectionalDerivative": (one_output, 1, one_input, 1, real, (c_double * 1)()),
        "fmi2SetRealInputDerivatives": (one_input, 1, (c_int * 1)(1), real),
        "fmi2GetRealOutputDerivatives": (one_output, 1, (c_int * 1)(1), (c_double * 1)()),
        "fmi2DoStep": (0.0, 1e-5, 1),
        "fmi2GetStatus": (0, (c_int * 1)()),
        "fmi2GetRealStatus": (LAST_SUCCESSFUL_TIME, (c_double * 1)()),
        "fmi2GetIntegerStatus": (0, (c_int * 1)()),
        "fmi2GetBooleanStatus": (TERMINATED_STATUS, (c_int * 1)()),
        "fmi2GetStringStatus": (1, (c_char_p * 1)()),
        "fmi2NewDiscreteStates": (None,),
        "fmi2CompletedIntegratorStep": (1, (c_int * 1)(), (c_int * 1)()),
        "fmi2SetTime": (0.0,),
        "fmi2SetContinuousStates": (real, 1),
        "fmi2GetDerivatives": (real, 1),
        "fmi2GetEventIndicators": (real, 1),
        "fmi2GetContinuousStates": (real, 1),
        "fmi2GetNominalsOfContinuousStates": (real, 1),
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
    else:
        assert instance.step(0.0, 1e-5) == ERROR
        instance.get("F_t")


def test_the_table_has_every_function() -> None:
    assert set(ROWS) == set(SIGNATURES)


@pytest.mark.parametrize(("function", "state", "legal"), CASES)
def test_call_in_state(instance: Instance, function: str, state: str, legal: bool) -> None:
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
    if function in MODEL_EXCHANGE:
        assert "model exchange" in instance.last_message.text
    else:
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
    assert "model exchange" in instance.last_message.text


@pytest.mark.parametrize("function", sorted(SIGNATURES))
def test_no_instance_is_an_error_and_no_crash(library: Library, instance: Instance, function: str) -> None:
    instance.bring_to("step complete")
    arguments = good_arguments(instance, function)
    assert getattr(library.dll, function)(None, *arguments) == ERROR


def test_functions_without_an_instance(library: Library) -> None:
    assert library.dll.fmi2GetVersion() == b"2.0"
    assert library.dll.fmi2GetTypesPlatform() == b"default"
    library.dll.fmi2FreeInstance(None)


@pytest.mark.parametrize("state", STATES)
def test_free_in_every_state(instance: Instance, state: str) -> None:
    instance.bring_to(state)
    instance.free()
    assert not [message for message in instance.messages if message.status == ERROR]


@pytest.mark.parametrize("state", STATES)
def test_reset_gives_a_fresh_instance(new_instance: Callable[..., Instance], state: str) -> None:
    used = new_instance()
    assert used.set({"V": 0.3, "contact.R": 2e-6, "solver.tolerance": 1e-8}) == OK
    assert used.choose({"contact.model": 2}) == OK
    used.bring_to(state)
    if state == "step complete":
        assert used.step(0.0, 1e-4) == OK
    assert used.call("fmi2Reset") == OK
    assert used.fingerprint() == new_instance().fingerprint()


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
