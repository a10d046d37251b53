// fmi2GetFMUstate, fmi2SetFMUstate, fmi2FreeFMUstate; fmi2SerializedFMUstateSize, fmi2SerializeFMUstate,
// fmi2DeSerializeFMUstate.
#include "fmi2/saved_state.h"

#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2/log.h"
#include "fmi2/variables.h"

// Counted from 1. It increases with every change of FcSavedState that the guid does not tell.
enum { LAYOUT = 8 };

FcSavedStateHead fc_saved_state_head(void) {
    FcSavedStateHead head = {.magic = "FRICTION", .layout = LAYOUT, .size = FC_SAVED_STATE_BYTES};
    snprintf(head.guid, sizeof head.guid, "%s", fc_guid);
    return head;
}

// The saved state of the handle; NULL, after logging, if the handle is not a saved state.
static FcSavedState* saved_state_of(const FcInstance* instance, FcCall call, fmi2FMUstate state) {
    FcSavedState* saved = state;
    if (!saved) {
        fc_refuse(instance, call, "FMUstate is NULL");
        return NULL;
    }
    const FcSavedStateHead head = fc_saved_state_head();
    if (memcmp(saved->head.magic, head.magic, sizeof head.magic) != 0) {
        fc_refuse(instance, call, "FMUstate is not a state of this FMU");
        return NULL;
    }
    return saved;
}

// The saved state of *state, to be filled; allocated if *state is NULL. NULL after logging the reason.
static FcSavedState* saved_state_to_fill(const FcInstance* instance, FcCall call, fmi2FMUstate* state) {
    if (!state) {
        fc_refuse(instance, call, "the pointer to FMUstate is NULL");
        return NULL;
    }
    if (*state) {
        return saved_state_of(instance, call, *state);
    }
    FcSavedState* saved = calloc(1, sizeof *saved);
    if (!saved) {
        fc_refuse(instance, call, "out of memory");
        return NULL;
    }
    saved->head = fc_saved_state_head();
    *state = saved;
    return saved;
}

// Clears the numbers that do not belong to the present values, so that equal states are equal bytes.
static void drop_stale_outputs(const FcInstance* instance, FcSavedState* saved) {
    FcVariables* variables = &saved->friction.variables;
    const FcVector none = {0.0, 0.0};
    const bool is_initializing = saved->experiment.mode == FC_INITIALIZATION_MODE;
    const bool has_mean = !is_initializing && !fc_instance_is_ode(instance);
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
    FcSavedState* saved = instance ? saved_state_to_fill(instance, FC_CALL_GET_FMU_STATE, FMUstate) : NULL;
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
    if (!settled || !fc_instance_is_ode(instance)) { // rates are computed when they are read
        saved->friction.variables.der = (FcStateRates){.delta = 0.0};
    }
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_SET_FMU_STATE);
    const FcSavedState* saved = instance ? saved_state_of(instance, FC_CALL_SET_FMU_STATE, FMUstate) : NULL;
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
    FcSavedState* saved = saved_state_of(instance, FC_CALL_FREE_FMU_STATE, *FMUstate);
    if (!saved) {
        return fmi2Error;
    }
    free(saved);
    *FMUstate = NULL;
    return fmi2OK;
}

// FcVariables alone has padding, and impossible_part checks each member of the others.
_Static_assert(sizeof(FcFrictionState) == sizeof(FcVariables) + (4 + 2 * FC_INPUT_COUNT) * sizeof(double) +
                                              4 * sizeof(int) + sizeof(FcPast) + sizeof(FcOdeState),
               "impossible_part must check a new member of FcFrictionState; padding needs a name");
_Static_assert(sizeof(FcOdeState) == 2 * sizeof(int) + (6 + 2 * FC_INPUT_COUNT) * sizeof(double),
               "impossible_part must check a new member of FcOdeState; padding needs a name");
_Static_assert(sizeof(FcExperiment) == 6 * sizeof(int) + 2 * sizeof(double),
               "impossible_part must check a new member of FcExperiment; padding needs a name");
_Static_assert(sizeof(FcSavedState) ==
                   sizeof(FcSavedStateHead) + sizeof(FcFrictionState) + sizeof(FcExperiment),
               "FcSavedState must have no padding");

// The same state with its padding 0. The padding of a struct that was assigned may hold anything.
static void copy_without_padding(FcSavedState* to, const FcSavedState* from) {
    memcpy(to, from, sizeof *to);
    memset(&to->friction.variables, 0, sizeof to->friction.variables);
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        memcpy((char*)&to->friction.variables + info->offset,
               (const char*)&from->friction.variables + info->offset,
               info->type == FC_TYPE_REAL ? sizeof(double) : sizeof(int));
    }
}

// Every change of a single byte changes it: each step is one-to-one.
static uint64_t fnv1a(const void* data, size_t size) {
    const unsigned char* bytes = data;
    uint64_t hash = 14695981039346656037u;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ bytes[i]) * 1099511628211u;
    }
    return hash;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t* size) {
    const FcCall call = FC_CALL_SERIALIZED_FMU_STATE_SIZE;
    const FcInstance* instance = fc_instance_enter(c, call);
    if (!instance || !saved_state_of(instance, call, FMUstate)) {
        return fmi2Error;
    }
    if (!size) {
        return fc_refuse(instance, call, "size is NULL");
    }
    *size = FC_SAVED_STATE_BYTES;
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[],
                                 size_t size) {
    const FcCall call = FC_CALL_SERIALIZE_FMU_STATE;
    const FcInstance* instance = fc_instance_enter(c, call);
    const FcSavedState* saved = instance ? saved_state_of(instance, call, FMUstate) : NULL;
    if (!saved) {
        return fmi2Error;
    }
    if (!serializedState) {
        return fc_refuse(instance, call, "serializedState is NULL");
    }
    if (size < FC_SAVED_STATE_BYTES) {
        return fc_refuse(instance, call, "size = %" PRIu64 " is below the %d bytes of a state",
                         (uint64_t)size, (int)FC_SAVED_STATE_BYTES);
    }
    FcSavedState data;
    copy_without_padding(&data, saved);
    const uint64_t hash = fnv1a(&data, sizeof data);
    memcpy(serializedState, &data, sizeof data);
    memcpy(serializedState + sizeof data, &hash, sizeof hash);
    return fmi2OK;
}

// The reason why the bytes cannot be a state of this FMU; NULL if they can.
static const char* flaw_of_bytes(const fmi2Byte* bytes, size_t size) {
    FcSavedStateHead head;
    if (size < sizeof head) {
        return "the bytes are cut off";
    }
    const FcSavedStateHead expected = fc_saved_state_head();
    memcpy(&head, bytes, sizeof head);
    if (memcmp(head.magic, expected.magic, sizeof head.magic) != 0) {
        return "the bytes are not a state of this FMU: they do not begin with FRICTION";
    }
    if (head.layout != expected.layout) {
        return "the bytes have another version of the layout";
    }
    if (memcmp(head.guid, expected.guid, sizeof head.guid) != 0) {
        return "the bytes come from another version of the FMU: the guid differs";
    }
    if (head.size != expected.size || size != expected.size) {
        return "the bytes are cut off or too many";
    }
    uint64_t hash;
    memcpy(&hash, bytes + sizeof(FcSavedState), sizeof hash);
    return hash == fnv1a(bytes, sizeof(FcSavedState)) ? NULL : "the bytes are damaged: the checksum differs";
}

// The doubles from first to before end.
static bool are_finite(const void* first, const void* end) {
    for (const char* at = first; at < (const char*)end; at += sizeof(double)) {
        double number;
        memcpy(&number, at, sizeof number);
        if (!isfinite(number)) {
            return false;
        }
    }
    return true;
}

static bool is_flag(int value) { return value == 0 || value == 1; }

// Only a bounded bristle slips.
static bool bristle_is_sound(const FcFrictionState* state) {
    const FcFriction* friction = &state->variables.friction;
    const bool slips = state->bristle.state == FC_SLIPPING || state->bristle.state == FC_CATCHING_UP;
    return state->bristle.state == FC_FREE || (slips && fc_is_bounded(friction));
}

// A mode is one that the interface has.
static bool mode_is_sound(const FcExperiment* experiment) {
    const bool exchanges = experiment->interface == FC_MODEL_EXCHANGE;
    const int mode = experiment->mode;
    const bool is_common = mode == FC_INSTANTIATED || mode == FC_INITIALIZATION_MODE || mode == FC_TERMINATED;
    return exchanges ? is_common || mode == FC_EVENT_MODE || mode == FC_CONTINUOUS_TIME_MODE
                     : experiment->interface == FC_CO_SIMULATION && (is_common || mode == FC_STEP_COMPLETE);
}

// The first part of the state with a value that no call leaves behind; NULL if there is none.
static const char* impossible_part(const FcSavedState* saved) {
    const FcFrictionState* friction = &saved->friction;
    const FcOdeState* ode = &friction->ode;
    const FcExperiment* experiment = &saved->experiment;
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        if (!fc_variable_allows(info, fc_variable_value(&friction->variables, info))) {
            return info->name;
        }
    }
    if (!are_finite(&friction->clock, &friction->rates.next_is_set) ||
        !is_flag(friction->rates.next_is_set) || friction->rates.no_hole != 0) {
        return "the time or a rate of an input";
    }
    if (!are_finite(&friction->bristle.past, &friction->bristle.state) || !bristle_is_sound(friction) ||
        friction->bristle.no_hole != 0) {
        return "what the last step left";
    }
    if (!are_finite(&ode->seen_time, ode + 1) || !is_flag(ode->changed) || ode->no_hole != 0) {
        return "what model exchange keeps";
    }
    if (!are_finite(&experiment->start_time, experiment + 1) || !is_flag(experiment->outputs_stale) ||
        !is_flag(experiment->tolerance_is_set) || !is_flag(experiment->has_stop_time) ||
        experiment->no_hole != 0 || !mode_is_sound(experiment)) {
        return "the state of the instance";
    }
    FcSavedState clean;
    copy_without_padding(&clean, saved);
    const void* cleaned = &clean; // memcmp of the bytes, padding included, is meant
    return memcmp(cleaned, (const void*)saved, sizeof clean) == 0 ? NULL : "the padding, which is 0";
}

// Outputs that are not stale were computed of values that go together.
static bool goes_together(const FcSavedState* saved, FcMessage* message) {
    if (saved->experiment.outputs_stale || saved->experiment.mode == FC_INSTANTIATED) {
        return true;
    }
    FcFrictionContact contact = {.state = saved->friction, .cvode = {NULL}};
    return fc_friction_contact_check(&contact, message);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte serializedState[], size_t size,
                                   fmi2FMUstate* FMUstate) {
    const FcCall call = FC_CALL_DESERIALIZE_FMU_STATE;
    const FcInstance* instance = fc_instance_enter(c, call);
    if (!instance) {
        return fmi2Error;
    }
    if (!serializedState) {
        return fc_refuse(instance, call, "serializedState is NULL");
    }
    const char* flaw = flaw_of_bytes(serializedState, size);
    if (flaw) {
        return fc_refuse(instance, call, "%s (%" PRIu64 " bytes)", flaw, (uint64_t)size);
    }
    FcSavedState read;
    memcpy(&read, serializedState, sizeof read);
    const char* part = impossible_part(&read);
    if (part) {
        return fc_refuse(instance, call, "the bytes hold an impossible value of %s", part);
    }
    FcMessage message;
    if (!goes_together(&read, &message)) {
        return fc_refuse(instance, call, "the bytes hold values that do not go together: %s", message.text);
    }
    FcSavedState* saved = saved_state_to_fill(instance, call, FMUstate);
    if (!saved) {
        return fmi2Error;
    }
    *saved = read;
    return fmi2OK;
}
