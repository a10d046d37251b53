// The bytes of a saved state: every number of it is in them, and comes back.
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "fmi2/saved_state.h"
#include "fmi2/variables.h"

enum { MOST_BYTES = 4096, LAYOUT = 5 };

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
    friction->slips = -1;
    friction->past = (FcPast){
        .d = 1e-5, .V = -2.0, .V_y = 2.5, .E = 3e9, .limit = 4.0, .ratio = 5.0, .V_S = 6.0, .sigma = 7e6};
    FcHybrid* hybrid = &friction->hybrid;
    hybrid->seen_time = 0.75;
    for (int input = 0; input < FC_INPUT_COUNT; input++) {
        hybrid->seen[input] = 7.5 + input;
        hybrid->speed[input] = -9.5 - input;
    }
    hybrid->nominal_delta = 1e-7;
    hybrid->nominal_energy = 1e-5;
    hybrid->lag = 3e-8;
    hybrid->lag_force = -17.0;
    hybrid->lag_heat = 2e-7;
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

// Each number beside the variables, infinite alone.
static void infinite_numbers_are_refused(fmi2Component c) {
    const size_t numbers[] = {offsetof(FcFrictionState, time),
                              offsetof(FcFrictionState, time_rest),
                              offsetof(FcFrictionState, W_f_rest),
                              offsetof(FcFrictionState, Q_f_rest),
                              offsetof(FcFrictionState, rate),
                              offsetof(FcFrictionState, rate) + (FC_INPUT_COUNT - 1) * sizeof(double),
                              offsetof(FcFrictionState, next_rate),
                              offsetof(FcFrictionState, next_rate) + (FC_INPUT_COUNT - 1) * sizeof(double),
                              offsetof(FcFrictionState, past),
                              offsetof(FcFrictionState, past.sigma),
                              offsetof(FcFrictionState, hybrid.seen_time),
                              offsetof(FcFrictionState, hybrid.seen),
                              offsetof(FcFrictionState, hybrid.speed) + (FC_INPUT_COUNT - 1) * sizeof(double),
                              offsetof(FcFrictionState, hybrid.nominal_delta),
                              offsetof(FcFrictionState, hybrid.nominal_energy),
                              offsetof(FcFrictionState, hybrid.lag),
                              offsetof(FcFrictionState, hybrid.lag_force),
                              offsetof(FcFrictionState, hybrid.lag_heat)};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        FcSavedState saved = full_state();
        const double infinite = INFINITY;
        memcpy((char*)&saved.friction + numbers[i], &infinite, sizeof infinite);
        const Bytes written = bytes_of(c, &saved);
        fmi2FMUstate read = NULL;
        CHECK(fmi2DeSerializeFMUstate(c, written.bytes, written.size, &read) == fmi2Error && read == NULL);
    }
}

enum { AT_VERSION = 8, AT_SIZE = 12, AT_GUID = 16, AT_VALUES = 54 }; // bytes

static void put(Bytes* bytes, size_t at, unsigned long long value, int size) {
    for (int i = 0; i < size; i++) {
        bytes->bytes[at + (size_t)i] = (char)(value >> (8 * i) & 0xffu);
    }
}

// FNV-1a of 64 bits over all bytes before the last eight, which it becomes.
static void put_hash(Bytes* bytes) {
    unsigned long long hash = 0xcbf29ce484222325ull;
    for (size_t i = 0; i < bytes->size - 8; i++) {
        hash ^= (unsigned char)bytes->bytes[i];
        hash *= 0x100000001b3ull;
    }
    put(bytes, bytes->size - 8, hash, 8);
}

static bool is_read(fmi2Component c, const Bytes* bytes, size_t size) {
    fmi2FMUstate read = NULL;
    const bool is_taken = fmi2DeSerializeFMUstate(c, bytes->bytes, size, &read) == fmi2OK;
    CHECK(is_taken == (read != NULL));
    fmi2FreeFMUstate(c, &read);
    return is_taken;
}

// The head, the order of the bytes of a number, and the hash, written apart from the code.
static void bytes_are_as_documented(fmi2Component c) {
    FcSavedState saved = full_state();
    const Bytes written = bytes_of(c, &saved);
    Bytes expected = written;
    memcpy(expected.bytes, "FRICTION", 8);
    put(&expected, AT_VERSION, LAYOUT, 4);
    put(&expected, AT_SIZE, written.size, 4);
    memcpy(expected.bytes + AT_GUID, fc_guid, AT_VALUES - AT_GUID);
    unsigned long long bits;
    memcpy(&bits, fc_variable_real(&saved.friction.variables, &fc_variables[0]), sizeof bits);
    put(&expected, AT_VALUES, bits, 8);
    put_hash(&expected);
    CHECK(memcmp(expected.bytes, written.bytes, written.size) == 0);
    char too_few[MOST_BYTES];
    CHECK(fmi2SerializeFMUstate(c, &saved, too_few, written.size - 1) == fmi2Error);
    CHECK(fmi2SerializeFMUstate(c, &saved, too_few, written.size) == fmi2OK);
}

// Other versions, other sizes, bytes cut off or too many, and each byte damaged with the hash put right or not.
static void other_bytes_are_refused(fmi2Component c) {
    FcSavedState saved = full_state();
    const Bytes good = bytes_of(c, &saved);
    const size_t size = good.size;
    for (unsigned version = 0; version < 7; version++) {
        Bytes other = good;
        put(&other, AT_VERSION, version, 4);
        put_hash(&other);
        CHECK(is_read(c, &other, size) == (version == LAYOUT));
    }
    for (size_t given = 0; given < size + 20; given++) {
        CHECK(is_read(c, &good, given) == (given == size));
        Bytes other = good;
        put(&other, AT_SIZE, given, 4);
        put_hash(&other);
        CHECK(is_read(c, &other, size) == (given == size));
    }
    for (size_t i = 0; i < size; i++) {
        Bytes damaged = good;
        damaged.bytes[i] ^= 1;
        CHECK(!is_read(c, &damaged, size));
        if (i < AT_VALUES) {
            put_hash(&damaged);
            CHECK(!is_read(c, &damaged, size));
        }
    }
}

static bool is_read_with(fmi2Component c, FcSavedState* saved) {
    const Bytes bytes = bytes_of(c, saved);
    return is_read(c, &bytes, bytes.size);
}

// A flag is 0 or 1, a mode one that the interface has; each alone.
static void impossible_flags_are_refused(fmi2Component c) {
    const size_t flags[] = {offsetof(FcSavedState, friction) + offsetof(FcFrictionState, next_rate_set),
                            offsetof(FcSavedState, friction) + offsetof(FcFrictionState, hybrid.changed),
                            offsetof(FcSavedState, experiment) + offsetof(FcExperiment, outputs_stale),
                            offsetof(FcSavedState, experiment) + offsetof(FcExperiment, tolerance_is_set),
                            offsetof(FcSavedState, experiment) + offsetof(FcExperiment, has_stop_time)};
    for (int value = -2; value < 4; value++) {
        for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) {
            FcSavedState saved = full_state();
            memcpy((char*)&saved + flags[i], &value, sizeof value);
            CHECK(is_read_with(c, &saved) == (value == 0 || value == 1));
        }
    }
    for (int interface = -1; interface < 5; interface++) {
        const bool steps = interface == FC_CO_SIMULATION;
        const bool exchanges = interface == FC_MODEL_EXCHANGE;
        for (int mode = -2; mode <= 2 * FC_CONTINUOUS_TIME_MODE; mode++) {
            FcSavedState saved = full_state();
            saved.experiment.interface = interface;
            saved.experiment.mode = mode;
            const bool common =
                mode == FC_INSTANTIATED || mode == FC_INITIALIZATION_MODE || mode == FC_TERMINATED;
            const bool running = mode == FC_EVENT_MODE || mode == FC_CONTINUOUS_TIME_MODE;
            CHECK(is_read_with(c, &saved) == (((steps || exchanges) && common) ||
                                              (steps && mode == FC_STEP_COMPLETE) || (exchanges && running)));
        }
    }
    for (int regime = -2; regime <= 2; regime++) { // only a bounded bristle slips
        FcSavedState saved = full_state();
        saved.friction.hybrid.regime = regime;
        CHECK(is_read_with(c, &saved) == (regime >= -1 && regime <= 1));
        saved.friction.variables.friction.limit = FC_LIMIT_CONSTANT;
        CHECK(is_read_with(c, &saved) == (regime == 0));
    }
    for (int slips = -2; slips <= 2; slips++) {
        FcSavedState saved = full_state();
        saved.friction.slips = slips;
        CHECK(is_read_with(c, &saved) == (slips >= -1 && slips <= 1));
    }
    FcSavedState saved = full_state();
    saved.experiment.start_time = INFINITY;
    CHECK(!is_read_with(c, &saved));
    saved = full_state();
    saved.experiment.stop_time = NAN;
    CHECK(!is_read_with(c, &saved));
}

// Each variable beyond its bounds, alone.
static void impossible_values_are_refused(fmi2Component c) {
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        for (int side = 0; side < 2; side++) {
            FcSavedState saved = full_state();
            if (info->type == FC_TYPE_REAL) {
                *fc_variable_real(&saved.friction.variables, info) = side == 0 ? -INFINITY : NAN;
            } else {
                *fc_variable_integer(&saved.friction.variables, info) =
                    (int)(side == 0 ? info->min - 1 : info->max + 1);
            }
            CHECK(!is_read_with(c, &saved));
        }
    }
}

int main(void) {
    fmi2Component c =
        fmi2Instantiate("unit", fmi2CoSimulation, fc_guid, NULL, &callbacks, fmi2False, fmi2True);
    CHECK(c != NULL);
    if (c) {
        every_number_comes_back(c);
        infinite_numbers_are_refused(c);
        bytes_are_as_documented(c);
        other_bytes_are_refused(c);
        impossible_flags_are_refused(c);
        impossible_values_are_refused(c);
        fmi2FreeInstance(c);
    }
    return check_result();
}
