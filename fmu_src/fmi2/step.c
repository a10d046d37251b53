// fmi2DoStep: from the time the instance has reached to exactly currentCommunicationPoint +
// communicationStepSize.
#include <float.h>
#include <math.h>

#include "fmi2/instance.h"
#include "fmi2/log.h"
#include "fmi2/values.h"

// Hosts keep time in their own way, adding steps or multiplying them; what is a rounding of time to them must
// not stop a run. There is no absolute allowance: steps of 1e-12 s are as good as steps of 1e9 s.
static double rounding_of_time(double t, double h) { return 1e-6 * h + 16.0 * DBL_EPSILON * fabs(t); }

static int check_step(const Instance* instance, double t, double h) {
    if (!(h >= 0.0 && h <= DBL_MAX)) {
        refuse(instance, CALL_DO_STEP, "communicationStepSize = %s must be finite and at least 0 s",
               quantity_text(h, "s").text);
        return 0;
    }
    const double reached = instance->contact.state.time;
    if (!(fabs(t - reached) <= rounding_of_time(reached, h))) {
        refuse(instance, CALL_DO_STEP, "currentCommunicationPoint = %s, but the instance is at %s",
               quantity_text(t, "s").text, quantity_text(reached, "s").text);
        return 0;
    }
    if (instance->machine.has_stop_time && t + h > instance->machine.stop_time + rounding_of_time(t + h, h)) {
        refuse(instance, CALL_DO_STEP, "the step ends at %s, after the stop time %s",
               quantity_text(t + h, "s").text, quantity_text(instance->machine.stop_time, "s").text);
        return 0;
    }
    if (t + h > DBL_MAX) {
        refuse(instance, CALL_DO_STEP, "the step from %s over %s has no finite end",
               quantity_text(t, "s").text, quantity_text(h, "s").text);
        return 0;
    }
    return 1;
}

// An input that moves must end where it could also have been set.
static int check_moving_inputs(const Instance* instance, double h) {
    const FrictionState* state = &instance->contact.state;
    for (unsigned vr = 0; state->next_rate_set && vr < variables_count; vr++) {
        const VariableInfo* info = &variables_table[vr];
        if (info->causality != CAUSALITY_INPUT) {
            continue;
        }
        const double value = *variable_real((Variables*)&state->variables, info); // only read
        const double end = value + state->next_rate[variable_input(info)] * h;
        if (!variable_allows(info, end)) {
            const int has_min = info->min > -DBL_MAX;
            refuse(instance, CALL_DO_STEP, "%s moves from %s to %s in the step: it must stay finite%s%s",
                   info->name, quantity_text(value, info->unit).text, quantity_text(end, info->unit).text,
                   has_min ? " and at least " : "", has_min ? quantity_text(info->min, info->unit).text : "");
            return 0;
        }
    }
    return 1;
}

static void tell_undersampling(Instance* instance, double h) {
    const double f = instance->contact.state.variables.vibration.f;
    log_text(
        instance, CALL_DO_STEP, fmi2Warning, LOG_STATUS_WARNING,
        "the step of %s exceeds half a period of the vibration (vibration.f = %s): F_t is then one sample "
        "of it; F_t_mean is the output to couple. Told once.",
        quantity_text(h, "s").text, quantity_text(f, "Hz").text);
    instance->undersampling_told = 1;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint) {
    (void)noSetFMUStatePriorToCurrentPoint; // a saved state is a copy: nothing is kept for going back
    Instance* instance = instance_enter(c, CALL_DO_STEP);
    if (!instance || !check_step(instance, currentCommunicationPoint, communicationStepSize) ||
        !check_moving_inputs(instance, communicationStepSize)) {
        return fmi2Error;
    }
    Message message;
    if (!friction_contact_advance(&instance->contact, currentCommunicationPoint, communicationStepSize,
                                  &message)) {
        return refuse(instance, CALL_DO_STEP, "%s", message.text);
    }
    instance->machine.outputs_stale = 0;
    if (!instance->undersampling_told &&
        friction_contact_undersamples(&instance->contact, communicationStepSize)) {
        tell_undersampling(instance, communicationStepSize);
    }
    return fmi2OK;
}

fmi2Status fmi2CancelStep(fmi2Component c) {
    // Steps are synchronous, so the table allows this in no state that an instance enters.
    instance_enter(c, CALL_CANCEL_STEP);
    return fmi2Error;
}
