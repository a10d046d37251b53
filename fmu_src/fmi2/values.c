// fmi2GetXXX and fmi2SetXXX. Each call takes all of its values or none.
#include "fmi2/values.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#include "fmi2/instance.h"
#include "fmi2/log.h"

static const char* type_name(VariableType type) {
    switch (type) {
    case TYPE_REAL:
        return "Real";
    case TYPE_INTEGER:
        return "Integer";
    case TYPE_BOOLEAN:
        return "Boolean";
    case TYPE_STRING:
        return "String";
    case TYPE_ENUMERATION:
        return "Enumeration";
    }
    return "unknown";
}

static fmi2Status refuse_reference(const Instance* instance, Call call, fmi2ValueReference vr,
                                   VariableType wanted) {
    if (vr >= variables_count) {
        return refuse(instance, call, "value reference %u is unknown; the largest is %u", vr,
                      variables_count - 1);
    }
    const VariableInfo* info = &variables_table[vr];
    if (info->type == TYPE_ENUMERATION) {
        return refuse(instance, call, "%s (value reference %u) is an Enumeration: use the Integer functions",
                      info->name, vr);
    }
    return refuse(instance, call, "%s (value reference %u) is a %s, not a%s %s", info->name, vr,
                  type_name(info->type), wanted == TYPE_INTEGER ? "n" : "", type_name(wanted));
}

static int is_variable_of_type(fmi2ValueReference vr, VariableType type) {
    return vr < variables_count && variables_table[vr].type == type;
}

static fmi2Status refuse_real(const Instance* instance, const VariableInfo* info, double value) {
    const QuantityText given = quantity_text(value, info->unit);
    const QuantityText min = quantity_text(info->min, info->unit);
    const QuantityText max = quantity_text(info->max, info->unit);
    if (!isfinite(value)) {
        const int has_min = info->min > -DBL_MAX;
        const int has_max = info->max < DBL_MAX;
        return refuse(instance, CALL_SET_REAL, "%s = %s is not a finite number%s%s%s%s", info->name,
                      given.text, has_min ? "; its minimum is " : "", has_min ? min.text : "",
                      has_max ? "; its maximum is " : "", has_max ? max.text : "");
    }
    const int is_below = value < info->min;
    return refuse(instance, CALL_SET_REAL, "%s = %s is %s %s", info->name, given.text,
                  is_below ? "below its minimum" : "above its maximum", is_below ? min.text : max.text);
}

static fmi2Status refuse_literal(const Instance* instance, const VariableInfo* info, int value) {
    char literals[160];
    size_t length = 0;
    for (int i = 0; i < (int)info->max && length < sizeof literals; i++) {
        length += (size_t)snprintf(literals + length, sizeof literals - length, "%s%d (%s)",
                                   i > 0 ? ", " : "", i + 1, info->literals[i]);
    }
    return refuse(instance, CALL_SET_INTEGER, "%s = %d is not one of its values: %s", info->name, value,
                  literals);
}

// Inputs and tunable parameters can be set in every state in which setting is legal at all, fixed parameters
// until initialization ends, outputs and local variables never.
static int is_settable(const Instance* instance, const VariableInfo* info) {
    if (info->causality == CAUSALITY_INPUT) {
        return 1;
    }
    return info->causality == CAUSALITY_PARAMETER &&
           (info->variability == VARIABILITY_TUNABLE || instance->machine.state != STEP_COMPLETE);
}

static fmi2Status refuse_setting(const Instance* instance, Call call, const VariableInfo* info) {
    if (info->causality == CAUSALITY_PARAMETER) {
        return refuse(instance, call, "%s is a fixed parameter and can't be set after initialization",
                      info->name);
    }
    return refuse(instance, call, "%s is %s variable and can't be set", info->name,
                  info->causality == CAUSALITY_OUTPUT ? "an output" : "a local");
}

static int is_computed(const VariableInfo* info) {
    return info->causality == CAUSALITY_OUTPUT || info->causality == CAUSALITY_LOCAL;
}

static int arrays_are_missing(const void* vr, size_t nvr, const void* value) {
    return nvr > 0 && (!vr || !value);
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[]) {
    Instance* instance = instance_enter(c, CALL_GET_REAL);
    if (!instance) {
        return fmi2Error;
    }
    if (arrays_are_missing(vr, nvr, value)) {
        return refuse(instance, CALL_GET_REAL, "vr or value is NULL");
    }
    int computed = 0;
    for (size_t i = 0; i < nvr; i++) {
        if (!is_variable_of_type(vr[i], TYPE_REAL)) {
            return refuse_reference(instance, CALL_GET_REAL, vr[i], TYPE_REAL);
        }
        computed |= is_computed(&variables_table[vr[i]]);
    }
    if (computed) {
        Message message;
        if (!instance_refresh_outputs(instance, &message)) {
            return refuse(instance, CALL_GET_REAL, "the outputs can't be computed: %s", message.text);
        }
    }
    for (size_t i = 0; i < nvr; i++) {
        value[i] = *variable_real(&instance->contact.state.variables, &variables_table[vr[i]]);
    }
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[]) {
    Instance* instance = instance_enter(c, CALL_SET_REAL);
    if (!instance) {
        return fmi2Error;
    }
    if (arrays_are_missing(vr, nvr, value)) {
        return refuse(instance, CALL_SET_REAL, "vr or value is NULL");
    }
    for (size_t i = 0; i < nvr; i++) {
        if (!is_variable_of_type(vr[i], TYPE_REAL)) {
            return refuse_reference(instance, CALL_SET_REAL, vr[i], TYPE_REAL);
        }
        const VariableInfo* info = &variables_table[vr[i]];
        if (!is_settable(instance, info)) {
            return refuse_setting(instance, CALL_SET_REAL, info);
        }
        if (!variable_allows(info, value[i])) {
            return refuse_real(instance, info, value[i]);
        }
    }
    for (size_t i = 0; i < nvr; i++) {
        const VariableInfo* info = &variables_table[vr[i]];
        *variable_real(&instance->contact.state.variables, info) = value[i];
        if (info->offset == offsetof(Variables, solver.tolerance)) {
            instance->machine.tolerance_is_set = 1;
        }
    }
    instance->machine.outputs_stale |= nvr > 0;
    return fmi2OK;
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Integer value[]) {
    Instance* instance = instance_enter(c, CALL_GET_INTEGER);
    if (!instance) {
        return fmi2Error;
    }
    if (arrays_are_missing(vr, nvr, value)) {
        return refuse(instance, CALL_GET_INTEGER, "vr or value is NULL");
    }
    for (size_t i = 0; i < nvr; i++) {
        if (!is_variable_of_type(vr[i], TYPE_ENUMERATION)) {
            return refuse_reference(instance, CALL_GET_INTEGER, vr[i], TYPE_INTEGER);
        }
    }
    for (size_t i = 0; i < nvr; i++) {
        value[i] = *variable_integer(&instance->contact.state.variables, &variables_table[vr[i]]);
    }
    return fmi2OK;
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          const fmi2Integer value[]) {
    Instance* instance = instance_enter(c, CALL_SET_INTEGER);
    if (!instance) {
        return fmi2Error;
    }
    if (arrays_are_missing(vr, nvr, value)) {
        return refuse(instance, CALL_SET_INTEGER, "vr or value is NULL");
    }
    for (size_t i = 0; i < nvr; i++) {
        if (!is_variable_of_type(vr[i], TYPE_ENUMERATION)) {
            return refuse_reference(instance, CALL_SET_INTEGER, vr[i], TYPE_INTEGER);
        }
        const VariableInfo* info = &variables_table[vr[i]];
        if (!is_settable(instance, info)) {
            return refuse_setting(instance, CALL_SET_INTEGER, info);
        }
        if (!variable_allows(info, value[i])) {
            return refuse_literal(instance, info, value[i]);
        }
    }
    for (size_t i = 0; i < nvr; i++) {
        *variable_integer(&instance->contact.state.variables, &variables_table[vr[i]]) = value[i];
    }
    instance->machine.outputs_stale |= nvr > 0;
    return fmi2OK;
}

// The model has no Boolean and no String: any reference is an error, an empty request is not.
static fmi2Status access_absent_type(fmi2Component c, Call call, const fmi2ValueReference vr[], size_t nvr,
                                     VariableType type) {
    const Instance* instance = instance_enter(c, call);
    if (!instance) {
        return fmi2Error;
    }
    if (nvr == 0) {
        return fmi2OK;
    }
    return vr ? refuse_reference(instance, call, vr[0], type) : refuse(instance, call, "vr is NULL");
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Boolean value[]) {
    (void)value;
    return access_absent_type(c, CALL_GET_BOOLEAN, vr, nvr, TYPE_BOOLEAN);
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2String value[]) {
    (void)value;
    return access_absent_type(c, CALL_GET_STRING, vr, nvr, TYPE_STRING);
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          const fmi2Boolean value[]) {
    (void)value;
    return access_absent_type(c, CALL_SET_BOOLEAN, vr, nvr, TYPE_BOOLEAN);
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                         const fmi2String value[]) {
    (void)value;
    return access_absent_type(c, CALL_SET_STRING, vr, nvr, TYPE_STRING);
}
