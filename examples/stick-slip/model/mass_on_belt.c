// MassOnBelt.fmu: a mass on a spring and a damper, pushed by the friction of a moving belt.
//
//        k, c      +-------+
//     |~~~~~~~~~~~~|   m   |--> x        m x'' + c x' + k x = F
//     |            +-------+
//       ---------------------------> belt, V_0 + V_1 sin(2 pi f t)        V = belt - x'
//
// The output V goes to the friction contact, whose force comes back as the input F. F is held over a step, and the
// step is then exact at any length: a decaying oscillation about x = F/k. Needs c < 2 sqrt(k m).
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fmi2Functions.h>

// Value references, in the order of modelDescription.xml.
enum {
    FORCE,
    SLIDING_VELOCITY,
    POSITION,
    VELOCITY,
    MASS,
    STIFFNESS,
    DAMPING,
    BELT_MEAN,
    BELT_AMPLITUDE,
    BELT_FREQUENCY,
    POSITION_0,
    VELOCITY_0,
    VARIABLES
};

typedef enum { INPUT, OUTPUT, PARAMETER } Causality;

typedef struct {
    const char* name;
    double start;
    double min;
    Causality causality;
} Variable;

static const Variable variables[VARIABLES] = {
    [FORCE] = {"F", 0.0, -INFINITY, INPUT},
    [SLIDING_VELOCITY] = {"V", 0.0, -INFINITY, OUTPUT},
    [POSITION] = {"x", 0.0, -INFINITY, OUTPUT},
    [VELOCITY] = {"v", 0.0, -INFINITY, OUTPUT},
    [MASS] = {"m", 5.0, 1e-9, PARAMETER},
    [STIFFNESS] = {"k", 5e4, 1e-9, PARAMETER},
    [DAMPING] = {"c", 50.0, 0.0, PARAMETER},
    [BELT_MEAN] = {"belt.V_0", 0.01, -INFINITY, PARAMETER},
    [BELT_AMPLITUDE] = {"belt.V_1", 0.0, -INFINITY, PARAMETER},
    [BELT_FREQUENCY] = {"belt.f", 2.0, 0.0, PARAMETER},
    [POSITION_0] = {"x_0", 0.0, -INFINITY, PARAMETER},
    [VELOCITY_0] = {"v_0", 0.0, -INFINITY, PARAMETER},
};

typedef struct {
    fmi2CallbackFunctions callbacks;
    double value[VARIABLES];
    double time;   // s
    bool stepping; // initialization is over
    char name[];
} Instance;

static fmi2Status refuse(Instance* instance, const char* format, ...) {
    char text[200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (instance->callbacks.logger) {
        instance->callbacks.logger(instance->callbacks.componentEnvironment, instance->name, fmi2Error,
                                   "logStatusError", "%s", text);
    }
    return fmi2Error;
}

static double belt_velocity(const double* value, double time) {
    const double two_pi = 6.283185307179586;
    return value[BELT_MEAN] + value[BELT_AMPLITUDE] * sin(two_pi * value[BELT_FREQUENCY] * time);
}

// Position and velocity after h [s] under the held force: y'' + 2 g y' + (g^2 + w^2) y = 0 for y = x - F/k.
static void advance_mass(double* value, double h) {
    const double rest = value[FORCE] / value[STIFFNESS];
    const double g = value[DAMPING] / (2.0 * value[MASS]);
    const double w = sqrt(value[STIFFNESS] / value[MASS] - g * g);
    const double y = value[POSITION] - rest, v = value[VELOCITY];
    const double decay = exp(-g * h), cosine = cos(w * h), sine = sin(w * h) / w;
    value[POSITION] = rest + decay * (y * cosine + (v + g * y) * sine);
    value[VELOCITY] = decay * (v * cosine - (g * v + (g * g + w * w) * y) * sine);
}

static void set_start_values(Instance* instance) {
    for (int i = 0; i < VARIABLES; i++) {
        instance->value[i] = variables[i].start;
    }
    instance->time = 0.0;
    instance->stepping = false;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* functions, fmi2Boolean visible,
                              fmi2Boolean loggingOn) {
    (void)resources, (void)visible, (void)loggingOn;
    if (!functions || !name || !guid || type != fmi2CoSimulation || strcmp(guid, MODEL_GUID) != 0) {
        return NULL;
    }
    Instance* instance = calloc(1, sizeof *instance + strlen(name) + 1);
    if (instance) {
        strcpy(instance->name, name);
        instance->callbacks = *functions;
        set_start_values(instance);
    }
    return instance;
}

void fmi2FreeInstance(fmi2Component c) { free(c); }

fmi2Status fmi2Reset(fmi2Component c) {
    set_start_values(c);
    return fmi2OK;
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean stopDefined, fmi2Real stop) {
    (void)toleranceDefined, (void)tolerance, (void)stopDefined, (void)stop;
    Instance* instance = c;
    instance->time = start;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return c ? fmi2OK : fmi2Error; }

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    Instance* instance = c;
    const double critical = 2.0 * sqrt(instance->value[STIFFNESS] * instance->value[MASS]);
    if (!(instance->value[DAMPING] < critical)) {
        return refuse(instance, "c = %g N s/m: must be below the critical damping 2 sqrt(k m) = %g N s/m",
                      instance->value[DAMPING], critical);
    }
    instance->stepping = true;
    return fmi2OK;
}

fmi2Status fmi2Terminate(fmi2Component c) { return c ? fmi2OK : fmi2Error; }

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2Real value[]) {
    Instance* instance = c;
    for (size_t i = 0; i < count; i++) {
        if (vr[i] >= VARIABLES) {
            return refuse(instance, "value reference %u is unknown", vr[i]);
        }
    }
    instance->value[SLIDING_VELOCITY] =
        belt_velocity(instance->value, instance->time) - instance->value[VELOCITY];
    for (size_t i = 0; i < count; i++) {
        value[i] = instance->value[vr[i]];
    }
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2Real value[]) {
    Instance* instance = c;
    for (size_t i = 0; i < count; i++) {
        if (vr[i] >= VARIABLES || variables[vr[i]].causality == OUTPUT) {
            return refuse(instance, "value reference %u can't be set", vr[i]);
        }
        const Variable* variable = &variables[vr[i]];
        if (variable->causality == PARAMETER && instance->stepping) {
            return refuse(instance, "%s can't be set after the initialization", variable->name);
        }
        if (!isfinite(value[i]) || value[i] < variable->min) {
            return refuse(instance, "%s = %g: must be finite and at least %g", variable->name, value[i],
                          variable->min);
        }
    }
    for (size_t i = 0; i < count; i++) {
        instance->value[vr[i]] = value[i];
    }
    if (!instance->stepping) {
        instance->value[POSITION] = instance->value[POSITION_0];
        instance->value[VELOCITY] = instance->value[VELOCITY_0];
    }
    return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real h,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint) {
    (void)noSetFMUStatePriorToCurrentPoint;
    Instance* instance = c;
    if (!instance->stepping || !isfinite(time) || !isfinite(h) || h < 0.0) {
        return refuse(instance, "a step from %g s by %g s can't be taken", time, h);
    }
    advance_mass(instance->value, h);
    instance->time = time + h;
    return fmi2OK;
}
