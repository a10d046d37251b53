// The bytes of a saved state: every number of it is in them, and comes back; other bytes are refused.
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "fmi2/saved_state.h"
#include "fmi2/variables.h"

enum { MAX_BYTES = 4096, LAYOUT = 8 };

static void silent(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                   fmi2String category, fmi2String text, ...) {
    (void)environment, (void)name, (void)status, (void)category, (void)text;
}

static const fmi2CallbackFunctions callbacks = {silent, calloc, free, NULL, NULL};

// A state in which no two neighbours are equal and every number is one that it may have.
static FcSavedState full_state(void) {
    FcSavedState saved;
    memset(&saved, 0, sizeof saved);
    saved.head = fc_saved_state_head();
    FcFrictionState* friction = &saved.friction;
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        if (info->type == FC_TYPE_REAL) {
            *fc_variable_real(&friction->variables, info) = fmin(fmax(0.125 + vr, info->min), info->max);
        } else {
            *fc_variable_integer(&friction->variables, info) = (int)info->max;
        }
    }
    friction->variables.body.m = 0.0; // a mass does not go together with V_y
    for (size_t at = sizeof(FcVariables); at < sizeof *friction; at += sizeof(double)) {
        const double number = 1e-3 * (double)at;
        memcpy((char*)friction + at, &number, sizeof number);
    }
    friction->rates.next_is_set = 1;
    friction->bristle.state = FC_SLIPPING;
    friction->ode.changed = 0;
    friction->ode.no_hole = friction->rates.no_hole = friction->bristle.no_hole = 0;
    saved.experiment = (FcExperiment){.interface = FC_CO_SIMULATION,
                                      .mode = FC_STEP_COMPLETE,
                                      .tolerance_is_set = 1,
                                      .has_stop_time = 1,
                                      .start_time = -7.0,
                                      .stop_time = 1e10};
    return saved;
}

typedef struct {
    size_t size;
    char bytes[MAX_BYTES];
} Bytes;

static Bytes bytes_of(fmi2Component c, FcSavedState* saved) {
    Bytes written = {0};
    CHECK(fmi2SerializedFMUstateSize(c, saved, &written.size) == fmi2OK && written.size <= MAX_BYTES);
    CHECK(fmi2SerializeFMUstate(c, saved, written.bytes, MAX_BYTES) == fmi2OK);
    return written;
}

static bool is_read(fmi2Component c, const Bytes* bytes, size_t size) {
    fmi2FMUstate read = NULL;
    const bool is_taken = fmi2DeSerializeFMUstate(c, bytes->bytes, size, &read) == fmi2OK;
    CHECK(is_taken == (read != NULL));
    fmi2FreeFMUstate(c, &read);
    return is_taken;
}

// The full state with one part of it changed.
static bool is_read_with(fmi2Component c, size_t at, const void* value, size_t size) {
    FcSavedState saved = full_state();
    memcpy((char*)&saved + at, value, size);
    const Bytes bytes = bytes_of(c, &saved);
    return is_read(c, &bytes, bytes.size);
}

static void every_number_comes_back(fmi2Component c) {
    FcSavedState saved = full_state();
    const Bytes written = bytes_of(c, &saved);
    fmi2FMUstate read = NULL;
    CHECK(fmi2DeSerializeFMUstate(c, written.bytes, written.size, &read) == fmi2OK);
    CHECK(read && memcmp(read, &saved, sizeof saved) == 0);
    CHECK(fmi2FreeFMUstate(c, &read) == fmi2OK && read == NULL);
}

enum { AT_LAYOUT = 8, AT_SIZE = 12, AT_GUID = 16, AT_VALUES = 56 }; // bytes

static void put_int(Bytes* bytes, size_t at, uint32_t value) {
    memcpy(bytes->bytes + at, &value, sizeof value);
}

// FNV-1a of 64 bits over all bytes before the last eight, which it becomes.
static void put_hash(Bytes* bytes) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < bytes->size - 8; i++) {
        hash ^= (unsigned char)bytes->bytes[i];
        hash *= 0x100000001b3u;
    }
    memcpy(bytes->bytes + bytes->size - 8, &hash, sizeof hash);
}

// The head, the values and the hash, written apart from the code.
static void bytes_are_as_documented(fmi2Component c) {
    FcSavedState saved = full_state();
    const Bytes written = bytes_of(c, &saved);
    Bytes expected = {.size = written.size};
    memcpy(expected.bytes, "FRICTION", 8);
    put_int(&expected, AT_LAYOUT, LAYOUT);
    put_int(&expected, AT_SIZE, (uint32_t)written.size);
    memcpy(expected.bytes + AT_GUID, fc_guid, strlen(fc_guid));
    memcpy(expected.bytes + AT_VALUES, &saved.friction, sizeof saved.friction);
    memcpy(expected.bytes + AT_VALUES + sizeof saved.friction, &saved.experiment, sizeof saved.experiment);
    put_hash(&expected);
    CHECK(AT_VALUES + sizeof saved.friction + sizeof saved.experiment + 8 == written.size);
    CHECK(memcmp(expected.bytes, written.bytes, written.size) == 0);
    char too_few[MAX_BYTES];
    CHECK(fmi2SerializeFMUstate(c, &saved, too_few, written.size - 1) == fmi2Error);
}

// The padding of a state in memory does not reach its bytes, and other bytes in its place are refused.
static void padding_is_zero(fmi2Component c) {
    FcSavedState clean = full_state(), dirty = clean;
    unsigned char is_value[sizeof(FcVariables)] = {0};
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const size_t size = fc_variables[vr].type == FC_TYPE_REAL ? sizeof(double) : sizeof(int);
        memset(is_value + fc_variables[vr].offset, 1, size);
    }
    const Bytes expected = bytes_of(c, &clean);
    int count = 0;
    for (size_t i = 0; i < sizeof is_value; i++) {
        if (!is_value[i]) {
            Bytes other = expected;
            other.bytes[offsetof(FcSavedState, friction) + i] = 1;
            put_hash(&other);
            CHECK(!is_read(c, &other, other.size));
            ((unsigned char*)&dirty.friction)[i] = 0xff;
            count++;
        }
    }
    const Bytes written = bytes_of(c, &dirty);
    CHECK(count > 0 && memcmp(written.bytes, expected.bytes, expected.size) == 0);
}

// Another version, another size, and each byte damaged with the hash put right or not.
static void other_bytes_are_refused(fmi2Component c) {
    FcSavedState saved = full_state();
    const Bytes good = bytes_of(c, &saved);
    const size_t size = good.size;
    for (size_t given = 0; given < size + 20; given++) {
        CHECK(is_read(c, &good, given) == (given == size));
        Bytes other = good;
        put_int(&other, AT_SIZE, (uint32_t)given);
        put_hash(&other);
        CHECK(is_read(c, &other, size) == (given == size));
    }
    for (size_t i = 0; i < size; i++) {
        Bytes damaged = good;
        damaged.bytes[i] ^= 1;
        CHECK(!is_read(c, &damaged, size));
        put_hash(&damaged);
        CHECK(i >= AT_VALUES || !is_read(c, &damaged, size));
    }
}

// Each number that is no number, each variable beyond its bounds, and flags that are none, alone.
static void impossible_numbers_are_refused(fmi2Component c) {
    const size_t friction = offsetof(FcSavedState, friction), experiment = offsetof(FcSavedState, experiment);
    const double infinite = INFINITY;
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        const int beyond = (int)info->max + 1;
        const bool is_real = info->type == FC_TYPE_REAL;
        CHECK(!is_read_with(c, friction + info->offset, is_real ? (const void*)&infinite : &beyond,
                            is_real ? sizeof infinite : sizeof beyond));
    }
    for (size_t at = sizeof(FcVariables); at < sizeof(FcFrictionState); at += sizeof(double)) {
        CHECK(!is_read_with(c, friction + at, &infinite, sizeof infinite)); // as two ints, 0 and no flag
    }
    CHECK(!is_read_with(c, experiment + offsetof(FcExperiment, start_time), &infinite, sizeof infinite));
    CHECK(!is_read_with(c, experiment + offsetof(FcExperiment, stop_time), &infinite, sizeof infinite));
    const int one = 1;
    CHECK(!is_read_with(c, experiment + offsetof(FcExperiment, no_hole), &one, sizeof one));
    const struct {
        size_t at;
        int largest;
    } flags[] = {{friction + offsetof(FcFrictionState, rates.next_is_set), 1},
                 {friction + offsetof(FcFrictionState, ode.changed), 1},
                 {friction + offsetof(FcFrictionState, bristle.state), FC_CATCHING_UP},
                 {experiment + offsetof(FcExperiment, outputs_stale), 1},
                 {experiment + offsetof(FcExperiment, tolerance_is_set), 1},
                 {experiment + offsetof(FcExperiment, has_stop_time), 1}};
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) {
        for (int value = -2; value <= 3; value++) {
            CHECK(is_read_with(c, flags[i].at, &value, sizeof value) ==
                  (value >= 0 && value <= flags[i].largest));
        }
    }
}

// A mode is one that the interface has.
static void impossible_modes_are_refused(fmi2Component c) {
    for (int interface = -1; interface < 5; interface++) {
        const bool steps = interface == FC_CO_SIMULATION, exchanges = interface == FC_MODEL_EXCHANGE;
        for (int mode = -2; mode <= 2 * FC_CONTINUOUS_TIME_MODE; mode++) {
            const bool common =
                mode == FC_INSTANTIATED || mode == FC_INITIALIZATION_MODE || mode == FC_TERMINATED;
            const bool running = mode == FC_EVENT_MODE || mode == FC_CONTINUOUS_TIME_MODE;
            const int both[] = {interface, mode};
            CHECK(is_read_with(c, offsetof(FcSavedState, experiment), both, sizeof both) ==
                  (((steps || exchanges) && common) || (steps && mode == FC_STEP_COMPLETE) ||
                   (exchanges && running)));
        }
    }
}

int main(void) {
    fmi2Component c =
        fmi2Instantiate("unit", fmi2CoSimulation, fc_guid, NULL, &callbacks, fmi2False, fmi2True);
    CHECK(c != NULL);
    if (c) {
        every_number_comes_back(c);
        bytes_are_as_documented(c);
        padding_is_zero(c);
        other_bytes_are_refused(c);
        impossible_numbers_are_refused(c);
        impossible_modes_are_refused(c);
        fmi2FreeInstance(c);
    }
    return check_result();
}
