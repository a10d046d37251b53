// The functions of FMI for Model Exchange: time, states, rates, events. ode.h has their meaning.
#include <float.h>
#include <math.h>
#include <string.h>

#include "fmi2/instance.h"
#include "fmi2/log.h"

// Whether the array exists and has a place for each. Logs the reason if not.
static bool array_fits(const FcInstance* instance, FcCall call, const void* array, size_t given,
                       unsigned needed, const char* what) {
    if (!array) {
        fc_refuse(instance, call, "the array of %s is NULL", what);
        return false;
    }
    if (given != needed) {
        fc_refuse(instance, call, "%u %s are asked for; there are %u", (unsigned)given, what, needed);
        return false;
    }
    return true;
}

// The time [s] by which a time lies after the stop time; 0 or below without a stop time. Hosts add or
// multiply their steps.
static double after_stop(const FcInstance* instance, double time) {
    const FcExperiment* experiment = &instance->experiment;
    const double stop = experiment->stop_time;
    const double rounding = 1e-9 * (stop - experiment->start_time) + 16.0 * DBL_EPSILON * fabs(stop);
    return experiment->has_stop_time ? time - stop - rounding : 0.0;
}

static fmi2Status refuse_time(const FcInstance* instance, FcCall call, double time) {
    return fc_refuse(instance, call, "time = %s is after the stop time %s", fc_quantity_text(time, "s").text,
                     fc_quantity_text(instance->experiment.stop_time, "s").text);
}

static bool is_before_stop(const FcInstance* instance, FcCall call) {
    const double time = instance->contact.state.clock.time;
    if (after_stop(instance, time) > 0.0) {
        refuse_time(instance, call, time);
        return false;
    }
    return true;
}

// An integrator may evaluate beyond the stop time and return, but it may not step from there, nor evaluate
// farther than the length of the run.
static bool may_look_at(const FcInstance* instance, double time) {
    const FcExperiment* experiment = &instance->experiment;
    const double seen = instance->contact.state.ode.seen_time;
    const double after = after_stop(instance, time);
    const double run = experiment->stop_time - experiment->start_time;
    return !(after > 0.0) || (seen < experiment->stop_time - 1e-9 * run && after <= run);
}

fmi2Status fmi2EnterEventMode(fmi2Component c) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_ENTER_EVENT_MODE);
    if (!instance || !is_before_stop(instance, FC_CALL_ENTER_EVENT_MODE)) {
        return fmi2Error;
    }
    if (instance->experiment.mode == FC_CONTINUOUS_TIME_MODE) {
        fc_ode_event_begins(&instance->contact);
        instance->experiment.mode = FC_EVENT_MODE;
        instance->experiment.outputs_stale = 1;
    }
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo* fmi2eventInfo) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_NEW_DISCRETE_STATES);
    if (!instance) {
        return fmi2Error;
    }
    if (!fmi2eventInfo) {
        return fc_refuse(instance, FC_CALL_NEW_DISCRETE_STATES, "eventInfo is NULL");
    }
    FcMessage message;
    bool changed, nominals_changed;
    double next_event = 0.0;
    if (!fc_ode_update(&instance->contact, &changed, &nominals_changed, &message)) {
        return fc_refuse(instance, FC_CALL_NEW_DISCRETE_STATES, "%s", message.text);
    }
    instance->experiment.outputs_stale = 1;
    const bool announced = fc_ode_next_event(&instance->contact, &next_event);
    *fmi2eventInfo = (fmi2EventInfo){
        .newDiscreteStatesNeeded = fmi2False,
        .terminateSimulation = fmi2False,
        .nominalsOfContinuousStatesChanged = nominals_changed ? fmi2True : fmi2False,
        .valuesOfContinuousStatesChanged = changed ? fmi2True : fmi2False,
        .nextEventTimeDefined = announced ? fmi2True : fmi2False,
        .nextEventTime = next_event,
    };
    return fmi2OK;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_ENTER_CONTINUOUS_TIME_MODE);
    if (!instance) {
        return fmi2Error;
    }
    fc_ode_event_ends(&instance->contact);
    instance->experiment.mode = FC_CONTINUOUS_TIME_MODE;
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi2Boolean* enterEventMode, fmi2Boolean* terminateSimulation) {
    (void)noSetFMUStatePriorToCurrentPoint; // a saved state is a copy: nothing is kept for going back
    const FcCall call = FC_CALL_COMPLETED_INTEGRATOR_STEP;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance) {
        return fmi2Error;
    }
    if (!enterEventMode || !terminateSimulation) {
        return fc_refuse(instance, call, "enterEventMode or terminateSimulation is NULL");
    }
    if (!is_before_stop(instance, call)) {
        return fmi2Error;
    }
    *enterEventMode = fc_ode_step_completed(&instance->contact) ? fmi2True : fmi2False;
    *terminateSimulation = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_SET_TIME);
    if (!instance) {
        return fmi2Error;
    }
    if (!isfinite(time)) {
        return fc_refuse(instance, FC_CALL_SET_TIME, "time = %s is not a finite number",
                         fc_quantity_text(time, "s").text);
    }
    if (!may_look_at(instance, time)) {
        return refuse_time(instance, FC_CALL_SET_TIME, time);
    }
    fc_ode_set_time(&instance->contact, time);
    instance->experiment.outputs_stale = 1;
    return fmi2OK;
}

// The states in the order of ModelStructure/Derivatives.
static double* state(FcInstance* instance, int index) {
    FcVariables* v = &instance->contact.state.variables;
    double* const states[FC_STATE_COUNT] = {&v->delta, &v->W_f, &v->Q_f, &v->delta_y};
    return states[index];
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx) {
    static const char* const names[FC_STATE_COUNT] = {"delta", "W_f", "Q_f", "delta_y"};
    static const char* const units[FC_STATE_COUNT] = {"m", "J", "J", "m"};
    const FcCall call = FC_CALL_SET_CONTINUOUS_STATES;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance || !array_fits(instance, call, x, nx, FC_STATE_COUNT, "continuous states")) {
        return fmi2Error;
    }
    for (int i = 0; i < FC_STATE_COUNT; i++) {
        if (!isfinite(x[i])) {
            return fc_refuse(instance, call, "%s = %s is not a finite number", names[i],
                             fc_quantity_text(x[i], units[i]).text);
        }
    }
    for (int i = 0; i < FC_STATE_COUNT; i++) {
        *state(instance, i) = x[i];
    }
    instance->experiment.outputs_stale = 1;
    return fmi2OK;
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t nx) {
    const FcCall call = FC_CALL_GET_DERIVATIVES;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance || !array_fits(instance, call, derivatives, nx, FC_STATE_COUNT, "derivatives")) {
        return fmi2Error;
    }
    FcMessage message;
    if (!fc_instance_refresh_outputs(instance, &message)) {
        return fc_refuse(instance, call, "%s", message.text);
    }
    FcVariables* v = &instance->contact.state.variables;
    v->solver.evaluations += 1.0;
    _Static_assert(sizeof v->der == FC_STATE_COUNT * sizeof(double), "one rate for each state");
    memcpy(derivatives, &v->der, sizeof v->der); // in the order of ModelStructure/Derivatives, too
    return fmi2OK;
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real eventIndicators[], size_t ni) {
    const FcCall call = FC_CALL_GET_EVENT_INDICATORS;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance ||
        !array_fits(instance, call, eventIndicators, ni, FC_EVENT_INDICATOR_COUNT, "event indicators")) {
        return fmi2Error;
    }
    FcMessage message;
    if (!fc_instance_refresh_outputs(instance, &message) ||
        !fc_ode_indicators(&instance->contact, eventIndicators, &message)) {
        return fc_refuse(instance, call, "%s", message.text);
    }
    return fmi2OK;
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx) {
    const FcCall call = FC_CALL_GET_CONTINUOUS_STATES;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance || !array_fits(instance, call, x, nx, FC_STATE_COUNT, "continuous states")) {
        return fmi2Error;
    }
    FcMessage message;
    if (instance->experiment.mode == FC_INITIALIZATION_MODE &&
        !fc_instance_refresh_outputs(instance, &message)) {
        return fc_refuse(instance, call, "%s", message.text);
    }
    for (int i = 0; i < FC_STATE_COUNT; i++) {
        x[i] = *state(instance, i);
    }
    return fmi2OK;
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x_nominal[], size_t nx) {
    const FcCall call = FC_CALL_GET_NOMINALS_OF_CONTINUOUS_STATES;
    FcInstance* instance = fc_instance_enter(c, call);
    if (!instance || !array_fits(instance, call, x_nominal, nx, FC_STATE_COUNT, "nominal values")) {
        return fmi2Error;
    }
    FcMessage message;
    if (!fc_ode_nominals(&instance->contact, x_nominal, &message)) {
        return fc_refuse(instance, call, "%s", message.text);
    }
    return fmi2OK;
}
