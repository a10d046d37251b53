#include "fmi2/instance.h"

#include <math.h>
#include <string.h>

#include "fmi2/log.h"
#include "fmi2/variables.h"

// Refuses an illegal call: one of the other interface, or one that the state of the instance does not allow.
static void refuse_call(const FcInstance* instance, FcCall call) {
    const FcInterface of = (FcInterface)instance->experiment.interface;
    if (!(fc_call_table[call].interfaces & of)) {
        const FcInterface other = of == FC_MODEL_EXCHANGE ? FC_CO_SIMULATION : FC_MODEL_EXCHANGE;
        fc_refuse(instance, call, "belongs to %s; this instance is for %s", fc_interface_name(other),
                  fc_interface_name(of));
        return;
    }
    char allowed[160];
    fc_mode_names(fc_call_table[call].allowed, of, allowed, sizeof allowed);
    fc_refuse(instance, call, "not allowed in state '%s', only in: %s",
              fc_mode_name((FcMode)instance->experiment.mode), allowed);
}

FcInstance* fc_instance_enter(fmi2Component c, FcCall call) {
    FcInstance* instance = c;
    if (!instance) {
        return NULL;
    }
    const FcCallRule* rule = &fc_call_table[call];
    if (!(rule->interfaces & (unsigned)instance->experiment.interface) ||
        !(rule->allowed & (unsigned)instance->experiment.mode)) {
        refuse_call(instance, call);
        return NULL;
    }
    return instance;
}

void fc_instance_set_start_values(FcInstance* instance) {
    memset(&instance->contact.state, 0, sizeof instance->contact.state);
    instance->experiment = (FcExperiment){
        .interface = instance->experiment.interface, .mode = FC_INSTANTIATED, .outputs_stale = 1};
    instance->told = 0;
    FcVariables* variables = &instance->contact.state.variables;
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        if (info->has_start && info->type == FC_TYPE_REAL) {
            *fc_variable_real(variables, info) = info->start;
        } else if (info->has_start) {
            *fc_variable_integer(variables, info) = (int)info->start;
        }
    }
}

bool fc_instance_is_ode(const FcInstance* instance) {
    const FcExperiment* experiment = &instance->experiment;
    return experiment->interface == FC_MODEL_EXCHANGE && experiment->mode != FC_INSTANTIATED &&
           experiment->mode != FC_INITIALIZATION_MODE;
}

bool fc_instance_refresh_outputs(FcInstance* instance, FcMessage* message) {
    if (!instance->experiment.outputs_stale) {
        return true;
    }
    FcFrictionContact* contact = &instance->contact;
    if (instance->experiment.mode == FC_INITIALIZATION_MODE) {
        FcFrictionContact trial = {.state = contact->state, .cvode = {NULL}};
        if (!fc_friction_contact_initialize(&trial, instance->experiment.start_time, message)) {
            return false;
        }
        contact->state = trial.state;
        fc_friction_contact_free(&trial);
    } else if (!(fc_instance_is_ode(instance) ? fc_ode_refresh(contact, message)
                                              : fc_friction_contact_refresh(contact, message))) {
        return false;
    }
    instance->experiment.outputs_stale = 0;
    return true;
}

bool fc_instance_refresh_rates(FcInstance* instance, FcMessage* message) {
    return fc_instance_refresh_outputs(instance, message) &&
           (fc_instance_is_ode(instance) || fc_friction_contact_refresh_rates(&instance->contact, message));
}
