"""Which function may be called in which state, after FMI 2.0, and arguments with which it then succeeds."""

from __future__ import annotations

import ctypes
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_size_t, c_void_p

from fmi_library import (
    CO_SIMULATION,
    LAST_SUCCESSFUL_TIME,
    MODEL_EXCHANGE,
    SIGNATURES,
    TERMINATED_STATUS,
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
    """With which the function succeeds wherever the call is legal."""
    state, signature = instance.save(), SIGNATURES[function]
    data = instance.serialize(state)
    kinds = {"GetReal": LAST_SUCCESSFUL_TIME, "GetBoolean": TERMINATED_STATUS, "GetString": 1}
    size = len(data) if "erialize" in function else 0
    known = {
        c_int: kinds.get(function[4:].removesuffix("Status"), 0),
        c_size_t: CONTINUOUS_STATES if signature == [POINTER(c_double), c_size_t] else size,
        c_double: 0.0,
        c_void_p: state,
        c_char_p: ctypes.create_string_buffer(data, len(data)),
        POINTER(c_void_p): byref(state),
    }
    return tuple(known[each] if each in known else (each._type_ * 8)() for each in signature)
