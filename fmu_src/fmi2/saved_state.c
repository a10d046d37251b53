// fmi2GetFMUstate, fmi2SetFMUstate, fmi2FreeFMUstate.
#include "fmi2/saved_state.h"

#include <stdlib.h>

#include "fmi2/log.h"

FcSavedState* fc_saved_state_of(const FcInstance* instance, FcCall call, fmi2FMUstate state) {
    FcSavedState* saved = state;
    if (!saved) {
        fc_refuse(instance, call, "FMUstate is NULL");
        return NULL;
    }
    if (saved->mark != FC_SAVED_STATE_MARK) {
        fc_refuse(instance, call, "FMUstate is not a state of this FMU");
        return NULL;
    }
    return saved;
}

FcSavedState* fc_saved_state_to_fill(const FcInstance* instance, FcCall call, fmi2FMUstate* state) {
    if (!state) {
        fc_refuse(instance, call, "the pointer to FMUstate is NULL");
        return NULL;
    }
    if (*state) {
        return fc_saved_state_of(instance, call, *state);
    }
    FcSavedState* saved = calloc(1, sizeof *saved);
    if (!saved) {
        fc_refuse(instance, call, "out of memory");
        return NULL;
    }
    saved->mark = FC_SAVED_STATE_MARK;
    *state = saved;
    return saved;
}

// Clears the numbers that do not belong to the present values, so that equal states are equal bytes.
static void drop_stale_outputs(const FcInstance* instance, FcSavedState* saved) {
    FcVariables* variables = &saved->friction.variables;
    const FcVector none = {0.0, 0.0};
    const bool is_initializing = saved->experiment.mode == FC_INITIALIZATION_MODE;
    const bool has_mean = !is_initializing && !fc_instance_is_hybrid(instance);
    const FcVector mean = {variables->F_t_mean, variables->F_y_mean};
    fc_set_outputs(variables, none, has_mean ? mean : none, &(FcContactResponse){0});
    if (is_initializing) {
        variables->delta = 0.0;
        variables->delta_y = 0.0;
        variables->W_f = 0.0;
        variables->Q_f = 0.0;
        variables->body.v = 0.0;
        variables->body.x = 0.0;
    }
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* FMUstate) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_GET_FMU_STATE);
    FcSavedState* saved = instance ? fc_saved_state_to_fill(instance, FC_CALL_GET_FMU_STATE, FMUstate) : NULL;
    if (!saved) {
        return fmi2Error;
    }
    // A saved state must not depend on whether the outputs have been read: they are brought up to date first.
    FcMessage message;
    const bool settled =
        instance->experiment.mode != FC_INSTANTIATED && fc_instance_refresh_outputs(instance, &message);
    saved->friction = instance->contact.state;
    saved->experiment = instance->experiment;
    if (!settled) {
        drop_stale_outputs(instance, saved);
    }
    if (!settled || !fc_instance_is_hybrid(instance)) { // rates are computed when they are read
        saved->friction.variables.der = (FcStateRates){.delta = 0.0};
    }
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_SET_FMU_STATE);
    const FcSavedState* saved =
        instance ? fc_saved_state_of(instance, FC_CALL_SET_FMU_STATE, FMUstate) : NULL;
    if (!saved) {
        return fmi2Error;
    }
    const FcInterface of = (FcInterface)saved->experiment.interface;
    if (saved->experiment.interface != instance->experiment.interface) {
        return fc_refuse(instance, FC_CALL_SET_FMU_STATE, "FMUstate is one of %s; this instance is for %s",
                         fc_interface_name(of),
                         fc_interface_name((FcInterface)instance->experiment.interface));
    }
    FcMessage message;
    if (saved->experiment.mode == FC_STEP_COMPLETE &&
        !fc_friction_contact_prepare(&instance->contact, &saved->friction.variables, &message)) {
        return fc_refuse(instance, FC_CALL_SET_FMU_STATE, "%s", message.text);
    }
    instance->contact.state = saved->friction;
    instance->experiment = saved->experiment;
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* FMUstate) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_FREE_FMU_STATE);
    if (!instance) {
        return fmi2Error;
    }
    if (!FMUstate || !*FMUstate) {
        return fmi2OK; // as FMI 2.0 asks
    }
    FcSavedState* saved = fc_saved_state_of(instance, FC_CALL_FREE_FMU_STATE, *FMUstate);
    if (!saved) {
        return fmi2Error;
    }
    free(saved);
    *FMUstate = NULL;
    return fmi2OK;
}
