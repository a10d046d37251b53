// Time derivatives in co-simulation: of inputs, given, and of F_t, F_y, body.v and body.x.
#include <math.h>

#include "fmi2/instance.h"
#include "fmi2/log.h"
#include "fmi2/sensitivity.h"
#include "fmi2/variables.h"

// Whether the arrays exist and name time derivatives of order 1 of variables of the causality. Logs the
// reason if not.
static bool asks_for_rates(const FcInstance* instance, FcCall call, FcCausality causality,
                           const fmi2ValueReference vr[], size_t nvr, const fmi2Integer order[],
                           const fmi2Real value[]) {
    if (nvr > 0 && (!vr || !order || !value)) {
        fc_refuse(instance, call, "vr, order or value is NULL");
        return false;
    }
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = fc_expect_variable(instance, call, vr[i], causality);
        if (!info) {
            return false;
        }
        if (order[i] != 1) {
            fc_refuse(instance, call, "order = %d of %s: only order 1 is supported", order[i], info->name);
            return false;
        }
    }
    return true;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    const FcCall call = FC_CALL_SET_REAL_INPUT_DERIVATIVES;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance || !asks_for_rates(instance, call, FC_CAUSALITY_INPUT, vr, nvr, order, value)) {
        return fmi2Error;
    }
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = &fc_variables[vr[i]];
        if (!isfinite(value[i])) {
            return fc_refuse(instance, call, "derivative of %s = %s per s is not a finite number", info->name,
                             fc_quantity_text(value[i], info->unit).text);
        }
    }
    for (size_t i = 0; i < nvr; i++) {
        instance->contact.state.rates.next[fc_variable_input(&fc_variables[vr[i]])] = value[i];
        instance->contact.state.rates.next_is_set = 1;
    }
    instance->experiment.outputs_stale |= nvr > 0;
    return fmi2OK;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                        const fmi2Integer order[], fmi2Real value[]) {
    const FcCall call = FC_CALL_GET_REAL_OUTPUT_DERIVATIVES;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance || !asks_for_rates(instance, call, FC_CAUSALITY_OUTPUT, vr, nvr, order, value)) {
        return fmi2Error;
    }
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = &fc_variables[vr[i]];
        const size_t place = info->offset;
        if (place != offsetof(FcVariables, F_t) && place != offsetof(FcVariables, F_y) &&
            place != offsetof(FcVariables, body.v) && place != offsetof(FcVariables, body.x)) {
            return fc_refuse(instance, call,
                             "%s has no derivative in time here: only F_t, F_y, body.v and body.x have",
                             info->name);
        }
    }
    FcMessage message;
    if (!fc_instance_refresh_outputs(instance, &message)) {
        return fc_refuse(instance, call, "the outputs can't be computed: %s", message.text);
    }
    const FcVariables* v = &instance->contact.state.variables;
    const FcVector rate = fc_friction_contact_force_rate(&instance->contact);
    const double acceleration = v->body.m > 0.0 ? (v->body.F - v->F_t) / v->body.m : 0.0;
    const FcVariables rates = {.F_t = rate.x, .F_y = rate.y, .body = {.v = acceleration, .x = v->body.v}};
    if (!isfinite(rate.x) || !isfinite(rate.y)) {
        return fc_refuse(instance, call, "the time derivative of %s is beyond the largest number",
                         isfinite(rate.x) ? "F_y" : "F_t");
    }
    for (size_t i = 0; i < nvr; i++) {
        value[i] = fc_variable_value(&rates, &fc_variables[vr[i]]);
    }
    return fmi2OK;
}
