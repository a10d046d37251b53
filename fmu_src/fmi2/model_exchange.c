// The functions of FMI for Model Exchange: exported, since hosts look them up, and refused in every state.
#include "fmi2/instance.h"

static fmi2Status refuse_model_exchange(fmi2Component c, FcCall call) {
    fc_instance_enter(c, call); // no state allows it
    return fmi2Error;
}

fmi2Status fmi2EnterEventMode(fmi2Component c) { return refuse_model_exchange(c, FC_CALL_ENTER_EVENT_MODE); }

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo* fmi2eventInfo) {
    (void)fmi2eventInfo;
    return refuse_model_exchange(c, FC_CALL_NEW_DISCRETE_STATES);
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
    return refuse_model_exchange(c, FC_CALL_ENTER_CONTINUOUS_TIME_MODE);
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi2Boolean* enterEventMode, fmi2Boolean* terminateSimulation) {
    (void)noSetFMUStatePriorToCurrentPoint;
    (void)enterEventMode;
    (void)terminateSimulation;
    return refuse_model_exchange(c, FC_CALL_COMPLETED_INTEGRATOR_STEP);
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
    (void)time;
    return refuse_model_exchange(c, FC_CALL_SET_TIME);
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx) {
    (void)x;
    (void)nx;
    return refuse_model_exchange(c, FC_CALL_SET_CONTINUOUS_STATES);
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t nx) {
    (void)derivatives;
    (void)nx;
    return refuse_model_exchange(c, FC_CALL_GET_DERIVATIVES);
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real eventIndicators[], size_t ni) {
    (void)eventIndicators;
    (void)ni;
    return refuse_model_exchange(c, FC_CALL_GET_EVENT_INDICATORS);
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx) {
    (void)x;
    (void)nx;
    return refuse_model_exchange(c, FC_CALL_GET_CONTINUOUS_STATES);
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x_nominal[], size_t nx) {
    (void)x_nominal;
    (void)nx;
    return refuse_model_exchange(c, FC_CALL_GET_NOMINALS_OF_CONTINUOUS_STATES);
}
