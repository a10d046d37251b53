"""Which function may be called in which state, after FMI 2.0, and arguments with which it then succeeds."""

from __future__ import annotations

import ctypes
from ctypes import byref, c_char_p, c_double, c_int, c_size_t, c_uint

from fmi_library import (
    CO_SIMULATION,
    INDICATORS,
    LAST_SUCCESSFUL_TIME,
    MODEL_EXCHANGE,
    TERMINATED_STATUS,
    EventInfo,
    Instance,
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


STATES = {
    CO_SIMULATION: ["instantiated", "initialization", "step complete", "terminated"],
    MODEL_EXCHANGE: ["instantiated", "initialization", "event mode", "continuous-time mode", "terminated"],
}
# Legal in their state, but without an answer in a slave that never leaves a step pending.
ALWAYS_REFUSED = {"fmi2GetStatus", "fmi2GetIntegerStatus", "fmi2GetStringStatus"}


def allowed(kind: int) -> dict[str, set[str]]:
    """The states in which each function may be called, and is answered."""
    table = TABLE if kind == CO_SIMULATION else MODEL_EXCHANGE_TABLE
    found = {}
    for line in table.strip().splitlines()[1:]:
        function, *cells = line.split()
        states = {state for state, cell in zip(STATES[kind], cells, strict=True) if cell == "x"}
        found[function] = set() if function in ALWAYS_REFUSED else states
    return found


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
    if function.endswith(("Integer", "Boolean", "String")):
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
