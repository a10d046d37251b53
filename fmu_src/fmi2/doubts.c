#include "fmi2/doubts.h"

#include <math.h>
#include <stddef.h>

#include "fmi2/log.h"
#include "fmi2/variables.h"

// A setting, the enumeration that decides whether it is used, and the items with which it is, as bits.
enum { ITEM_1 = 1, ITEM_2 = 2, ITEM_3 = 4, ITEM_4 = 8 };
#define AT(name) offsetof(FcVariables, name)
static const struct {
    size_t setting, decider;
    unsigned items;
} USED[] = {
    {AT(load), AT(contact.input), ITEM_2},
    {AT(d), AT(contact.input), ITEM_1},
    {AT(contact.sigma), AT(contact.model), ITEM_2},
    {AT(contact.stiffnessScale), AT(contact.model), ITEM_1 | ITEM_3},
    {AT(F_C), AT(friction.limit), ITEM_1},
    {AT(friction.mu), AT(friction.limit), ITEM_2},
    {AT(friction.staticRatio), AT(friction.model), ITEM_3 | ITEM_4},
    {AT(friction.V_S), AT(friction.model), ITEM_3 | ITEM_4},
    {AT(friction.sigma_1), AT(friction.model), ITEM_1 | ITEM_3 | ITEM_4},
    {AT(delta_0), AT(friction.model), ITEM_1 | ITEM_3 | ITEM_4},
    {AT(delta_y_0), AT(friction.model), ITEM_1 | ITEM_3 | ITEM_4},
};

// The range of likely magnitudes of a value other than 0. Chosen empirically from machines; a wider range
// warns of fewer wrong units.
static const struct {
    size_t variable;
    double low, high;
} LIKELY[] = {
    {AT(V), 0.0, 100.0},
    {AT(V_y), 0.0, 100.0},
    {AT(d), 1e-9, 1e-3},
    {AT(E), 3e5, 1e13},
    {AT(contact.sigma), 100.0, 1e15},
    {AT(friction.mu), 0.0, 10.0},
    {AT(vibration.f), 100.0, 1e8},
    {AT(vibration.V_1), 1e-5, 100.0},
    {AT(vibration.V_2), 1e-5, 100.0},
    {AT(vibration.a_d), 0.0, 1e-3},
    {AT(vibration.phase_d), 0.0, 15.0},
    {AT(vibration.phase_2), 0.0, 15.0},
};

static const FcVariableInfo* variable_at(size_t offset) {
    const FcVariableInfo* info = fc_variables;
    while (info->offset != offset) {
        info++;
    }
    return info;
}

static void warn_unused(const FcInstance* instance, const FcVariableInfo* setting,
                        const FcVariableInfo* decider, unsigned items) {
    const FcVariables* v = &instance->contact.state.variables;
    const int item = (int)fc_variable_value(v, decider);
    if (fc_variable_value(v, setting) == setting->start || (items >> (item - 1) & 1u) != 0) {
        return;
    }
    fc_log(instance, FC_CALL_EXIT_INITIALIZATION_MODE, fmi2Warning, FC_LOG_STATUS_WARNING,
           "%s = %s has no effect: %s = %s", setting->name,
           fc_quantity_text(fc_variable_value(v, setting), setting->unit).text, decider->name,
           decider->literals[item - 1]);
}

// The largest likely deflection [m] of a settled start. Chosen empirically, as the largest delta_0 of
// frictioncontact/doubts.py. Half or twice of it moves the separation from which on a contact of the start
// values counts as nearly open, 32 um, by 0.6 um.
static const double LONGEST_BRISTLE = 1e-2;

// With a constant limit the settled bristle of a contact that opens grows without bound: it is F_C / sigma.
static void warn_nearly_open(const FcInstance* instance) {
    const FcVariables* v = &instance->contact.state.variables;
    const double delta = hypot(v->delta, v->delta_y);
    if (v->initialState == FC_STATE_SETTLED && delta > LONGEST_BRISTLE &&
        v->friction.limit == FC_LIMIT_CONSTANT && v->contact.model != FC_CONTACT_CONSTANT) {
        fc_log(instance, FC_CALL_EXIT_INITIALIZATION_MODE, fmi2Warning, FC_LOG_STATUS_WARNING,
               "initialState = Settled deflects the bristle by %s: the contact is nearly open (sigma = %s), "
               "but with friction.limit = Constant F_t still tends to F_C = %s",
               fc_quantity_text(delta, "m").text, fc_quantity_text(v->sigma, "N/m").text,
               fc_quantity_text(v->F_C, "N").text);
    }
}

void fc_log_doubts(const FcInstance* instance) {
    warn_nearly_open(instance);
    for (size_t i = 0; i < sizeof USED / sizeof *USED; i++) {
        warn_unused(instance, variable_at(USED[i].setting), variable_at(USED[i].decider), USED[i].items);
    }
    for (size_t i = 0; i < sizeof LIKELY / sizeof *LIKELY; i++) {
        const FcVariableInfo* info = variable_at(LIKELY[i].variable);
        const double value = fc_variable_value(&instance->contact.state.variables, info);
        if (value != 0.0 && !(fabs(value) >= LIKELY[i].low && fabs(value) <= LIKELY[i].high)) {
            fc_log(instance, FC_CALL_EXIT_INITIALIZATION_MODE, fmi2Warning, FC_LOG_STATUS_WARNING,
                   "%s = %s is an unlikely magnitude: the unit is %s", info->name,
                   fc_quantity_text(value, info->unit).text, info->unit);
        }
    }
}
