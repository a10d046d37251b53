#include "fmi2/instance.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fmi2/log.h"
#include "fmi2/values.h"

static void refuse_call(const Instance* instance, Call call) {
    if (call_table[call].allowed == 0) {
        refuse(instance, call, "belongs to model exchange; this is a co-simulation FMU");
        return;
    }
    char allowed[160];
    call_state_names(call_table[call].allowed, allowed, sizeof allowed);
    refuse(instance, call, "not allowed in state '%s', only in: %s",
           call_state_name((InstanceState)instance->machine.state), allowed);
}

Instance* instance_enter(fmi2Component c, Call call) {
    Instance* instance = c;
    if (!instance) {
        return NULL;
    }
    if (!(call_table[call].allowed & (unsigned)instance->machine.state)) {
        refuse_call(instance, call);
        return NULL;
    }
    return instance;
}

void instance_set_start_values(Instance* instance) {
    memset(&instance->contact.state, 0, sizeof instance->contact.state);
    memset(&instance->machine, 0, sizeof instance->machine);
    instance->machine.state = INSTANTIATED;
    instance->machine.outputs_stale = 1;
    instance->undersampling_told = 0;
    Variables* variables = &instance->contact.state.variables;
    for (unsigned vr = 0; vr < variables_count; vr++) {
        const VariableInfo* info = &variables_table[vr];
        if (info->has_start && info->type == TYPE_REAL) {
            *variable_real(variables, info) = info->start;
        } else if (info->has_start) {
            *variable_integer(variables, info) = (int)info->start;
        }
    }
}

int instance_refresh_outputs(Instance* instance, Message* message) {
    if (!instance->machine.outputs_stale) {
        return 1;
    }
    FrictionContact* contact = &instance->contact;
    if (instance->machine.state == INITIALIZATION_MODE) {
        FrictionContact trial = {.state = contact->state, .cvode = NULL};
        if (!friction_contact_initialize(&trial, instance->machine.start_time, message)) {
            return 0;
        }
        contact->state = trial.state;
        friction_contact_free(&trial);
    } else {
        if (!friction_contact_check(contact, message)) {
            return 0;
        }
        friction_contact_update_outputs(contact);
        const Variables* v = &contact->state.variables;
        if (!isfinite(v->F_t) || !isfinite(v->A_r)) {
            snprintf(
                message->text, sizeof message->text,
                "F_t = sigma delta or A_r is beyond the largest number: sigma = %.9g N/m, delta = %.9g m",
                v->sigma, v->delta);
            return 0;
        }
    }
    instance->machine.outputs_stale = 0;
    return 1;
}
