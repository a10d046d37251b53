// What both fuzzers share: instances of the FMU that they are linked with, and rules that hold after every call.
#ifndef FC_FUZZ_HOST_H
#define FC_FUZZ_HOST_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"
#include "fmi2_library.h"
#include "solver/solver.h"
#include "variable_reference.h"

#define STATE_SIZE_MOST 1024

typedef struct {
    size_t size;
    char bytes[STATE_SIZE_MOST];
} StateBytes;

// A rule that does not hold is a finding: the fuzzer keeps the input.
#define HOLD(rule, text)                                                                                     \
    do {                                                                                                     \
        if (!(rule)) {                                                                                       \
            fprintf(stderr, "%s:%d: broken: %s\n", __FILE__, __LINE__, text);                                \
            abort();                                                                                         \
        }                                                                                                    \
    } while (0)

static void instantiate_for(Fmi2Instance* instance, fmi2Type interface) {
    HOLD(fmi2_instance_make_for(instance, &fmi2_linked, interface, "fuzzed", fc_guid, NULL),
         "instantiation succeeds");
}

// What the FMU said since the last look: errors have a short message.
static long new_errors(Fmi2Instance* instance) {
    const long errors = instance->errors;
    HOLD(errors == 0 || (instance->said[0] && strlen(instance->said) < FMI2_TEXT - 1), "a message is short");
    instance->errors = 0;
    return errors;
}

// All that the instance will do depends on these bytes.
static StateBytes state_of(fmi2Component c) {
    StateBytes state = {0};
    fmi2FMUstate saved = NULL;
    HOLD(fmi2GetFMUstate(c, &saved) == fmi2OK, "a state can be saved");
    HOLD(fmi2SerializedFMUstateSize(c, saved, &state.size) == fmi2OK && state.size <= sizeof state.bytes,
         "its size is known");
    HOLD(fmi2SerializeFMUstate(c, saved, state.bytes, state.size) == fmi2OK, "it can be written");
    HOLD(fmi2FreeFMUstate(c, &saved) == fmi2OK && !saved, "it can be freed");
    return state;
}

static int same_state(const StateBytes* a, const StateBytes* b) {
    return a->size == b->size && memcmp(a->bytes, b->bytes, a->size) == 0;
}

// Whether a step is short work: the slow methods and moving inputs under vibration take a time in proportion to h.
// A step that is refused anyway is.
static inline int is_short_work(fmi2Component c, double h) {
    const fmi2ValueReference reals[] = {reference_of(offsetof(FcVariables, vibration.f)),
                                        reference_of(offsetof(FcVariables, vibration.V_1)),
                                        reference_of(offsetof(FcVariables, vibration.a_d)),
                                        reference_of(offsetof(FcVariables, solver.stepSize))};
    const fmi2ValueReference method_reference = reference_of(offsetof(FcVariables, solver.method));
    double value[4];
    int method;
    if (fmi2GetReal(c, reals, 4, value) != fmi2OK ||
        fmi2GetInteger(c, &method_reference, 1, &method) != fmi2OK) {
        return 1;
    }
    const int vibrates = value[1] != 0.0 || value[2] != 0.0;
    const double periods = vibrates ? h * value[0] : 0.0;
    if (method >= FC_METHOD_BACKWARD_EULER) {
        return !(h / value[3] > 200.0) && !(periods > 200.0);
    }
    return !(periods > (method == FC_METHOD_CVODE ? 0.25 : 3.0));
}

// Whether the variables can be read; if so, they are finite numbers.
static void check_reals(fmi2Component c, const fmi2ValueReference* vr, size_t count) {
    double value[64];
    if (fmi2GetReal(c, vr, count, value) != fmi2OK) {
        return; // not in this state, or the values set do not go together: the message says so
    }
    for (size_t i = 0; i < count; i++) {
        HOLD(isfinite(value[i]), fc_variables[vr[i]].name);
    }
}

static void check_outputs(fmi2Component c) {
    fmi2ValueReference vr[64];
    fmi2ValueReference rates[4];
    size_t count = 0, rate_count = 0;
    for (unsigned i = 0; i < fc_variables_count && count < 64; i++) {
        if (fc_variable_is_rate(&fc_variables[i])) {
            rates[rate_count++] = i;
        } else if (fc_variables[i].type == FC_TYPE_REAL) {
            vr[count++] = i;
        }
    }
    check_reals(c, vr, count);
    check_reals(c, rates, rate_count);
}

#endif
