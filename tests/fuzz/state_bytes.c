// Fuzzes fmi2DeSerializeFMUstate, and what an instance does with a state that it accepts.
//
// First byte even: the rest is given as it is. Odd: the rest becomes the values of a state that is sealed with a
// right header and checksum, so that the values themselves are tried. They are the variables in the order of
// modelDescription.xml, Real 8 bytes, Enumeration 4, and then what follows them in a state.
//     refused     a message, no state, and the instance as before
//     accepted    written again, the same bytes; the instance runs on, is saved and freed
#include "fmi2/saved_state.h"
#include "host.h"

enum {
    AT_VARIABLES = offsetof(FcSavedState, friction),
    AFTER_VARIABLES = AT_VARIABLES + sizeof(FcVariables)
};

static uint64_t fnv1a(const char* bytes, size_t size) {
    uint64_t hash = 14695981039346656037u;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ (unsigned char)bytes[i]) * 1099511628211u;
    }
    return hash;
}

// Moves up to room bytes from *values, which has *count, to a place of the state.
static void take(char* place, size_t room, const uint8_t** values, size_t* count) {
    const size_t size = *count < room ? *count : room;
    memcpy(place, *values, size);
    *values += size;
    *count -= size;
}

// The state of an initialized instance with the values replaced, as far as there are bytes for them.
static StateBytes sealed(fmi2Component c, const uint8_t* values, size_t count) {
    StateBytes state = state_of(c);
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        const size_t size = info->type == FC_TYPE_REAL ? sizeof(double) : sizeof(int);
        take(state.bytes + AT_VARIABLES + info->offset, size, &values, &count);
    }
    take(state.bytes + AFTER_VARIABLES, sizeof(FcSavedState) - AFTER_VARIABLES, &values, &count);
    const uint64_t hash = fnv1a(state.bytes, sizeof(FcSavedState));
    memcpy(state.bytes + sizeof(FcSavedState), &hash, sizeof hash);
    return state;
}

static void use(fmi2Component c) {
    check_outputs(c);
    double t = 0.0;
    double slope = 0.0;
    const fmi2ValueReference F_t = reference_of(offsetof(FcVariables, F_t));
    const fmi2Integer first = 1;
    if (fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &t) == fmi2OK && is_short_work(c, 1e-5)) {
        fmi2DoStep(c, t, 1e-5, fmi2True);
        fmi2GetRealOutputDerivatives(c, &F_t, 1, &first, &slope);
    }
    fmi2EnterInitializationMode(c);
    fmi2ExitInitializationMode(c);
    check_outputs(c);
    fmi2Terminate(c);
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size == 0) {
        return 0;
    }
    Fmi2Instance instance;
    instantiate_for(&instance, fmi2CoSimulation);
    fmi2Component c = instance.component;
    HOLD(fmi2EnterInitializationMode(c) == fmi2OK && fmi2ExitInitializationMode(c) == fmi2OK,
         "it initializes");
    const StateBytes before = state_of(c);
    const StateBytes made = data[0] % 2 ? sealed(c, data + 1, size - 1) : (StateBytes){0};
    const char* bytes = data[0] % 2 ? made.bytes : (const char*)data + 1;
    const size_t count = data[0] % 2 ? made.size : size - 1;

    new_errors(&instance);
    fmi2FMUstate state = NULL;
    const fmi2Status status = fmi2DeSerializeFMUstate(c, bytes, count, &state);
    if (status == fmi2OK) {
        char again[STATE_SIZE_MOST];
        HOLD(state && fmi2SerializeFMUstate(c, state, again, sizeof again) == fmi2OK, "it can be written");
        HOLD(memcmp(again, bytes, count) == 0, "an accepted state is written as it was read");
        HOLD(fmi2SetFMUstate(c, state) == fmi2OK, "an accepted state can be set");
        use(c);
    } else {
        const StateBytes after = state_of(c);
        HOLD(status == fmi2Error && new_errors(&instance) == 1 && !state,
             "a refusal is an error with a message");
        HOLD(same_state(&before, &after), "a refusal changes nothing");
    }
    HOLD(fmi2FreeFMUstate(c, &state) == fmi2OK, "the state can be freed");
    fmi2_instance_free(&instance);
    return 0;
}
