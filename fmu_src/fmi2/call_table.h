// The state machine of an instance, which FMI function may be called in which state: the tables of sections 3.2.3 and 4.2.4 of
// FMI 2.0.
//
//                                                  .-> FC_STEP_COMPLETE <-> fmi2DoStep ----------------.
//     fmi2Instantiate -> INSTANTIATED -> INITIALIZATION_MODE                                   -> TERMINATED
//                             ^                    '-> FC_EVENT_MODE <-> FC_CONTINUOUS_TIME_MODE --'
//                             '---- fmi2Reset
//
// The upper way is that of an instance for co-simulation, the lower one for model exchange. A function of the other
// interface is allowed in no state.
//
// A call that the table does not allow returns fmi2Error and changes nothing: the instance stays in its state
// and remains usable. The same holds for bad arguments, and for a step that can't be computed: the instance
// stays in FC_STEP_COMPLETE at the time it had, so the host may correct the input and step again. Steps are
// synchronous and never discarded, so the states from FC_STEP_IN_PROGRESS to FC_STEP_CANCELED, FAILED (the
// standard's "error") and FATAL are columns of the table that no instance enters. So fmi2CancelStep is always
// an error.
#ifndef FC_FMI2_CALL_TABLE_H
#define FC_FMI2_CALL_TABLE_H

#include <stddef.h>

// One bit each, so that the states in which a call is legal are a sum.
typedef enum {
    FC_START_END = 1 << 0, // no instance yet, or no more
    FC_INSTANTIATED = 1 << 1,
    FC_INITIALIZATION_MODE = 1 << 2,
    FC_STEP_COMPLETE = 1 << 3, // slaveInitialized: between two steps
    FC_STEP_IN_PROGRESS = 1 << 4,
    FC_STEP_FAILED = 1 << 5,
    FC_STEP_CANCELED = 1 << 6,
    FC_TERMINATED = 1 << 7,
    FC_FAILED = 1 << 8,
    FC_FATAL = 1 << 9,
    FC_EVENT_MODE = 1 << 10,
    FC_CONTINUOUS_TIME_MODE = 1 << 11
} FcMode;

// Which interface an instance was made for; one bit each, for the same reason.
typedef enum { FC_MODEL_EXCHANGE = 1 << 0, FC_CO_SIMULATION = 1 << 1 } FcInterface;

typedef enum {
    FC_CALL_GET_TYPES_PLATFORM,
    FC_CALL_GET_VERSION,
    FC_CALL_SET_DEBUG_LOGGING,
    FC_CALL_INSTANTIATE,
    FC_CALL_FREE_INSTANCE,
    FC_CALL_SETUP_EXPERIMENT,
    FC_CALL_ENTER_INITIALIZATION_MODE,
    FC_CALL_EXIT_INITIALIZATION_MODE,
    FC_CALL_TERMINATE,
    FC_CALL_RESET,
    FC_CALL_GET_REAL,
    FC_CALL_GET_INTEGER,
    FC_CALL_GET_BOOLEAN,
    FC_CALL_GET_STRING,
    FC_CALL_SET_REAL,
    FC_CALL_SET_INTEGER,
    FC_CALL_SET_BOOLEAN,
    FC_CALL_SET_STRING,
    FC_CALL_GET_FMU_STATE,
    FC_CALL_SET_FMU_STATE,
    FC_CALL_FREE_FMU_STATE,
    FC_CALL_SERIALIZED_FMU_STATE_SIZE,
    FC_CALL_SERIALIZE_FMU_STATE,
    FC_CALL_DESERIALIZE_FMU_STATE,
    FC_CALL_GET_DIRECTIONAL_DERIVATIVE,
    FC_CALL_SET_REAL_INPUT_DERIVATIVES,
    FC_CALL_GET_REAL_OUTPUT_DERIVATIVES,
    FC_CALL_DO_STEP,
    FC_CALL_CANCEL_STEP,
    FC_CALL_GET_STATUS,
    FC_CALL_GET_REAL_STATUS,
    FC_CALL_GET_INTEGER_STATUS,
    FC_CALL_GET_BOOLEAN_STATUS,
    FC_CALL_GET_STRING_STATUS,
    FC_CALL_ENTER_EVENT_MODE,
    FC_CALL_NEW_DISCRETE_STATES,
    FC_CALL_ENTER_CONTINUOUS_TIME_MODE,
    FC_CALL_COMPLETED_INTEGRATOR_STEP,
    FC_CALL_SET_TIME,
    FC_CALL_SET_CONTINUOUS_STATES,
    FC_CALL_GET_DERIVATIVES,
    FC_CALL_GET_EVENT_INDICATORS,
    FC_CALL_GET_CONTINUOUS_STATES,
    FC_CALL_GET_NOMINALS_OF_CONTINUOUS_STATES,
    FC_CALL_COUNT
} FcCall;

typedef struct {
    const char* function; // name in the FMI headers
    unsigned interfaces;  // sum of FcInterface
    unsigned allowed;     // sum of FcMode
} FcCallRule;

extern const FcCallRule fc_call_table[FC_CALL_COUNT];

const char* fc_mode_name(FcMode state);
const char* fc_interface_name(FcInterface of);

// Writes the names of the states in the sum that an instance of the interface can be in, separated by ", ", into
// text. Truncates when size is short.
void fc_mode_names(unsigned states, FcInterface of, char* text, size_t size);

#endif
