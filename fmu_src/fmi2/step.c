// fmi2DoStep: from the time the instance has reached to exactly currentCommunicationPoint +
// communicationStepSize.
#include <float.h>
#include <math.h>

#include "fmi2/instance.h"
#include "fmi2/log.h"
#include "fmi2/variables.h"
#include "model/extremes.h"

// Hosts add or multiply their steps, so their time differs by rounding, which must not stop a run. The
// allowance is relative: steps of 1e-12 s work as well as steps of 1e9 s.
static double rounding_of_time(double t, double h) { return 1e-6 * h + 16.0 * DBL_EPSILON * fabs(t); }

// What the end of a step may exceed the stop time by: the rounding errors of a host that adds steps, here steps as long
// as this one. A step that begins at the stop time is one too many.
static double rounding_of_end(const FcExperiment* experiment, double end, double h) {
    const double steps = (end - experiment->start_time) / h;
    const double sum = 0.5 * DBL_EPSILON * steps * fc_max(fabs(experiment->start_time), fabs(end));
    const double rounding = rounding_of_time(end, h);
    return fc_max(rounding, fc_min(sum, h - rounding));
}

static bool check_step(const FcInstance* instance, double t, double h) {
    if (!(h >= 0.0 && h <= DBL_MAX)) {
        fc_refuse(instance, FC_CALL_DO_STEP, "communicationStepSize = %s must be finite and at least 0 s",
                  fc_quantity_text(h, "s").text);
        return false;
    }
    const double reached = instance->contact.state.clock.time;
    if (!(fabs(t - reached) <= rounding_of_time(reached, h))) {
        fc_refuse(instance, FC_CALL_DO_STEP, "currentCommunicationPoint = %s, but the instance is at %s",
                  fc_quantity_text(t, "s").text, fc_quantity_text(reached, "s").text);
        return false;
    }
    if (instance->experiment.has_stop_time &&
        t + h > instance->experiment.stop_time + rounding_of_end(&instance->experiment, t + h, h)) {
        fc_refuse(instance, FC_CALL_DO_STEP, "the step ends at %s, after the stop time %s",
                  fc_quantity_text(t + h, "s").text,
                  fc_quantity_text(instance->experiment.stop_time, "s").text);
        return false;
    }
    if (t + h > DBL_MAX) {
        fc_refuse(instance, FC_CALL_DO_STEP, "the step from %s over %s has no finite end",
                  fc_quantity_text(t, "s").text, fc_quantity_text(h, "s").text);
        return false;
    }
    return true;
}

// The end of a moving input must be a value that could also be set.
static bool check_moving_inputs(const FcInstance* instance, double h) {
    const FcFrictionState* state = &instance->contact.state;
    for (unsigned i = 0; state->rates.next_is_set && i < fc_inputs_count; i++) {
        const FcVariableInfo* info = &fc_variables[fc_inputs[i]];
        const double value = fc_variable_value(&state->variables, info);
        const double end = value + state->rates.next[fc_variable_input(info)] * h;
        if (!fc_variable_allows(info, end)) {
            const bool has_min = info->min > -DBL_MAX;
            fc_refuse(
                instance, FC_CALL_DO_STEP, "%s moves from %s to %s in the step: it must stay finite%s%s",
                info->name, fc_quantity_text(value, info->unit).text, fc_quantity_text(end, info->unit).text,
                has_min ? " and at least " : "", has_min ? fc_quantity_text(info->min, info->unit).text : "");
            return false;
        }
    }
    return true;
}

// The warnings that appear once.
enum { UNDERSAMPLING = 1, RINGING = 2, UNUSED_FORCE = 4 };

static void tell_undersampling(const FcInstance* instance, double h) {
    const double f = instance->contact.state.variables.vibration.f;
    fc_log(instance, FC_CALL_DO_STEP, fmi2Warning, FC_LOG_STATUS_WARNING,
           "the step of %s exceeds half a period of the vibration (vibration.f = %s): F_t is then one sample "
           "in a period; connect F_t_mean instead. This warning appears once.",
           fc_quantity_text(h, "s").text, fc_quantity_text(f, "Hz").text);
}

static void tell_ringing(const FcInstance* instance, double h) {
    const FcVariables* v = &instance->contact.state.variables;
    fc_log(
        instance, FC_CALL_DO_STEP, fmi2Warning, FC_LOG_STATUS_WARNING,
        "the mass body.m = %s rings undamped on sigma = %s, %.3g periods in the step of %s: F_t is then one "
        "sample in many; connect F_t_mean, send derivatives of the inputs, or set friction.sigma_1 to 2 zeta "
        "sqrt(sigma m), %.3g N.s/m for zeta = 0.2. This warning appears once.",
        fc_quantity_text(v->body.m, "kg").text, fc_quantity_text(v->sigma, "N/m").text,
        fc_friction_contact_rings(&instance->contact, h), fc_quantity_text(h, "s").text,
        0.4 * sqrt(v->sigma * v->body.m));
}

static void tell_unused_force(const FcInstance* instance, double h) {
    (void)h;
    fc_log(instance, FC_CALL_DO_STEP, fmi2Warning, FC_LOG_STATUS_WARNING,
           "body.F = %s has no effect: body.m = 0. This warning appears once.",
           fc_quantity_text(instance->contact.state.variables.body.F, "N").text);
}

static void tell_once(FcInstance* instance, unsigned what, bool is_so,
                      void (*tell)(const FcInstance*, double), double h) {
    if (is_so && !(instance->told & what)) {
        tell(instance, h);
        instance->told |= what;
    }
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint) {
    (void)noSetFMUStatePriorToCurrentPoint; // a saved state is a copy: nothing is kept for going back
    FcInstance* instance = fc_instance_enter(c, FC_CALL_DO_STEP);
    if (!instance || !check_step(instance, currentCommunicationPoint, communicationStepSize) ||
        !check_moving_inputs(instance, communicationStepSize)) {
        return fmi2Error;
    }
    FcMessage message;
    if (!fc_friction_contact_advance(&instance->contact, currentCommunicationPoint, communicationStepSize,
                                     &message)) {
        return fc_refuse(instance, FC_CALL_DO_STEP, "%s", message.text);
    }
    instance->experiment.outputs_stale = 0;
    const FcFrictionContact* contact = &instance->contact;
    const FcVariables* v = &contact->state.variables;
    const double h = communicationStepSize;
    tell_once(instance, UNDERSAMPLING, fc_friction_contact_undersamples(contact, h), tell_undersampling, h);
    tell_once(instance, RINGING, fc_friction_contact_rings(contact, h) > 0.0, tell_ringing, h);
    tell_once(instance, UNUSED_FORCE, v->body.m == 0.0 && v->body.F != 0.0, tell_unused_force, h);
    return fmi2OK;
}

fmi2Status fmi2CancelStep(fmi2Component c) {
    // Steps are synchronous, so the table allows this call in no state that an instance enters.
    fc_instance_enter(c, FC_CALL_CANCEL_STEP);
    return fmi2Error;
}
