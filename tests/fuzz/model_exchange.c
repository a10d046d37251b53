// Fuzzes sequences of FMI calls on an instance for model exchange, legal or not, with good and bad values, beside one for
// co-simulation whose states it is offered.
//
// Each byte of the input is a call or a part of its arguments. After every call:
//     fmi2OK or fmi2Warning    all variables, rates and indicators that can be read are finite numbers
//     fmi2Error                at least one message, and the state is the one before, to the last bit
//     anything else            is never returned
// Rates and indicators that are asked for again, or after going elsewhere and back, are the same bits.
#include "host.h"
#include "input.h"

// As an integrator tries a step: elsewhere and back.
static fmi2Status try_step(Bytes* input, fmi2Component c) {
    double x[STATES], tried[STATES], here[STATES], back[STATES];
    const double t = next_real(input), elsewhere = next_real(input);
    fmi2Status status = fmi2SetTime(c, t);
    if (status != fmi2OK || fmi2GetContinuousStates(c, x, STATES) != fmi2OK ||
        fmi2GetDerivatives(c, here, STATES) != fmi2OK) {
        return status;
    }
    for (int i = 0; i < STATES; i++) {
        tried[i] = x[i] + 1e-7 * here[i];
    }
    if (fmi2SetTime(c, elsewhere) == fmi2OK && fmi2SetContinuousStates(c, tried, STATES) == fmi2OK) {
        rates(c);
    }
    if (fmi2SetTime(c, t) == fmi2OK && fmi2SetContinuousStates(c, x, STATES) == fmi2OK) {
        HOLD(fmi2GetDerivatives(c, back, STATES) == fmi2OK && memcmp(here, back, sizeof here) == 0,
             "the rates are where they were");
    }
    return fmi2OK;
}

static fmi2Status put_states(Bytes* input, fmi2Component c) {
    double x[STATES];
    for (int i = 0; i < STATES; i++) {
        x[i] = next_real(input);
    }
    return fmi2SetContinuousStates(c, x, next_byte(input) % 16 ? STATES : next_byte(input) % 8);
}

static fmi2Status on_states(Bytes* input, Bench* bench, fmi2Component c) {
    fmi2FMUstate* slot = next_slot(input, bench);
    switch (next_byte(input) % 5) {
    case 0:
        return fmi2GetFMUstate(c, slot);
    case 1:
        return fmi2GetFMUstate(bench->instance[1].component, slot);
    case 2:
        return fmi2FreeFMUstate(c, slot);
    case 3:
        return carry_state(input, &(Bytes){0}, bench, c);
    default:
        return fmi2SetFMUstate(c, *slot);
    }
}

static fmi2Status call(Bytes* input, Bench* bench, Fmi2Instance* instance) {
    fmi2Component c = instance->component;
    fmi2ValueReference vr = 0;
    double real = 0.0;
    switch (next_byte(input) % 24) {
    case 0:
        return fmi2SetupExperiment(c, fmi2False, 0.0, next_real(input), (int)(next_byte(input) % 2),
                                   next_real(input));
    case 1:
        return fmi2EnterInitializationMode(c);
    case 2:
        return fmi2ExitInitializationMode(c);
    case 3:
        return next_byte(input) % 8 ? fmi2OK : fmi2Terminate(c);
    case 4:
        return next_byte(input) % 8 ? fmi2OK : fmi2Reset(c);
    case 5:
        return choose(input, c);
    case 6:
        return on_states(input, bench, c);
    case 7:
        return directional(input, c);
    case 8:
        vr = next_reference(input);
        return fmi2GetReal(c, &vr, 1, &real);
    case 9:
        return fmi2DoStep(c, 0.0, next_real(input), fmi2True);
    case 10:
    case 11:
        return fmi2EnterEventMode(c);
    case 12:
    case 13:
        return update(c);
    case 14:
    case 15:
        return fmi2EnterContinuousTimeMode(c);
    case 16:
        return complete(c);
    case 17:
        return fmi2SetTime(c, next_real(input));
    case 18:
        return put_states(input, c);
    case 19:
        return next_byte(input) % 2 ? rates(c) : indicators(c);
    case 20:
        return nominals(c);
    case 21:
        return try_step(input, c);
    default:
        return set_reals(input, c);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz((Bytes){data, data + size}, fmi2ModelExchange, 60, call);
}
