#include "fmi2/call_table.h"

#include <stdio.h>

enum {
    A = FC_START_END,
    I = FC_INSTANTIATED,
    N = FC_INITIALIZATION_MODE,
    S = FC_STEP_COMPLETE,
    P = FC_STEP_IN_PROGRESS,
    X = FC_STEP_FAILED,
    C = FC_STEP_CANCELED,
    T = FC_TERMINATED,
    E = FC_FAILED
};

// clang-format off
const FcCallRule fc_call_table[FC_CALL_COUNT] = {
    [FC_CALL_GET_TYPES_PLATFORM]          = {"fmi2GetTypesPlatform",         A | I | N | S | P | X | C | T | E},
    [FC_CALL_GET_VERSION]                 = {"fmi2GetVersion",               A | I | N | S | P | X | C | T | E},
    [FC_CALL_SET_DEBUG_LOGGING]           = {"fmi2SetDebugLogging",              I | N | S | P | X | C | T | E},
    [FC_CALL_INSTANTIATE]                 = {"fmi2Instantiate",              A                                },
    [FC_CALL_FREE_INSTANCE]               = {"fmi2FreeInstance",                 I | N | S     | X | C | T | E},
    [FC_CALL_SETUP_EXPERIMENT]            = {"fmi2SetupExperiment",              I                            },
    [FC_CALL_ENTER_INITIALIZATION_MODE]   = {"fmi2EnterInitializationMode",      I                            },
    [FC_CALL_EXIT_INITIALIZATION_MODE]    = {"fmi2ExitInitializationMode",           N                        },
    [FC_CALL_TERMINATE]                   = {"fmi2Terminate",                            S     | X            },
    [FC_CALL_RESET]                       = {"fmi2Reset",                        I | N | S     | X | C | T | E},
    [FC_CALL_GET_REAL]                    = {"fmi2GetReal",                          N | S     | X | C | T | E},
    [FC_CALL_GET_INTEGER]                 = {"fmi2GetInteger",                       N | S     | X | C | T | E},
    [FC_CALL_GET_BOOLEAN]                 = {"fmi2GetBoolean",                       N | S     | X | C | T | E},
    [FC_CALL_GET_STRING]                  = {"fmi2GetString",                        N | S     | X | C | T | E},
    [FC_CALL_SET_REAL]                    = {"fmi2SetReal",                      I | N | S                    },
    [FC_CALL_SET_INTEGER]                 = {"fmi2SetInteger",                   I | N | S                    },
    [FC_CALL_SET_BOOLEAN]                 = {"fmi2SetBoolean",                   I | N | S                    },
    [FC_CALL_SET_STRING]                  = {"fmi2SetString",                    I | N | S                    },
    [FC_CALL_GET_FMU_STATE]               = {"fmi2GetFMUstate",                  I | N | S     | X | C | T | E},
    [FC_CALL_SET_FMU_STATE]               = {"fmi2SetFMUstate",                  I | N | S     | X | C | T | E},
    [FC_CALL_FREE_FMU_STATE]              = {"fmi2FreeFMUstate",                 I | N | S     | X | C | T | E},
    [FC_CALL_SERIALIZED_FMU_STATE_SIZE]   = {"fmi2SerializedFMUstateSize",       I | N | S     | X | C | T | E},
    [FC_CALL_SERIALIZE_FMU_STATE]         = {"fmi2SerializeFMUstate",            I | N | S     | X | C | T | E},
    [FC_CALL_DESERIALIZE_FMU_STATE]       = {"fmi2DeSerializeFMUstate",          I | N | S     | X | C | T | E},
    [FC_CALL_GET_DIRECTIONAL_DERIVATIVE]  = {"fmi2GetDirectionalDerivative",         N | S     | X | C | T | E},
    [FC_CALL_SET_REAL_INPUT_DERIVATIVES]  = {"fmi2SetRealInputDerivatives",      I | N | S                    },
    [FC_CALL_GET_REAL_OUTPUT_DERIVATIVES] = {"fmi2GetRealOutputDerivatives",             S     | X | C | T | E},
    [FC_CALL_DO_STEP]                     = {"fmi2DoStep",                               S                    },
    [FC_CALL_CANCEL_STEP]                 = {"fmi2CancelStep",                               P                },
    [FC_CALL_GET_STATUS]                  = {"fmi2GetStatus",                            S | P | X     | T    },
    [FC_CALL_GET_REAL_STATUS]             = {"fmi2GetRealStatus",                        S | P | X     | T    },
    [FC_CALL_GET_INTEGER_STATUS]          = {"fmi2GetIntegerStatus",                     S | P | X     | T    },
    [FC_CALL_GET_BOOLEAN_STATUS]          = {"fmi2GetBooleanStatus",                     S | P | X     | T    },
    [FC_CALL_GET_STRING_STATUS]           = {"fmi2GetStringStatus",                      S | P | X     | T    },
    [FC_CALL_ENTER_EVENT_MODE]                       = {"fmi2EnterEventMode", 0},
    [FC_CALL_NEW_DISCRETE_STATES]                    = {"fmi2NewDiscreteStates", 0},
    [FC_CALL_ENTER_CONTINUOUS_TIME_MODE]             = {"fmi2EnterContinuousTimeMode", 0},
    [FC_CALL_COMPLETED_INTEGRATOR_STEP]              = {"fmi2CompletedIntegratorStep", 0},
    [FC_CALL_SET_TIME]                               = {"fmi2SetTime", 0},
    [FC_CALL_SET_CONTINUOUS_STATES]                  = {"fmi2SetContinuousStates", 0},
    [FC_CALL_GET_DERIVATIVES]                        = {"fmi2GetDerivatives", 0},
    [FC_CALL_GET_EVENT_INDICATORS]                   = {"fmi2GetEventIndicators", 0},
    [FC_CALL_GET_CONTINUOUS_STATES]                  = {"fmi2GetContinuousStates", 0},
    [FC_CALL_GET_NOMINALS_OF_CONTINUOUS_STATES]      = {"fmi2GetNominalsOfContinuousStates", 0},
};
// clang-format on

const char* fc_mode_name(FcMode state) {
    switch (state) {
    case FC_START_END:
        return "start/end";
    case FC_INSTANTIATED:
        return "instantiated";
    case FC_INITIALIZATION_MODE:
        return "initialization mode";
    case FC_STEP_COMPLETE:
        return "step complete";
    case FC_STEP_IN_PROGRESS:
        return "step in progress";
    case FC_STEP_FAILED:
        return "step failed";
    case FC_STEP_CANCELED:
        return "step canceled";
    case FC_TERMINATED:
        return "terminated";
    case FC_FAILED:
        return "error";
    case FC_FATAL:
        return "fatal";
    }
    return "unknown";
}

void fc_mode_names(unsigned states, char* text, size_t size) {
    size_t length = 0;
    text[0] = '\0';
    for (unsigned state = FC_START_END; state <= FC_FATAL && length < size; state <<= 1) {
        if (states & state) {
            const int written = snprintf(text + length, size - length, "%s%s", length > 0 ? ", " : "",
                                         fc_mode_name((FcMode)state));
            length += (size_t)written;
        }
    }
}
