// What the bytes of a fuzzer's input mean: numbers, variables, and the calls that take them, on two instances.
#ifndef FC_FUZZ_INPUT_H
#define FC_FUZZ_INPUT_H

#include "host.h"

typedef struct {
    const uint8_t* at;
    const uint8_t* end;
} Bytes;

static unsigned next_byte(Bytes* input) { return input->at < input->end ? *input->at++ : 0; }

static double next_real(Bytes* input) {
    static const double telling[] = {
        0.0,   -0.0,     1.0,      -1.0,   0.005,  -0.005, 14e-6, 20e-6,  1e-6,
        1e-12, 1e-9,     1e-7,     5e-5,   1e-4,   1e-3,   0.01,  0.5,    2.0,
        55.0,  1e3,      2e4,      1e6,    2.5e6,  58e9,   1e9,   1e12,   1e100,
        1e300, -1e300,   1e-300,   5e-324, 1.7e-5, 0.44,   3.0,   1.5707, 1.7976931348623157e308,
        NAN,   INFINITY, -INFINITY};
    const unsigned count = sizeof telling / sizeof *telling;
    const unsigned choice = next_byte(input) % (count + 5);
    if (choice < count) {
        return telling[choice];
    }
    double value = 0.0;
    for (size_t i = 0; i < sizeof value && choice == count; i++) {
        ((unsigned char*)&value)[i] = (unsigned char)next_byte(input);
    }
    return choice == count ? value : 1e-3 * (double)(next_byte(input) * 256 + next_byte(input)) - 20.0;
}

static fmi2ValueReference next_reference(Bytes* input) {
    const unsigned byte = next_byte(input);
    return byte < 250 ? byte % fc_variables_count : byte == 250 ? 4294967295u : byte;
}

static fmi2Status set_reals(Bytes* input, fmi2Component c) {
    fmi2ValueReference vr[3];
    double value[3];
    const size_t count = next_byte(input) % 4;
    for (size_t i = 0; i < count; i++) {
        vr[i] = next_reference(input);
        value[i] = next_real(input);
    }
    return fmi2SetReal(c, vr, count, value);
}

static fmi2Status choose(Bytes* input, fmi2Component c) {
    static const size_t enumerations[] = {
        offsetof(FcVariables, solver.method),  offsetof(FcVariables, friction.model),
        offsetof(FcVariables, contact.model),  offsetof(FcVariables, initialState),
        offsetof(FcVariables, friction.limit), offsetof(FcVariables, contact.input)};
    const unsigned byte = next_byte(input);
    const fmi2ValueReference vr = reference_of(enumerations[byte < 64 ? 0 : byte / 8 % 6]);
    const int item = (int)(byte % 8);
    return fmi2SetInteger(c, &vr, 1, &item);
}

static fmi2Status directional(Bytes* input, fmi2Component c) {
    const fmi2ValueReference unknown = next_reference(input);
    const fmi2ValueReference known = next_reference(input);
    const double direction = next_real(input);
    double slope = 0.0;
    const fmi2Status status = fmi2GetDirectionalDerivative(c, &unknown, 1, &known, 1, &direction, &slope);
    HOLD(status != fmi2OK || isfinite(slope), "a directional derivative is a number");
    return status;
}

// ---- two instances, the second one for co-simulation, and states that they exchange ----

enum { INSTANCES = 2, SLOTS = 3 };

typedef struct {
    Fmi2Instance instance[INSTANCES];
    fmi2FMUstate slot[SLOTS];
    double time; // s, of the last step done
} Bench;

static fmi2FMUstate* next_slot(Bytes* input, Bench* bench) { return &bench->slot[next_byte(input) % SLOTS]; }

// Writes a state and reads it, perhaps with a byte changed.
static fmi2Status carry_state(Bytes* input, Bytes* damages, Bench* bench, fmi2Component c) {
    char bytes[STATE_SIZE_MOST];
    size_t size = 0;
    const fmi2FMUstate state = *next_slot(input, bench);
    if (!state || fmi2SerializedFMUstateSize(c, state, &size) != fmi2OK) {
        return fmi2OK;
    }
    HOLD(fmi2SerializeFMUstate(c, state, bytes, size) == fmi2OK, "a state can be written");
    const unsigned damage = next_byte(damages);
    const unsigned place = next_byte(damages) * 2;
    if (damage && place < size) {
        bytes[place] = (char)(bytes[place] ^ (int)damage);
    }
    const fmi2Status status = fmi2DeSerializeFMUstate(c, bytes, size, next_slot(damages, bench));
    HOLD((status == fmi2OK) == !(damage && place < size), "damaged bytes are refused, others are not");
    return status;
}

typedef fmi2Status Call(Bytes* input, Bench* bench, Fmi2Instance* instance);

// Calls on the first instance, for that interface, and of co-simulation on the second one too.
static int fuzz(Bytes input, fmi2Type interface, int most_calls, Call* call) {
    Bench bench = {.time = 0.0};
    instantiate_for(&bench.instance[0], interface);
    instantiate_for(&bench.instance[1], fmi2CoSimulation);
    for (int calls = 0; input.at < input.end && calls < most_calls; calls++) {
        Fmi2Instance* instance = &bench.instance[interface == fmi2CoSimulation && *input.at >= 128];
        const StateBytes before = state_of(instance->component);
        new_errors(instance);
        check_after(instance, &before, call(&input, &bench, instance));
    }
    for (int i = 0; i < SLOTS; i++) {
        HOLD(fmi2FreeFMUstate(bench.instance[0].component, &bench.slot[i]) == fmi2OK, "a slot can be freed");
    }
    for (int i = 0; i < INSTANCES; i++) {
        fmi2_instance_free(&bench.instance[i]);
    }
    return 0;
}

#endif
