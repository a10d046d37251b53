#include "fmi2/call_table.h"

#include <stdio.h>

// Short names for the table below: its columns, and the interfaces.
enum {
    A = FC_START_END,
    I = FC_INSTANTIATED,
    N = FC_INITIALIZATION_MODE,
    S = FC_STEP_COMPLETE,
    P = FC_STEP_IN_PROGRESS,
    X = FC_STEP_FAILED,
    C = FC_STEP_CANCELED,
    V = FC_EVENT_MODE,
    Y = FC_CONTINUOUS_TIME_MODE,
    T = FC_TERMINATED,
    E = FC_FAILED,

    ME = FC_MODEL_EXCHANGE,
    CS = FC_CO_SIMULATION,
    BOTH = ME | CS
};

// clang-format off
const FcCallRule fc_call_table[FC_CALL_COUNT] = {
    [FC_CALL_GET_TYPES_PLATFORM]                  = {"fmi2GetTypesPlatform",              BOTH,   A | I | N | S | P | X | C | V | Y | T | E},
    [FC_CALL_GET_VERSION]                         = {"fmi2GetVersion",                    BOTH,   A | I | N | S | P | X | C | V | Y | T | E},
    [FC_CALL_SET_DEBUG_LOGGING]                   = {"fmi2SetDebugLogging",               BOTH,       I | N | S | P | X | C | V | Y | T | E},
    [FC_CALL_INSTANTIATE]                         = {"fmi2Instantiate",                   BOTH,   A                                       },
    [FC_CALL_FREE_INSTANCE]                       = {"fmi2FreeInstance",                  BOTH,       I | N | S     | X | C | V | Y | T | E},
    [FC_CALL_SETUP_EXPERIMENT]                    = {"fmi2SetupExperiment",               BOTH,       I                                   },
    [FC_CALL_ENTER_INITIALIZATION_MODE]           = {"fmi2EnterInitializationMode",       BOTH,       I                                   },
    [FC_CALL_EXIT_INITIALIZATION_MODE]            = {"fmi2ExitInitializationMode",        BOTH,           N                               },
    [FC_CALL_TERMINATE]                           = {"fmi2Terminate",                     BOTH,               S     | X     | V | Y       },
    [FC_CALL_RESET]                               = {"fmi2Reset",                         BOTH,       I | N | S     | X | C | V | Y | T | E},
    [FC_CALL_GET_REAL]                            = {"fmi2GetReal",                       BOTH,           N | S     | X | C | V | Y | T | E},
    [FC_CALL_GET_INTEGER]                         = {"fmi2GetInteger",                    BOTH,           N | S     | X | C | V | Y | T | E},
    [FC_CALL_GET_BOOLEAN]                         = {"fmi2GetBoolean",                    BOTH,           N | S     | X | C | V | Y | T | E},
    [FC_CALL_GET_STRING]                          = {"fmi2GetString",                     BOTH,           N | S     | X | C | V | Y | T | E},
    [FC_CALL_SET_REAL]                            = {"fmi2SetReal",                       BOTH,       I | N | S             | V | Y       },
    [FC_CALL_SET_INTEGER]                         = {"fmi2SetInteger",                    BOTH,       I | N | S             | V           },
    [FC_CALL_SET_BOOLEAN]                         = {"fmi2SetBoolean",                    BOTH,       I | N | S             | V           },
    [FC_CALL_SET_STRING]                          = {"fmi2SetString",                     BOTH,       I | N | S             | V           },
    [FC_CALL_GET_FMU_STATE]                       = {"fmi2GetFMUstate",                   BOTH,       I | N | S     | X | C | V | Y | T | E},
    [FC_CALL_SET_FMU_STATE]                       = {"fmi2SetFMUstate",                   BOTH,       I | N | S     | X | C | V | Y | T | E},
    [FC_CALL_FREE_FMU_STATE]                      = {"fmi2FreeFMUstate",                  BOTH,       I | N | S     | X | C | V | Y | T | E},
    [FC_CALL_SERIALIZED_FMU_STATE_SIZE]           = {"fmi2SerializedFMUstateSize",        BOTH,       I | N | S     | X | C | V | Y | T | E},
    [FC_CALL_SERIALIZE_FMU_STATE]                 = {"fmi2SerializeFMUstate",             BOTH,       I | N | S     | X | C | V | Y | T | E},
    [FC_CALL_DESERIALIZE_FMU_STATE]               = {"fmi2DeSerializeFMUstate",           BOTH,       I | N | S     | X | C | V | Y | T | E},
    [FC_CALL_GET_DIRECTIONAL_DERIVATIVE]          = {"fmi2GetDirectionalDerivative",      BOTH,           N | S     | X | C | V | Y | T | E},
    [FC_CALL_SET_REAL_INPUT_DERIVATIVES]          = {"fmi2SetRealInputDerivatives",       CS,         I | N | S                           },
    [FC_CALL_GET_REAL_OUTPUT_DERIVATIVES]         = {"fmi2GetRealOutputDerivatives",      CS,                 S     | X | C         | T | E},
    [FC_CALL_DO_STEP]                             = {"fmi2DoStep",                        CS,                 S                           },
    [FC_CALL_CANCEL_STEP]                         = {"fmi2CancelStep",                    CS,                     P                       },
    [FC_CALL_GET_STATUS]                          = {"fmi2GetStatus",                     CS,                 S | P | X             | T   },
    [FC_CALL_GET_REAL_STATUS]                     = {"fmi2GetRealStatus",                 CS,                 S | P | X             | T   },
    [FC_CALL_GET_INTEGER_STATUS]                  = {"fmi2GetIntegerStatus",              CS,                 S | P | X             | T   },
    [FC_CALL_GET_BOOLEAN_STATUS]                  = {"fmi2GetBooleanStatus",              CS,                 S | P | X             | T   },
    [FC_CALL_GET_STRING_STATUS]                   = {"fmi2GetStringStatus",               CS,                 S | P | X             | T   },
    [FC_CALL_ENTER_EVENT_MODE]                    = {"fmi2EnterEventMode",                ME,                                 V | Y       },
    [FC_CALL_NEW_DISCRETE_STATES]                 = {"fmi2NewDiscreteStates",             ME,                                 V           },
    [FC_CALL_ENTER_CONTINUOUS_TIME_MODE]          = {"fmi2EnterContinuousTimeMode",       ME,                                 V           },
    [FC_CALL_COMPLETED_INTEGRATOR_STEP]           = {"fmi2CompletedIntegratorStep",       ME,                                     Y       },
    [FC_CALL_SET_TIME]                            = {"fmi2SetTime",                       ME,                                 V | Y       },
    [FC_CALL_SET_CONTINUOUS_STATES]               = {"fmi2SetContinuousStates",           ME,                                     Y       },
    [FC_CALL_GET_DERIVATIVES]                     = {"fmi2GetDerivatives",                ME,                                 V | Y | T | E},
    [FC_CALL_GET_EVENT_INDICATORS]                = {"fmi2GetEventIndicators",            ME,             N                 | V | Y | T | E},
    [FC_CALL_GET_CONTINUOUS_STATES]               = {"fmi2GetContinuousStates",           ME,             N                 | V | Y | T | E},
    [FC_CALL_GET_NOMINALS_OF_CONTINUOUS_STATES]   = {"fmi2GetNominalsOfContinuousStates", ME,         I                     | V | Y | T | E},
};
// clang-format on

// In the order of the bits of FcMode.
static const char* const MODE_NAME[] = {
    "start/end",   "instantiated",         "initialization mode", "step complete", "step in progress",
    "step failed", "step canceled",        "terminated",          "error",         "fatal",
    "event mode",  "continuous-time mode",
};

const char* fc_mode_name(FcMode state) {
    int i = 0;
    while ((unsigned)state >> i > 1) {
        i++;
    }
    return MODE_NAME[i];
}

const char* fc_interface_name(FcInterface of) {
    return of == FC_MODEL_EXCHANGE ? "model exchange" : "co-simulation";
}

void fc_mode_names(unsigned states, FcInterface of, char* text, size_t size) {
    const unsigned foreign = of == FC_MODEL_EXCHANGE ? S | P | X | C : V | Y;
    size_t length = 0;
    text[0] = '\0';
    for (unsigned state = FC_START_END; state <= FC_CONTINUOUS_TIME_MODE && length < size; state <<= 1) {
        if (states & ~foreign & state) {
            const int written = snprintf(text + length, size - length, "%s%s", length > 0 ? ", " : "",
                                         fc_mode_name((FcMode)state));
            length += (size_t)written;
        }
    }
}
