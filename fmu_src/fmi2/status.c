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

// The instance if it has an answer of the kind and a place for it. Otherwise NULL, after logging the reason.
static const FcInstance* answering(fmi2Component c, FcCall call, fmi2StatusKind s, fmi2StatusKind answered,
                                   const char* type, const void* value) {
    const FcInstance* instance = fc_instance_enter(c, call);
    if (instance && s != answered) {
        fc_refuse(instance, call, "status kind %d: only %s (%d) is a %s", (int)s,
                  answered == fmi2Terminated ? "fmi2Terminated" : "fmi2LastSuccessfulTime", (int)answered,
                  type);
        return NULL;
    }
    if (instance && !value) {
        fc_refuse(instance, call, "value is NULL");
        return NULL;
    }
    return instance;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real* value) {
    const FcInstance* instance =
        answering(c, FC_CALL_GET_REAL_STATUS, s, fmi2LastSuccessfulTime, "Real", value);
    if (!instance) {
        return fmi2Error;
    }
    *value = instance->contact.state.time;
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean* value) {
    if (!answering(c, FC_CALL_GET_BOOLEAN_STATUS, s, fmi2Terminated, "Boolean", value)) {
        return fmi2Error;
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
