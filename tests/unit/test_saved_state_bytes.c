// The bytes of a saved state: every number of it is in them, and comes back.
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "fmi2/saved_state.h"
#include "fmi2/values.h"
#include "fmi2/variables.h"

enum { MOST_BYTES = 4096 };

static void silent(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                   fmi2String category, fmi2String text, ...) {
    (void)environment, (void)name, (void)status, (void)category, (void)text;
}

static const fmi2CallbackFunctions callbacks = {silent, calloc, free, NULL, NULL};

// A state in which no two neighbours are equal and every number is one that it may have.
static FcSavedState full_state(void) {
    FcSavedState saved = {.mark = FC_SAVED_STATE_MARK};
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        if (info->type == FC_TYPE_REAL) {
            const double wanted = 0.125 + vr;
            *fc_variable_real(&saved.friction.variables, info) = fmin(fmax(wanted, info->min), info->max);
        } else {
            *fc_variable_integer(&saved.friction.variables, info) = (int)info->max;
        }
    }
    FcFrictionState* friction = &saved.friction;
    friction->time = 1e9;
    friction->time_rest = -1e-8;
    friction->W_f_rest = 3e-20;
    for (int input = 0; input < FC_INPUT_COUNT; input++) {
        friction->rate[input] = 1.5 + input;
        friction->next_rate[input] = -2.5 - input;
    }
    friction->next_rate_set = 1;
    saved.experiment = (FcExperiment){.mode = FC_STEP_COMPLETE,
                                      .tolerance_is_set = 1,
                                      .has_stop_time = 1,
                                      .start_time = -7.0,
                                      .stop_time = 1e10};
    return saved;
}

typedef struct {
    size_t size;
    char bytes[MOST_BYTES];
} Bytes;

static Bytes bytes_of(fmi2Component c, FcSavedState* saved) {
    Bytes written = {0};
    CHECK(fmi2SerializedFMUstateSize(c, saved, &written.size) == fmi2OK && written.size <= MOST_BYTES);
    CHECK(fmi2SerializeFMUstate(c, saved, written.bytes, MOST_BYTES) == fmi2OK);
    return written;
}

static void every_number_comes_back(fmi2Component c) {
    FcSavedState saved = full_state();
    const Bytes written = bytes_of(c, &saved);
    fmi2FMUstate read = NULL;
    CHECK(fmi2DeSerializeFMUstate(c, written.bytes, written.size, &read) == fmi2OK);
    if (read) {
        CHECK(memcmp(read, &saved, sizeof saved) == 0);
        CHECK(fmi2FreeFMUstate(c, &read) == fmi2OK && read == NULL);
    }
}

// One byte of the state changed changes the bytes beside their checksum.
static void check_counts(fmi2Component c, size_t begin, size_t size) {
    FcSavedState saved = full_state();
    const Bytes before = bytes_of(c, &saved);
    for (size_t i = begin; i < begin + size; i++) {
        FcSavedState changed = full_state();
        unsigned char* byte = (unsigned char*)&changed + i;
        *byte = (unsigned char)(*byte ^ 0x10u);
        const Bytes after = bytes_of(c, &changed);
        CHECK(after.size == before.size && memcmp(after.bytes, before.bytes, before.size - 8) != 0);
    }
}

static void every_byte_of_a_number_counts(fmi2Component c) {
    const size_t variables = offsetof(FcSavedState, friction) + offsetof(FcFrictionState, variables);
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const size_t size = fc_variables[vr].type == FC_TYPE_REAL ? sizeof(double) : sizeof(int);
        check_counts(c, variables + fc_variables[vr].offset, size);
    }
    const size_t first = offsetof(FcFrictionState, time);
    const size_t last = offsetof(FcFrictionState, next_rate_set) + sizeof(int);
    check_counts(c, offsetof(FcSavedState, friction) + first, last - first);
    check_counts(c, offsetof(FcSavedState, experiment), sizeof(FcExperiment));
}

// Each number beside the variables, infinite alone.
static void infinite_numbers_are_refused(fmi2Component c) {
    const size_t numbers[] = {offsetof(FcFrictionState, time),
                              offsetof(FcFrictionState, time_rest),
                              offsetof(FcFrictionState, W_f_rest),
                              offsetof(FcFrictionState, Q_f_rest),
                              offsetof(FcFrictionState, rate),
                              offsetof(FcFrictionState, rate) + (FC_INPUT_COUNT - 1) * sizeof(double),
                              offsetof(FcFrictionState, next_rate),
                              offsetof(FcFrictionState, next_rate) + (FC_INPUT_COUNT - 1) * sizeof(double)};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        FcSavedState saved = full_state();
        const double infinite = INFINITY;
        memcpy((char*)&saved.friction + numbers[i], &infinite, sizeof infinite);
        const Bytes written = bytes_of(c, &saved);
        fmi2FMUstate read = NULL;
        CHECK(fmi2DeSerializeFMUstate(c, written.bytes, written.size, &read) == fmi2Error && read == NULL);
    }
}

int main(void) {
    fmi2Component c =
        fmi2Instantiate("unit", fmi2CoSimulation, fc_guid, NULL, &callbacks, fmi2False, fmi2True);
    CHECK(c != NULL);
    if (c) {
        every_number_comes_back(c);
        every_byte_of_a_number_counts(c);
        infinite_numbers_are_refused(c);
        fmi2FreeInstance(c);
    }
    return check_result();
}
