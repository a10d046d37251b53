// Derivatives in time (of inputs, given; of F_t, exact) and of outputs with respect to inputs (analytic).
#include <math.h>

#include "fmi2/instance.h"
#include "fmi2/log.h"
#include "fmi2/values.h"
#include "model/derivatives.h"

// The variable of the reference if it has the causality; NULL after logging why not.
static const FcVariableInfo* expect(const FcInstance* instance, FcCall call, fmi2ValueReference vr,
                                    FcCausality causality) {
    if (vr >= fc_variables_count) {
        fc_refuse(instance, call, "value reference %u is unknown; the largest is %u", vr,
                  fc_variables_count - 1);
        return NULL;
    }
    const FcVariableInfo* info = &fc_variables[vr];
    if (info->causality != causality) {
        fc_refuse(instance, call, "%s (value reference %u) is not an %s", info->name, vr,
                  causality == FC_CAUSALITY_INPUT ? "input" : "output");
        return NULL;
    }
    return info;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    const FcCall call = FC_CALL_SET_REAL_INPUT_DERIVATIVES;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance) {
        return fmi2Error;
    }
    if (nvr > 0 && (!vr || !order || !value)) {
        return fc_refuse(instance, call, "vr, order or value is NULL");
    }
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = expect(instance, call, vr[i], FC_CAUSALITY_INPUT);
        if (!info) {
            return fmi2Error;
        }
        if (order[i] != 1) {
            return fc_refuse(instance, call, "order = %d of %s: only order 1 is supported", order[i],
                             info->name);
        }
        if (!isfinite(value[i])) {
            return fc_refuse(instance, call, "derivative of %s = %s per s is not a finite number", info->name,
                             fc_quantity_text(value[i], info->unit).text);
        }
    }
    for (size_t i = 0; i < nvr; i++) {
        instance->contact.state.next_rate[fc_variable_input(&fc_variables[vr[i]])] = value[i];
        instance->contact.state.next_rate_set = 1;
    }
    return fmi2OK;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                        const fmi2Integer order[], fmi2Real value[]) {
    const FcCall call = FC_CALL_GET_REAL_OUTPUT_DERIVATIVES;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance) {
        return fmi2Error;
    }
    if (nvr > 0 && (!vr || !order || !value)) {
        return fc_refuse(instance, call, "vr, order or value is NULL");
    }
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = expect(instance, call, vr[i], FC_CAUSALITY_OUTPUT);
        if (!info) {
            return fmi2Error;
        }
        if (info->offset != offsetof(FcVariables, F_t)) {
            return fc_refuse(instance, call, "%s has no derivative in time here: only F_t has", info->name);
        }
        if (order[i] != 1) {
            return fc_refuse(instance, call, "order = %d of %s: only order 1 is supported", order[i],
                             info->name);
        }
    }
    FcMessage message;
    if (!fc_instance_refresh_outputs(instance, &message)) {
        return fc_refuse(instance, call, "the outputs can't be computed: %s", message.text);
    }
    const FcScene scene = fc_friction_contact_scene(&instance->contact);
    const double rate = fc_force_rate(&scene, instance->contact.state.variables.delta);
    if (!isfinite(rate)) {
        return fc_refuse(instance, call, "the time derivative of F_t is beyond the largest number");
    }
    for (size_t i = 0; i < nvr; i++) {
        value[i] = rate;
    }
    return fmi2OK;
}

// The derivative of the output in the slopes; 0 for an output that does not depend on the present inputs. Before the
// first step F_t_mean is F_t.
static double slope_of(const FcSlopes* slopes, const FcVariableInfo* output, bool initializing) {
    switch (output->offset) {
    case offsetof(FcVariables, F_t):
        return slopes->F_t;
    case offsetof(FcVariables, F_n):
        return slopes->F_n;
    case offsetof(FcVariables, sigma):
        return slopes->sigma;
    case offsetof(FcVariables, A_r):
        return slopes->A_r;
    case offsetof(FcVariables, F_t_mean):
        return initializing ? slopes->F_t : 0.0;
    default:
        return 0.0;
    }
}

// Derivative of the output along the direction of the inputs.
static double along(const FcGradient* gradient, const FcVariableInfo* output, bool initializing,
                    const double direction[FC_INPUT_COUNT]) {
    const FcSlopes* slopes[FC_INPUT_COUNT] = {
        [FC_INPUT_V] = &gradient->by_V,
        [FC_INPUT_D] = &gradient->by_d,
        [FC_INPUT_E] = &gradient->by_E,
        [FC_INPUT_LOAD] = &gradient->by_load,
    };
    double derivative = 0.0;
    for (int input = 0; input < FC_INPUT_COUNT; input++) {
        const double slope = slope_of(slopes[input], output, initializing);
        derivative += slope != 0.0 ? slope * direction[input] : 0.0;
    }
    return derivative;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[],
                                        size_t nUnknown, const fmi2ValueReference vKnown_ref[], size_t nKnown,
                                        const fmi2Real dvKnown[], fmi2Real dvUnknown[]) {
    const FcCall call = FC_CALL_GET_DIRECTIONAL_DERIVATIVE;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance) {
        return fmi2Error;
    }
    if ((nUnknown > 0 && (!vUnknown_ref || !dvUnknown)) || (nKnown > 0 && (!vKnown_ref || !dvKnown))) {
        return fc_refuse(instance, call, "vUnknown_ref, vKnown_ref, dvKnown or dvUnknown is NULL");
    }
    double direction[FC_INPUT_COUNT] = {0.0};
    for (size_t k = 0; k < nKnown; k++) {
        const FcVariableInfo* info = expect(instance, call, vKnown_ref[k], FC_CAUSALITY_INPUT);
        if (!info) {
            return fmi2Error;
        }
        if (!isfinite(dvKnown[k])) {
            return fc_refuse(instance, call, "direction of %s = %s is not a finite number", info->name,
                             fc_quantity_text(dvKnown[k], info->unit).text);
        }
        direction[fc_variable_input(info)] += dvKnown[k];
    }
    for (size_t u = 0; u < nUnknown; u++) {
        if (!expect(instance, call, vUnknown_ref[u], FC_CAUSALITY_OUTPUT)) {
            return fmi2Error;
        }
    }
    FcMessage message;
    if (!fc_instance_refresh_outputs(instance, &message)) {
        return fc_refuse(instance, call, "the outputs can't be computed: %s", message.text);
    }
    const FcScene scene = fc_friction_contact_scene(&instance->contact);
    const FcGradient gradient = fc_gradient(&scene, instance->contact.state.variables.delta);
    const bool initializing = instance->experiment.mode == FC_INITIALIZATION_MODE;
    for (size_t u = 0; u < nUnknown; u++) {
        const FcVariableInfo* info = &fc_variables[vUnknown_ref[u]];
        if (!isfinite(along(&gradient, info, initializing, direction))) {
            return fc_refuse(instance, call, "the derivative of %s is beyond the largest number", info->name);
        }
    }
    for (size_t u = 0; u < nUnknown; u++) {
        const FcVariableInfo* info = &fc_variables[vUnknown_ref[u]];
        dvUnknown[u] = along(&gradient, info, initializing, direction);
    }
    return fmi2OK;
}
