#include "fmi2/plausibility.h"

#include <math.h>

#include "fmi2/log.h"
#include "fmi2/variables.h"

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
// frictioncontact/plausibility.py. Half or twice of it moves the separation from which on a contact of the start
// values counts as nearly open, 32 um, by 0.6 um.
static const double LONGEST_BRISTLE = 1e-2;

// With a constant limit the settled bristle of a contact that opens grows without bound: it is F_C / sigma.
static void warn_nearly_open(const FcInstance* instance) {
    const FcVariables* v = &instance->contact.state.variables;
    const double delta = fc_size(fc_friction_contact_bristle(&instance->contact));
    if (v->initialState == FC_STATE_SETTLED && delta > LONGEST_BRISTLE &&
        v->friction.limit == FC_LIMIT_CONSTANT && v->contact.model != FC_CONTACT_CONSTANT) {
        fc_log(instance, FC_CALL_EXIT_INITIALIZATION_MODE, fmi2Warning, FC_LOG_STATUS_WARNING,
               "initialState = Settled deflects the bristle by %s: the contact is nearly open (sigma = %s), "
               "but with friction.limit = Constant F_t still tends to F_C = %s",
               fc_quantity_text(delta, "m").text, fc_quantity_text(v->sigma, "N/m").text,
               fc_quantity_text(v->F_C, "N").text);
    }
}

enum { TOLD_SCATTER = 1 << 16 }; // of FcInstance.told, beside those of step.c

void fc_log_scatter(FcInstance* instance, FcCall call) {
    if (instance->contact.scatters && !(instance->told & TOLD_SCATTER)) {
        fc_log(instance, call, fmi2Warning, FC_LOG_STATUS_WARNING,
               "the settled state is chaotic: with friction.staticRatio = %s no period of the vibration "
               "repeats, so that "
               "F_t_settled, F_y_settled and initialState = Settled scatter. This warning appears once.",
               fc_quantity_text(instance->contact.state.variables.friction.staticRatio, "1").text);
        instance->told |= TOLD_SCATTER;
    }
}

void fc_log_plausibility(FcInstance* instance) {
    fc_log_scatter(instance, FC_CALL_EXIT_INITIALIZATION_MODE);
    warn_nearly_open(instance);
    for (unsigned i = 0; i < fc_uses_count; i++) {
        warn_unused(instance, &fc_variables[fc_uses[i].setting], &fc_variables[fc_uses[i].decider],
                    fc_uses[i].items);
    }
    for (unsigned i = 0; i < fc_likely_count; i++) {
        const FcLikely* likely = &fc_likely[i];
        const FcVariableInfo* info = &fc_variables[likely->variable];
        const double value = fc_variable_value(&instance->contact.state.variables, info);
        if (value != 0.0 && !(fabs(value) >= likely->low && fabs(value) <= likely->high)) {
            fc_log(instance, FC_CALL_EXIT_INITIALIZATION_MODE, fmi2Warning, FC_LOG_STATUS_WARNING,
                   "%s = %s is an unlikely magnitude: the unit is %s", info->name,
                   fc_quantity_text(value, info->unit).text, info->unit);
        }
    }
}
