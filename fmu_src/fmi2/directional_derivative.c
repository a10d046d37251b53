// Directional derivatives: by inputs, tunable parameters and time from initialization mode on, and then by the states too.
#include <math.h>
#include <string.h>

#include "fmi2/instance.h"
#include "fmi2/log.h"
#include "fmi2/sensitivity.h"
#include "fmi2/variables.h"

// The variable by which a derivative is asked for; otherwise NULL, after logging the reason.
static const FcVariableInfo* expect_known(const FcInstance* instance, fmi2ValueReference vr) {
    const FcCall call = FC_CALL_GET_DIRECTIONAL_DERIVATIVE;
    const FcFriction* friction = &instance->contact.state.variables.friction;
    if (vr >= fc_variables_count) {
        return fc_expect_variable(instance, call, vr, FC_CAUSALITY_INPUT); // none
    }
    const FcVariableInfo* info = &fc_variables[vr];
    const bool is_started = instance->experiment.mode != FC_INITIALIZATION_MODE;
    if (!fc_has_sensitivity(info) && !(is_started && fc_variable_is_state(info))) {
        fc_refuse(instance, call,
                  "%s (value reference %u) is not an input, a tunable parameter, time or, after "
                  "initialization, a state",
                  info->name, vr);
        return NULL;
    }
    if (info->offset == offsetof(FcVariables, friction.staticRatio) && fc_may_stick(friction) &&
        friction->staticRatio == 1.0) {
        fc_refuse(instance, call,
                  "%s = 1: a slipping bristle would stick at any larger ratio, so that there is no "
                  "derivative",
                  info->name);
        return NULL;
    }
    return info;
}

// Reads the direction; false after logging the fault.
static bool read_direction(const FcInstance* instance, const fmi2ValueReference vr[], size_t n,
                           const fmi2Real change[], FcVariables* direction) {
    const FcCall call = FC_CALL_GET_DIRECTIONAL_DERIVATIVE;
    for (size_t k = 0; k < n; k++) {
        const FcVariableInfo* info = expect_known(instance, vr[k]);
        if (!info) {
            return false;
        }
        if (!isfinite(change[k])) {
            fc_refuse(instance, call, "direction of %s = %s is not a finite number", info->name,
                      fc_quantity_text(change[k], info->unit).text);
            return false;
        }
        *fc_variable_real(direction, info) += change[k];
    }
    return true;
}

// Whether an output or rate has a derivative by the variable; otherwise false, after logging the reason. Means of a
// step, and a settled start, are results of many periods, which are not differentiated.
static bool has_derivative(const FcInstance* instance, const FcVariableInfo* unknown,
                           const FcVariableInfo* known) {
    const size_t place = unknown->offset;
    const bool is_mean = place == offsetof(FcVariables, F_t_mean) || place == offsetof(FcVariables, F_y_mean);
    const bool is_body = place == offsetof(FcVariables, body.v) || place == offsetof(FcVariables, body.x);
    const bool is_force = place == offsetof(FcVariables, F_t) || place == offsetof(FcVariables, F_y);
    const bool is_state = fc_variable_is_state(unknown);
    const char* reason = NULL;
    if (instance->experiment.mode == FC_INITIALIZATION_MODE) {
        const bool is_settled = instance->contact.state.variables.initialState == FC_STATE_SETTLED;
        if (is_settled && (is_mean || is_force || is_state || fc_variable_is_rate(unknown))) {
            reason = "in initialization mode with initialState = Settled; afterwards it has";
        }
    } else if (!fc_instance_is_ode(instance) && known->causality == FC_CAUSALITY_PARAMETER &&
               (is_mean || is_state || is_body)) {
        reason = "in co-simulation, since the last step left it; F_t_settled and F_y_settled have";
    }
    if (reason) {
        fc_refuse(instance, FC_CALL_GET_DIRECTIONAL_DERIVATIVE, "%s has no derivative by %s %s",
                  unknown->name, known->name, reason);
    }
    return reason == NULL;
}

// In five steps: the arguments; the direction of the knowns; whether each unknown has a derivative by each known; the slopes
// of all outputs along the direction; the asked ones, of which each must be a number before one is written.
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
    FcVariables direction;
    memset(&direction, 0, sizeof direction);
    if (!read_direction(instance, vKnown_ref, nKnown, dvKnown, &direction)) {
        return fmi2Error;
    }
    bool asks_settled = false;
    for (size_t u = 0; u < nUnknown; u++) {
        const bool is_rate =
            vUnknown_ref[u] < fc_variables_count && fc_variable_is_rate(&fc_variables[vUnknown_ref[u]]);
        if (!is_rate && !fc_expect_variable(instance, call, vUnknown_ref[u], FC_CAUSALITY_OUTPUT)) {
            return fmi2Error;
        }
        for (size_t k = 0; k < nKnown; k++) {
            if (!has_derivative(instance, &fc_variables[vUnknown_ref[u]], &fc_variables[vKnown_ref[k]])) {
                return fmi2Error;
            }
        }
        asks_settled |= fc_variable_is_settled_force(&fc_variables[vUnknown_ref[u]]);
    }
    FcMessage message;
    FcVector of_settled = {0.0, 0.0};
    if (!fc_instance_refresh_outputs(instance, &message) ||
        (asks_settled && !fc_settled_sensitivities(&instance->contact, direction, &of_settled, &message))) {
        return fc_refuse(instance, call, "the outputs can't be computed: %s", message.text);
    }
    FcVariables slopes = fc_sensitivities(instance, &direction);
    slopes.F_t_settled = of_settled.x;
    slopes.F_y_settled = of_settled.y;
    for (size_t u = 0; u < nUnknown; u++) {
        const FcVariableInfo* info = &fc_variables[vUnknown_ref[u]];
        if (!isfinite(fc_variable_value(&slopes, info))) {
            return fc_refuse(instance, call,
                             "the derivative of %s does not exist here, or is beyond the largest number",
                             info->name);
        }
    }
    for (size_t u = 0; u < nUnknown; u++) {
        dvUnknown[u] = fc_variable_value(&slopes, &fc_variables[vUnknown_ref[u]]);
    }
    return fmi2OK;
}
