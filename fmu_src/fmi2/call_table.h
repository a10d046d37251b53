// Which FMI function may be called in which state of an instance: the table of section 4.2.4 of FMI 2.0.
//
//     fmi2Instantiate -> INSTANTIATED -> INITIALIZATION_MODE -> STEP_COMPLETE -> TERMINATED
//                             ^                                   |      ^
//                             '---------- fmi2Reset --------------'      '-- fmi2DoStep
//
// A call that the table does not allow returns fmi2Error and changes nothing: the instance stays in its state
// and remains usable. The same holds for bad arguments, and for a step that can't be computed: the instance
// stays in STEP_COMPLETE at the time it had, so the host may correct the input and step again. Steps are
// synchronous and never discarded, so the states from STEP_IN_PROGRESS to STEP_CANCELED, FAILED (the
// standard's "error") and FATAL are columns of the table that no instance enters; that makes fmi2CancelStep
// an error always.
//
// The functions of model exchange are exported, since hosts look them up, and allowed in no state.
#ifndef FC_CALL_TABLE_H
#define FC_CALL_TABLE_H

#include <stddef.h>

typedef enum {
    START_END = 1 << 0, // no instance yet, or no more
    INSTANTIATED = 1 << 1,
    INITIALIZATION_MODE = 1 << 2,
    STEP_COMPLETE = 1 << 3, // slaveInitialized: between two steps
    STEP_IN_PROGRESS = 1 << 4,
    STEP_FAILED = 1 << 5,
    STEP_CANCELED = 1 << 6,
    TERMINATED = 1 << 7,
    FAILED = 1 << 8,
    FATAL = 1 << 9
} InstanceState;

typedef enum {
    CALL_GET_TYPES_PLATFORM,
    CALL_GET_VERSION,
    CALL_SET_DEBUG_LOGGING,
    CALL_INSTANTIATE,
    CALL_FREE_INSTANCE,
    CALL_SETUP_EXPERIMENT,
    CALL_ENTER_INITIALIZATION_MODE,
    CALL_EXIT_INITIALIZATION_MODE,
    CALL_TERMINATE,
    CALL_RESET,
    CALL_GET_REAL,
    CALL_GET_INTEGER,
    CALL_GET_BOOLEAN,
    CALL_GET_STRING,
    CALL_SET_REAL,
    CALL_SET_INTEGER,
    CALL_SET_BOOLEAN,
    CALL_SET_STRING,
    CALL_GET_FMU_STATE,
    CALL_SET_FMU_STATE,
    CALL_FREE_FMU_STATE,
    CALL_SERIALIZED_FMU_STATE_SIZE,
    CALL_SERIALIZE_FMU_STATE,
    CALL_DESERIALIZE_FMU_STATE,
    CALL_GET_DIRECTIONAL_DERIVATIVE,
    CALL_SET_REAL_INPUT_DERIVATIVES,
    CALL_GET_REAL_OUTPUT_DERIVATIVES,
    CALL_DO_STEP,
    CALL_CANCEL_STEP,
    CALL_GET_STATUS,
    CALL_GET_REAL_STATUS,
    CALL_GET_INTEGER_STATUS,
    CALL_GET_BOOLEAN_STATUS,
    CALL_GET_STRING_STATUS,
    CALL_ENTER_EVENT_MODE,
    CALL_NEW_DISCRETE_STATES,
    CALL_ENTER_CONTINUOUS_TIME_MODE,
    CALL_COMPLETED_INTEGRATOR_STEP,
    CALL_SET_TIME,
    CALL_SET_CONTINUOUS_STATES,
    CALL_GET_DERIVATIVES,
    CALL_GET_EVENT_INDICATORS,
    CALL_GET_CONTINUOUS_STATES,
    CALL_GET_NOMINALS_OF_CONTINUOUS_STATES,
    CALL_COUNT
} Call;

typedef struct {
    const char* function; // name in the FMI headers
    unsigned allowed;     // sum of InstanceState; 0 for model exchange
} CallRule;

extern const CallRule call_table[CALL_COUNT];

const char* call_state_name(InstanceState state);

// Writes the names of the states in the sum, separated by ", ", into text. Truncates when size is short.
void call_state_names(unsigned states, char* text, size_t size);

#endif
