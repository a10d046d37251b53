// fmi2GetXXXStatus. Steps are synchronous and never discarded, so only two queries have an answer.
#include "fmi2/instance.h"
#include "fmi2/log.h"

static fmi2Status refuse_kind(fmi2Component c, FcCall call, const char* answered) {
    const FcInstance* instance = fc_instance_enter(c, call);
    if (!instance) {
        return fmi2Error;
    }
    return fc_refuse(instance, call, "steps are synchronous: %s", answered);
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real* value) {
    const FcInstance* instance = fc_instance_enter(c, FC_CALL_GET_REAL_STATUS);
    if (!instance) {
        return fmi2Error;
    }
    if (s != fmi2LastSuccessfulTime) {
        return fc_refuse(instance, FC_CALL_GET_REAL_STATUS,
                         "status kind %d: only fmi2LastSuccessfulTime (%d) is a Real", (int)s,
                         (int)fmi2LastSuccessfulTime);
    }
    if (!value) {
        return fc_refuse(instance, FC_CALL_GET_REAL_STATUS, "value is NULL");
    }
    *value = instance->contact.state.clock.time;
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean* value) {
    const FcInstance* instance = fc_instance_enter(c, FC_CALL_GET_BOOLEAN_STATUS);
    if (!instance) {
        return fmi2Error;
    }
    if (s != fmi2Terminated) {
        return fc_refuse(instance, FC_CALL_GET_BOOLEAN_STATUS,
                         "status kind %d: only fmi2Terminated (%d) is a Boolean", (int)s,
                         (int)fmi2Terminated);
    }
    if (!value) {
        return fc_refuse(instance, FC_CALL_GET_BOOLEAN_STATUS, "value is NULL");
    }
    *value = fmi2False; // the contact never asks to end a run
    return fmi2OK;
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s, fmi2Status* value) {
    (void)s;
    (void)value;
    return refuse_kind(c, FC_CALL_GET_STATUS, "fmi2DoStep itself returned the status of the step");
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s, fmi2Integer* value) {
    (void)s;
    (void)value;
    return refuse_kind(c, FC_CALL_GET_INTEGER_STATUS, "there is no status of type Integer");
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s, fmi2String* value) {
    (void)s;
    (void)value;
    return refuse_kind(c, FC_CALL_GET_STRING_STATUS, "no step is ever pending");
}
