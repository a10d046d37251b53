// Fuzzes sequences of FMI calls, legal or not, with good and bad values, on two instances that exchange states.
//
// Each byte of the input is a call or a part of its arguments. After every call:
//     fmi2OK or fmi2Warning    all variables that can be read are finite numbers
//     fmi2Error                at least one message, and the state is the one before, to the last bit
//     anything else            is never returned
// A step that succeeds is taken back and done again: the bits must be the same.
#include "host.h"
#include "input.h"

static fmi2Status step(Bytes* input, Bench* bench, fmi2Component c) {
    const unsigned how = next_byte(input) % 8;
    const double h = next_real(input);
    double reached = 0.0;
    fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &reached);
    const double t = how == 0 ? next_real(input) : how == 1 ? bench->time : reached;
    if (!is_short_work(c, h)) {
        return fmi2OK;
    }
    fmi2FMUstate before = NULL;
    HOLD(fmi2GetFMUstate(c, &before) == fmi2OK, "a state can be saved");
    const fmi2Status status = fmi2DoStep(c, t, h, fmi2True);
    if (status == fmi2OK) {
        bench->time = t + h;
        const StateBytes first = state_of(c);
        HOLD(fmi2SetFMUstate(c, before) == fmi2OK, "the step can be taken back");
        HOLD(fmi2DoStep(c, t, h, fmi2True) == fmi2OK, "and done again");
        const StateBytes second = state_of(c);
        HOLD(same_state(&first, &second), "a step done again gives the same bits");
        HOLD(fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &reached) == fmi2OK && reached == t + h,
             "the step ends at t + h");
    }
    HOLD(fmi2FreeFMUstate(c, &before) == fmi2OK, "a saved state can be freed");
    return status;
}

// An input, or F_t, which is none.
static fmi2ValueReference next_input(Bytes* input) {
    static const size_t inputs[] = {offsetof(FcVariables, V), offsetof(FcVariables, d),
                                    offsetof(FcVariables, E), offsetof(FcVariables, F_t),
                                    offsetof(FcVariables, load)};
    return reference_of(inputs[next_byte(input) % 5]);
}

static fmi2Status call(Bytes* input, Bench* bench, Fmi2Instance* instance) {
    fmi2Component c = instance->component;
    const unsigned function = next_byte(input) % 32;
    fmi2ValueReference vr = 0;
    double real = 0.0;
    int integer = 0;
    switch (function) {
    case 0:
        return fmi2SetupExperiment(c, (int)(next_byte(input) % 2), next_real(input), next_real(input),
                                   (int)(next_byte(input) % 2), next_real(input));
    case 1:
        return fmi2EnterInitializationMode(c);
    case 2:
        return fmi2ExitInitializationMode(c);
    case 3:
        return fmi2Terminate(c);
    case 4:
        return fmi2Reset(c);
    case 5:
        fmi2_instance_free(instance);
        instantiate_for(instance, fmi2CoSimulation);
        return fmi2OK;
    case 6:
        vr = next_reference(input);
        return fmi2GetReal(c, &vr, 1, &real);
    case 7:
        vr = next_reference(input);
        return fmi2GetInteger(c, &vr, 1, &integer);
    case 8:
        vr = next_reference(input);
        integer = (int)next_byte(input) - 2;
        return fmi2SetInteger(c, &vr, 1, &integer);
    case 9:
        return choose(input, c);
    case 10:
    case 11:
        return fmi2GetFMUstate(c, next_slot(input, bench));
    case 12:
    case 13:
        return fmi2SetFMUstate(c, *next_slot(input, bench));
    case 14:
        return fmi2FreeFMUstate(c, next_slot(input, bench));
    case 15:
        return carry_state(input, input, bench, c);
    case 16:
        return directional(input, c);
    case 17:
        vr = next_reference(input);
        integer = (int)(next_byte(input) % 3);
        return fmi2GetRealOutputDerivatives(c, &vr, 1, &integer, &real);
    case 18:
    case 19:
        vr = next_input(input);
        integer = next_byte(input) % 16 ? 1 : 2;
        real = next_real(input);
        return fmi2SetRealInputDerivatives(c, &vr, 1, &integer, &real);
    case 20: {
        const fmi2String categories[] = {"logEvents", "logStatusError", "logNothing", NULL};
        return fmi2SetDebugLogging(c, (int)(next_byte(input) % 2), next_byte(input) % 5 % 4,
                                   categories + next_byte(input) % 2);
    }
    case 21:
        return fmi2GetRealStatus(c, (fmi2StatusKind)(next_byte(input) % 5), &real);
    case 22:
        return fmi2GetBooleanStatus(c, (fmi2StatusKind)(next_byte(input) % 5), &integer);
    case 23:
        return fmi2CancelStep(c);
    case 24:
        return fmi2SetTime(c, next_real(input));
    case 25:
    case 26:
    case 27:
        return set_reals(input, c);
    default:
        return step(input, bench, c);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz((Bytes){data, data + size}, fmi2CoSimulation, 40, call);
}
