// The functions that importers look up in every co-simulation FMU and that MassOnBelt has no use for: no variable
// but Real ones, no saved states, no derivatives, no asynchronous steps. None is promised by its model description.
#include <fmi2Functions.h>

const char* fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char* fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[]) {
    (void)on, (void)count, (void)categories;
    return c ? fmi2OK : fmi2Error;
}

// Importers may ask for no variables of a type, which any FMU can give.
static fmi2Status none(size_t count) { return count == 0 ? fmi2OK : fmi2Error; }

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2Integer value[]) {
    (void)c, (void)vr, (void)value;
    return none(count);
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2Boolean value[]) {
    (void)c, (void)vr, (void)value;
    return none(count);
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2String value[]) {
    (void)c, (void)vr, (void)value;
    return none(count);
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                          const fmi2Integer value[]) {
    (void)c, (void)vr, (void)value;
    return none(count);
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                          const fmi2Boolean value[]) {
    (void)c, (void)vr, (void)value;
    return none(count);
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                         const fmi2String value[]) {
    (void)c, (void)vr, (void)value;
    return none(count);
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
    (void)c, (void)state;
    return fmi2Error;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
    (void)c, (void)state;
    return fmi2Error;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* state) {
    (void)c, (void)state;
    return fmi2Error;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t* size) {
    (void)c, (void)state, (void)size;
    return fmi2Error;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    (void)c, (void)state, (void)bytes, (void)size;
    return fmi2Error;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                   fmi2FMUstate* state) {
    (void)c, (void)bytes, (void)size, (void)state;
    return fmi2Error;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
                                        const fmi2ValueReference known[], size_t knowns,
                                        const fmi2Real known_values[], fmi2Real unknown_values[]) {
    (void)c, (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)known_values,
        (void)unknown_values;
    return fmi2Error;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    (void)c, (void)vr, (void)order, (void)value;
    return none(count);
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                        const fmi2Integer order[], fmi2Real value[]) {
    (void)c, (void)vr, (void)order, (void)value;
    return none(count);
}

fmi2Status fmi2CancelStep(fmi2Component c) {
    (void)c;
    return fmi2Error;
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status* value) {
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real* value) {
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer* value) {
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean* value) {
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String* value) {
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}
