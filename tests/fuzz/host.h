// What the fuzzers and the watchdog share: instances of the FMU that they are linked with, calls, and rules that hold after them.
//
// The watchdog has its own CALL, around each call of the FMU, and its own HOLD.
#ifndef FC_FUZZ_HOST_H
#define FC_FUZZ_HOST_H

#include <math.h>
#include <stdbool.h>
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
enum { STATES = 4, INDICATORS = 4, REALS_MOST = 64 };

typedef struct {
    size_t size;
    char bytes[STATE_SIZE_MOST];
} StateBytes;

#ifndef CALL
#define CALL(call) (call)
// A rule that does not hold is a finding: the fuzzer keeps the input.
#define HOLD(rule, text)                                                                                     \
    do {                                                                                                     \
        if (!(rule)) {                                                                                       \
            fprintf(stderr, "%s:%d: broken: %s\n", __FILE__, __LINE__, text);                                \
            abort();                                                                                         \
        }                                                                                                    \
    } while (0)
#endif

static inline void instantiate_for(Fmi2Instance* instance, fmi2Type interface) {
    HOLD(fmi2_instance_make_for(instance, &fmi2_linked, interface, "fuzzed", fc_guid, NULL),
         "instantiation succeeds");
}

// What the FMU said since the last look: errors have a short message.
static inline long new_errors(Fmi2Instance* instance) {
    const long errors = instance->errors;
    HOLD(errors == 0 || (instance->said[0] && strlen(instance->said) < FMI2_TEXT - 1), "a message is short");
    instance->errors = 0;
    return errors;
}

// All that the instance will do depends on these bytes.
static inline StateBytes state_of(fmi2Component c) {
    StateBytes state = {0};
    fmi2FMUstate saved = NULL;
    HOLD(CALL(fmi2GetFMUstate(c, &saved)) == fmi2OK, "a state can be saved");
    HOLD(CALL(fmi2SerializedFMUstateSize(c, saved, &state.size)) == fmi2OK &&
             state.size <= sizeof state.bytes,
         "its size is known");
    HOLD(CALL(fmi2SerializeFMUstate(c, saved, state.bytes, state.size)) == fmi2OK, "it can be written");
    HOLD(CALL(fmi2FreeFMUstate(c, &saved)) == fmi2OK && !saved, "it can be freed");
    return state;
}

static inline int same_state(const StateBytes* a, const StateBytes* b) {
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

static inline void check_finite(const double* value, size_t count, const char* what) {
    for (size_t i = 0; i < count; i++) {
        HOLD(isfinite(value[i]), what);
    }
}

// ---- kinds of variables ----

typedef bool Chosen(const FcVariableInfo* info);

static inline bool is_plain(const FcVariableInfo* info) {
    return info->type == FC_TYPE_REAL && !fc_variable_is_rate(info) && !fc_variable_is_settled_force(info);
}

static inline bool is_computed(const FcVariableInfo* info) {
    const bool is_output = info->causality == FC_CAUSALITY_OUTPUT || info->causality == FC_CAUSALITY_LOCAL;
    return is_plain(info) && is_output && info->offset != offsetof(FcVariables, solver.evaluations);
}

static inline size_t choose_reals(Chosen* is, fmi2ValueReference vr[REALS_MOST]) {
    size_t count = 0;
    for (unsigned i = 0; i < fc_variables_count && count < REALS_MOST; i++) {
        vr[count] = i;
        count += is(&fc_variables[i]);
    }
    return count;
}

// ---- calls and what holds after them ----

// Some may not be read in this state, or the values set do not go together: the message says so.
static inline void read_reals(fmi2Component c, Chosen* is) {
    fmi2ValueReference vr[REALS_MOST];
    double value[REALS_MOST];
    const size_t count = choose_reals(is, vr);
    if (CALL(fmi2GetReal(c, vr, count, value)) == fmi2OK) {
        for (size_t i = 0; i < count; i++) {
            check_finite(&value[i], 1, fc_variables[vr[i]].name);
        }
    }
}

static inline void check_outputs(fmi2Component c) {
    read_reals(c, is_plain);
    read_reals(c, fc_variable_is_rate);
    read_reals(c, fc_variable_is_settled_force);
}

// Numbers, and the same ones if they are asked for again.
static inline fmi2Status get_twice(fmi2Component c, fmi2GetDerivativesTYPE* get, size_t count) {
    double first[STATES], again[STATES];
    const fmi2Status status = CALL(get(c, first, count));
    if (status == fmi2OK) {
        check_finite(first, count, "a rate or an indicator is a number");
        HOLD(CALL(get(c, again, count)) == fmi2OK && memcmp(first, again, count * sizeof *first) == 0,
             "rates and indicators asked for again are the same");
    }
    return status;
}

static inline fmi2Status rates(fmi2Component c) { return get_twice(c, fmi2GetDerivatives, STATES); }
static inline fmi2Status indicators(fmi2Component c) {
    return get_twice(c, fmi2GetEventIndicators, INDICATORS);
}

static inline fmi2Status nominals(fmi2Component c) {
    double x[STATES];
    const fmi2Status status = CALL(fmi2GetNominalsOfContinuousStates(c, x, STATES));
    for (int i = 0; status == fmi2OK && i < STATES; i++) {
        HOLD(isfinite(x[i]) && x[i] > 0.0, "a nominal value is a number above 0");
    }
    return status;
}

static inline fmi2Status complete(fmi2Component c) {
    fmi2Boolean event, end;
    return CALL(fmi2CompletedIntegratorStep(c, fmi2True, &event, &end));
}

static inline fmi2Status update(fmi2Component c) {
    const fmi2ValueReference time = reference_of(offsetof(FcVariables, time));
    fmi2EventInfo info;
    const fmi2Status status = CALL(fmi2NewDiscreteStates(c, &info));
    if (status == fmi2OK) {
        double z[INDICATORS], t = INFINITY;
        HOLD(!info.newDiscreteStatesNeeded && !info.terminateSimulation, "an event needs one look");
        HOLD(!info.nextEventTimeDefined || (CALL(fmi2GetReal(c, &time, 1, &t)) == fmi2OK &&
                                            info.nextEventTime > t && isfinite(info.nextEventTime)),
             "the next event is ahead");
        HOLD(CALL(fmi2GetEventIndicators(c, z, INDICATORS)) != fmi2OK ||
                 (z[1] > 0.0 && z[2] > 0.0 && z[3] > 0.0),
             "no indicator asks for a second event");
    }
    return status;
}

// After a call that found this state before it. A refusal changes nothing.
static inline void check_after(Fmi2Instance* instance, const StateBytes* before, fmi2Status status) {
    HOLD(status == fmi2OK || status == fmi2Warning || status == fmi2Error, "the status is one of three");
    if (status != fmi2Error) {
        check_outputs(instance->component);
        return;
    }
    const StateBytes after = state_of(instance->component);
    HOLD(new_errors(instance) > 0, "an error comes with a message");
    HOLD(same_state(before, &after), "an error changes nothing");
}

#endif
