// fmi2GetFMUstate, fmi2SetFMUstate, fmi2FreeFMUstate.
#include "fmi2/state.h"

#include <stdlib.h>

#include "fmi2/log.h"

SavedState* saved_state_of(const Instance* instance, Call call, fmi2FMUstate state) {
    SavedState* saved = state;
    if (!saved) {
        refuse(instance, call, "FMUstate is NULL");
        return NULL;
    }
    if (saved->mark != SAVED_STATE_MARK) {
        refuse(instance, call, "FMUstate is not a state of this FMU");
        return NULL;
    }
    return saved;
}

SavedState* saved_state_to_fill(const Instance* instance, Call call, fmi2FMUstate* state) {
    if (!state) {
        refuse(instance, call, "the pointer to FMUstate is NULL");
        return NULL;
    }
    if (*state) {
        return saved_state_of(instance, call, *state);
    }
    SavedState* saved = calloc(1, sizeof *saved);
    if (!saved) {
        refuse(instance, call, "out of memory");
        return NULL;
    }
    saved->mark = SAVED_STATE_MARK;
    *state = saved;
    return saved;
}

// Numbers that do not belong to the present values; zero makes equal states equal.
static void drop_stale_outputs(SavedState* saved) {
    Variables* variables = &saved->friction.variables;
    variables->F_t = 0.0;
    variables->sigma = 0.0;
    variables->A_r = 0.0;
    if (saved->machine.state == INITIALIZATION_MODE) {
        variables->delta = 0.0;
        variables->F_t_mean = 0.0;
        variables->W_f = 0.0;
    }
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* FMUstate) {
    Instance* instance = instance_enter(c, CALL_GET_FMU_STATE);
    SavedState* saved = instance ? saved_state_to_fill(instance, CALL_GET_FMU_STATE, FMUstate) : NULL;
    if (!saved) {
        return fmi2Error;
    }
    // Whether the outputs have been read must not show in a saved state: they are brought up to date first.
    Message message;
    const int settled =
        instance->machine.state != INSTANTIATED && instance_refresh_outputs(instance, &message);
    saved->friction = instance->contact.state;
    saved->machine = instance->machine;
    if (!settled) {
        drop_stale_outputs(saved);
    }
    return fmi2OK;
}

// Between steps the cvode method needs its solver, which a saved state does not carry.
static int has_its_solver(Instance* instance, const SavedState* saved, Message* message) {
    const int needed =
        saved->machine.state == STEP_COMPLETE && saved->friction.variables.solver.method == METHOD_CVODE;
    if (needed && !instance->contact.cvode) {
        instance->contact.cvode = cvode_solver_new(message);
    }
    return !needed || instance->contact.cvode;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate) {
    Instance* instance = instance_enter(c, CALL_SET_FMU_STATE);
    const SavedState* saved = instance ? saved_state_of(instance, CALL_SET_FMU_STATE, FMUstate) : NULL;
    if (!saved) {
        return fmi2Error;
    }
    Message message;
    if (!has_its_solver(instance, saved, &message)) {
        return refuse(instance, CALL_SET_FMU_STATE, "%s", message.text);
    }
    instance->contact.state = saved->friction;
    instance->machine = saved->machine;
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* FMUstate) {
    Instance* instance = instance_enter(c, CALL_FREE_FMU_STATE);
    if (!instance) {
        return fmi2Error;
    }
    if (!FMUstate || !*FMUstate) {
        return fmi2OK; // as FMI 2.0 asks
    }
    SavedState* saved = saved_state_of(instance, CALL_FREE_FMU_STATE, *FMUstate);
    if (!saved) {
        return fmi2Error;
    }
    free(saved);
    *FMUstate = NULL;
    return fmi2OK;
}
