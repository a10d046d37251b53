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

STATES = {
    CO_SIMULATION: ["instantiated", "initialization", "step complete", "terminated"],
    MODEL_EXCHANGE: ["instantiated", "initialization", "event mode", "continuous-time mode", "terminated"],
}
# FMI 2.0, section 4.2.4: the states that a synchronous slave without fmi2Discard can be in, x: may be called.
_STEPPED = {
    "xxxx": """SetDebugLogging Reset GetFMUstate SetFMUstate FreeFMUstate SerializedFMUstateSize
        SerializeFMUstate DeSerializeFMUstate""",
    "x---": "SetupExperiment EnterInitializationMode",
    "-x--": "ExitInitializationMode",
    "--x-": "Terminate DoStep",
    "-xxx": "GetReal GetInteger GetBoolean GetString GetDirectionalDerivative",
    "xxx-": "SetReal SetInteger SetBoolean SetString SetRealInputDerivatives",
    "--xx": """GetRealOutputDerivatives GetStatus GetRealStatus GetIntegerStatus GetBooleanStatus
        GetStringStatus""",
    "----": """CancelStep EnterEventMode NewDiscreteStates EnterContinuousTimeMode
        CompletedIntegratorStep SetTime SetContinuousStates GetDerivatives
        GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates""",
}
# Section 3.2.3.
_EXCHANGED = {
    "xxxxx": """SetDebugLogging Reset GetFMUstate SetFMUstate FreeFMUstate SerializedFMUstateSize
        SerializeFMUstate DeSerializeFMUstate""",
    "x----": "SetupExperiment EnterInitializationMode",
    "-x---": "ExitInitializationMode",
    "--xx-": "Terminate EnterEventMode SetTime",
    "-xxxx": """GetReal GetInteger GetBoolean GetString GetDirectionalDerivative GetEventIndicators
        GetContinuousStates""",
    "xxxx-": "SetReal",
    "xxx--": "SetInteger SetBoolean SetString",
    "-----": """SetRealInputDerivatives GetRealOutputDerivatives DoStep CancelStep GetStatus
        GetRealStatus GetIntegerStatus GetBooleanStatus GetStringStatus""",
    "--x--": "NewDiscreteStates EnterContinuousTimeMode",
    "---x-": "CompletedIntegratorStep SetContinuousStates",
    "--xxx": "GetDerivatives",
    "x-xxx": "GetNominalsOfContinuousStates",
}
TABLE = {
    kind: {f"fmi2{name}": cells for cells, names in table.items() for name in names.split()}
    for kind, table in ((CO_SIMULATION, _STEPPED), (MODEL_EXCHANGE, _EXCHANGED))
}
# Legal in their state, but without an answer in a slave that never leaves a step pending.
ALWAYS_REFUSED = {"fmi2GetStatus", "fmi2GetIntegerStatus", "fmi2GetStringStatus"}


def allowed(kind: int) -> dict[str, set[str]]:
    """The states in which each function may be called, and is answered."""
    return {
        function: {state for state, cell in zip(STATES[kind], cells, strict=True) if cell == "x"}
        if function not in ALWAYS_REFUSED
        else set()
        for function, cells in TABLE[kind].items()
    }


def good_arguments(instance: Instance, function: str) -> tuple[object, ...]:
    """Arguments with which the function succeeds wherever the call is legal."""
    real = (c_double * 1)(0.01)
    one_input = (c_uint * 1)(instance.library.variables["V"].valueReference)
    one_output = (c_uint * 1)(instance.library.variables["F_t"].valueReference)
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
