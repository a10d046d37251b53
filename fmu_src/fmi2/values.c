// fmi2GetXXX and fmi2SetXXX. Each call takes all of its values or none.
#include "fmi2/variables.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#include "contact/settled_force.h"
#include "fmi2/instance.h"
#include "fmi2/log.h"
#include "fmi2/plausibility.h"

static const char* const TYPE_NAME[] = {
    [FC_TYPE_REAL] = "Real",
    [FC_TYPE_INTEGER] = "Integer",
    [FC_TYPE_BOOLEAN] = "Boolean",
    [FC_TYPE_STRING] = "String",
};

static fmi2Status refuse_reference(const FcInstance* instance, FcCall call, fmi2ValueReference vr,
                                   FcVariableType wanted) {
    if (vr >= fc_variables_count) {
        return fc_refuse(instance, call, "value reference %u is unknown; the largest is %u", vr,
                         fc_variables_count - 1);
    }
    const FcVariableInfo* info = &fc_variables[vr];
    if (info->type == FC_TYPE_ENUMERATION) {
        return fc_refuse(instance, call,
                         "%s (value reference %u) is an Enumeration: use the Integer functions", info->name,
                         vr);
    }
    return fc_refuse(instance, call, "%s (value reference %u) is a %s, not a%s %s", info->name, vr,
                     TYPE_NAME[info->type], wanted == FC_TYPE_INTEGER ? "n" : "", TYPE_NAME[wanted]);
}

// Whether the arrays exist and all references are variables of the type. The functions for Integer serve
// enumerations. Logs the reason if not.
static bool are_variables(const FcInstance* instance, FcCall call, const fmi2ValueReference vr[], size_t nvr,
                          const void* value, FcVariableType type) {
    if (nvr > 0 && (!vr || !value)) {
        fc_refuse(instance, call, "vr or value is NULL");
        return false;
    }
    for (size_t i = 0; i < nvr; i++) {
        if (vr[i] >= fc_variables_count || fc_variables[vr[i]].type != type) {
            refuse_reference(instance, call, vr[i], type == FC_TYPE_ENUMERATION ? FC_TYPE_INTEGER : type);
            return false;
        }
    }
    return true;
}

static fmi2Status refuse_real(const FcInstance* instance, const FcVariableInfo* info, double value) {
    const FcQuantityText given = fc_quantity_text(value, info->unit);
    const FcQuantityText min = fc_quantity_text(info->min, info->unit);
    const FcQuantityText max = fc_quantity_text(info->max, info->unit);
    if (!isfinite(value)) {
        const bool has_min = info->min > -DBL_MAX;
        const bool has_max = info->max < DBL_MAX;
        return fc_refuse(instance, FC_CALL_SET_REAL, "%s = %s is not a finite number%s%s%s%s", info->name,
                         given.text, has_min ? "; its minimum is " : "", has_min ? min.text : "",
                         has_max ? "; its maximum is " : "", has_max ? max.text : "");
    }
    const bool is_below = value < info->min;
    return fc_refuse(instance, FC_CALL_SET_REAL, "%s = %s is %s %s", info->name, given.text,
                     is_below ? "below its minimum" : "above its maximum", is_below ? min.text : max.text);
}

static fmi2Status refuse_literal(const FcInstance* instance, const FcVariableInfo* info, int value) {
    char literals[160];
    size_t length = 0;
    for (int i = 0; i < (int)info->max && length < sizeof literals; i++) {
        length += (size_t)snprintf(literals + length, sizeof literals - length, "%s%d (%s)",
                                   i > 0 ? ", " : "", i + 1, info->literals[i]);
    }
    return fc_refuse(instance, FC_CALL_SET_INTEGER, "%s = %d is not one of its values: %s", info->name, value,
                     literals);
}

// Inputs and tunable parameters can be set in every state in which setting is legal, fixed parameters not after
// initialization, outputs and local variables never. Beyond the standard, in continuous-time mode: the parameters
// like inputs, and the states, since some hosts (CasADi) set them by fmi2SetReal while they integrate.
static bool is_settable(const FcInstance* instance, const FcVariableInfo* info) {
    const int mode = instance->experiment.mode;
    if (info->causality != FC_CAUSALITY_PARAMETER) {
        return info->causality == FC_CAUSALITY_INPUT ||
               (mode == FC_CONTINUOUS_TIME_MODE && fc_variable_is_state(info));
    }
    return mode == FC_INSTANTIATED || mode == FC_INITIALIZATION_MODE ||
           info->variability == FC_VARIABILITY_TUNABLE;
}

static fmi2Status refuse_setting(const FcInstance* instance, FcCall call, const FcVariableInfo* info) {
    if (info->causality == FC_CAUSALITY_PARAMETER) {
        return fc_refuse(instance, call, "%s is a fixed parameter and can't be set after initialization",
                         info->name);
    }
    return fc_refuse(instance, call, "%s is %s variable and can't be set", info->name,
                     info->causality == FC_CAUSALITY_OUTPUT  ? "an output"
                     : info->causality == FC_CAUSALITY_LOCAL ? "a local"
                                                             : "the independent");
}

static bool is_computed(const FcVariableInfo* info) {
    return info->causality == FC_CAUSALITY_OUTPUT || info->causality == FC_CAUSALITY_LOCAL;
}

static bool have_equal_causes(const FcVariables* a, const FcVariables* b) {
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        const bool counts = !is_computed(info) || info->offset == offsetof(FcVariables, body.v);
        if (counts && fc_variable_value(a, info) != fc_variable_value(b, info)) {
            return false;
        }
    }
    return true;
}

// An importer that records all outputs reads F_t_settled at each of them, mostly with the same inputs and
// parameters.
static bool settled_force(FcInstance* instance, FcVector* force, FcMessage* message) {
    const FcVariables* now = &instance->contact.state.variables;
    if (!have_equal_causes(now, &instance->settled_force_of)) {
        FcVector found;
        if (!fc_settled_force(&instance->contact, &found, message)) {
            return false;
        }
        fc_log_scatter(instance, FC_CALL_GET_REAL);
        instance->settled_force = found;
        instance->settled_force_of = *now;
    }
    *force = instance->settled_force;
    return true;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[]) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_GET_REAL);
    if (!instance || !are_variables(instance, FC_CALL_GET_REAL, vr, nvr, value, FC_TYPE_REAL)) {
        return fmi2Error;
    }
    bool computed = false, rates = false, settled = false;
    for (size_t i = 0; i < nvr; i++) {
        computed |= is_computed(&fc_variables[vr[i]]);
        rates |= fc_variable_is_rate(&fc_variables[vr[i]]);
        settled |= fc_variable_is_settled_force(&fc_variables[vr[i]]);
    }
    FcMessage message;
    FcVector of_settled = {0.0, 0.0};
    if ((computed &&
         !(rates ? fc_instance_refresh_rates : fc_instance_refresh_outputs)(instance, &message)) ||
        (settled && !settled_force(instance, &of_settled, &message))) {
        return fc_refuse(instance, FC_CALL_GET_REAL, "the outputs can't be computed: %s", message.text);
    }
    FcVariables* variables = &instance->contact.state.variables;
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = &fc_variables[vr[i]];
        value[i] = info->offset == offsetof(FcVariables, F_t_settled)   ? of_settled.x
                   : info->offset == offsetof(FcVariables, F_y_settled) ? of_settled.y
                   : info->causality == FC_CAUSALITY_INDEPENDENT        ? instance->contact.state.clock.time
                                                                        : *fc_variable_real(variables, info);
    }
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[]) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_SET_REAL);
    if (!instance || !are_variables(instance, FC_CALL_SET_REAL, vr, nvr, value, FC_TYPE_REAL)) {
        return fmi2Error;
    }
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = &fc_variables[vr[i]];
        if (!is_settable(instance, info)) {
            return refuse_setting(instance, FC_CALL_SET_REAL, info);
        }
        if (!fc_variable_allows(info, value[i])) {
            return refuse_real(instance, info, value[i]);
        }
    }
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = &fc_variables[vr[i]];
        *fc_variable_real(&instance->contact.state.variables, info) = value[i];
        if (info->causality == FC_CAUSALITY_INPUT) { // its rate in the last step counts no longer
            instance->contact.state.rates.last[fc_variable_input(info)] = 0.0;
        }
        if (info->offset == offsetof(FcVariables, solver.tolerance)) {
            instance->experiment.tolerance_is_set = 1;
        }
    }
    instance->experiment.outputs_stale |= nvr > 0;
    return fmi2OK;
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Integer value[]) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_GET_INTEGER);
    if (!instance || !are_variables(instance, FC_CALL_GET_INTEGER, vr, nvr, value, FC_TYPE_ENUMERATION)) {
        return fmi2Error;
    }
    for (size_t i = 0; i < nvr; i++) {
        value[i] = *fc_variable_integer(&instance->contact.state.variables, &fc_variables[vr[i]]);
    }
    return fmi2OK;
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          const fmi2Integer value[]) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_SET_INTEGER);
    if (!instance || !are_variables(instance, FC_CALL_SET_INTEGER, vr, nvr, value, FC_TYPE_ENUMERATION)) {
        return fmi2Error;
    }
    for (size_t i = 0; i < nvr; i++) {
        const FcVariableInfo* info = &fc_variables[vr[i]];
        if (!is_settable(instance, info)) {
            return refuse_setting(instance, FC_CALL_SET_INTEGER, info);
        }
        if (!fc_variable_allows(info, value[i])) {
            return refuse_literal(instance, info, value[i]);
        }
    }
    for (size_t i = 0; i < nvr; i++) {
        *fc_variable_integer(&instance->contact.state.variables, &fc_variables[vr[i]]) = value[i];
    }
    instance->experiment.outputs_stale |= nvr > 0;
    return fmi2OK;
}

// The model has no Boolean and no String: any reference is an error, an empty request is allowed.
static fmi2Status access_absent_type(fmi2Component c, FcCall call, const fmi2ValueReference vr[], size_t nvr,
                                     FcVariableType type) {
    const FcInstance* instance = fc_instance_enter(c, call);
    if (!instance) {
        return fmi2Error;
    }
    if (nvr == 0) {
        return fmi2OK;
    }
    return vr ? refuse_reference(instance, call, vr[0], type) : fc_refuse(instance, call, "vr is NULL");
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Boolean value[]) {
    (void)value;
    return access_absent_type(c, FC_CALL_GET_BOOLEAN, vr, nvr, FC_TYPE_BOOLEAN);
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2String value[]) {
    (void)value;
    return access_absent_type(c, FC_CALL_GET_STRING, vr, nvr, FC_TYPE_STRING);
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          const fmi2Boolean value[]) {
    (void)value;
    return access_absent_type(c, FC_CALL_SET_BOOLEAN, vr, nvr, FC_TYPE_BOOLEAN);
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                         const fmi2String value[]) {
    (void)value;
    return access_absent_type(c, FC_CALL_SET_STRING, vr, nvr, FC_TYPE_STRING);
}
