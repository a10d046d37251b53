// From fmi2Instantiate to fmi2FreeInstance, and the switch of the log.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2/instance.h"
#include "fmi2/log.h"
#include "fmi2/plausibility.h"
#include "fmi2/variables.h"
#include "model/extremes.h"

const char* fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char* fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation, const fmi2CallbackFunctions* functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn) {
    (void)fmuResourceLocation; // the FMU has no resources: any location will do, or none
    (void)visible;
    if (!functions) {
        return NULL;
    }
    if (!instanceName || instanceName[0] == '\0') {
        fc_log_refused_instance(functions, NULL, "the instance name is missing");
        return NULL;
    }
    if (fmuType != fmi2CoSimulation && fmuType != fmi2ModelExchange) {
        fc_log_refused_instance(functions, instanceName,
                                "fmuType = %d is neither fmi2ModelExchange (%d) nor fmi2CoSimulation (%d)",
                                (int)fmuType, (int)fmi2ModelExchange, (int)fmi2CoSimulation);
        return NULL;
    }
    if (!fmuGUID || strcmp(fmuGUID, fc_guid) != 0) {
        fc_log_refused_instance(functions, instanceName, "the guid is %.100s, that of this FMU is %s",
                                fmuGUID ? fmuGUID : "missing", fc_guid);
        return NULL;
    }
    const size_t name_size = strlen(instanceName) + 1;
    FcInstance* instance = calloc(1, sizeof *instance + name_size);
    if (!instance) {
        fc_log_refused_instance(functions, instanceName, "out of memory");
        return NULL;
    }
    memcpy(instance->name, instanceName, name_size);
    instance->callbacks = *functions;
    instance->log_mask = loggingOn ? fc_log_mask_all() : fc_log_mask_quiet();
    instance->experiment.interface = fmuType == fmi2ModelExchange ? FC_MODEL_EXCHANGE : FC_CO_SIMULATION;
    fc_instance_set_start_values(instance);
    fc_log(instance, FC_CALL_INSTANTIATE, fmi2OK, FC_LOG_EVENTS, "instantiated");
    return instance;
}

void fmi2FreeInstance(fmi2Component c) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_FREE_INSTANCE);
    if (instance) {
        fc_friction_contact_free(&instance->contact);
        free(instance);
    }
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[]) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_SET_DEBUG_LOGGING);
    if (!instance) {
        return fmi2Error;
    }
    if (nCategories > 0 && !categories) {
        return fc_refuse(instance, FC_CALL_SET_DEBUG_LOGGING, "categories is NULL");
    }
    unsigned asked = 0;
    for (size_t i = 0; i < nCategories; i++) {
        const unsigned bit = fc_log_category_bit(categories[i]);
        if (!bit) {
            return fc_refuse(instance, FC_CALL_SET_DEBUG_LOGGING, "log category '%.100s' is unknown",
                             categories[i] ? categories[i] : "NULL");
        }
        asked |= bit;
    }
    if (!loggingOn) {
        instance->log_mask = fc_log_mask_quiet();
    } else {
        instance->log_mask = nCategories > 0 ? asked : fc_log_mask_all();
    }
    return fmi2OK;
}

static const FcVariableInfo* tolerance_variable(void) {
    const FcVariableInfo* info = fc_variables;
    while (info->offset != offsetof(FcVariables, solver.tolerance)) {
        info++;
    }
    return info;
}

static fmi2Status use_tolerance(FcInstance* instance, double tolerance) {
    const FcVariableInfo* info = tolerance_variable();
    const double used = fc_min(fc_max(tolerance, info->min), info->max);
    instance->contact.state.variables.solver.tolerance = used;
    if (used == tolerance) {
        return fmi2OK;
    }
    fc_log(instance, FC_CALL_SETUP_EXPERIMENT, fmi2Warning, FC_LOG_STATUS_WARNING,
           "tolerance = %s is outside %s to %s: %s = %s is used", fc_quantity_text(tolerance, "1").text,
           fc_quantity_text(info->min, "1").text, fc_quantity_text(info->max, "1").text, info->name,
           fc_quantity_text(used, "1").text);
    return fmi2Warning;
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                               fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_SETUP_EXPERIMENT);
    if (!instance) {
        return fmi2Error;
    }
    if (toleranceDefined && isnan(tolerance)) {
        return fc_refuse(instance, FC_CALL_SETUP_EXPERIMENT, "tolerance = nan is not a number");
    }
    if (!isfinite(startTime)) {
        return fc_refuse(instance, FC_CALL_SETUP_EXPERIMENT, "startTime = %s is not a finite number",
                         fc_quantity_text(startTime, "s").text);
    }
    if (stopTimeDefined && isnan(stopTime)) {
        return fc_refuse(instance, FC_CALL_SETUP_EXPERIMENT, "stopTime = nan is not a number");
    }
    if (stopTimeDefined && stopTime < startTime) {
        return fc_refuse(instance, FC_CALL_SETUP_EXPERIMENT, "stopTime = %s is before startTime = %s",
                         fc_quantity_text(stopTime, "s").text, fc_quantity_text(startTime, "s").text);
    }
    FcExperiment* experiment = &instance->experiment;
    experiment->start_time = startTime;
    experiment->has_stop_time = stopTimeDefined && stopTime < INFINITY; // infinity: the run has no end
    experiment->stop_time = experiment->has_stop_time ? stopTime : 0.0;
    if (experiment->tolerance_is_set) {
        return fmi2OK;
    }
    return use_tolerance(instance, toleranceDefined ? tolerance : tolerance_variable()->start);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_ENTER_INITIALIZATION_MODE);
    if (!instance) {
        return fmi2Error;
    }
    instance->experiment.mode = FC_INITIALIZATION_MODE;
    instance->contact.state.clock.time = instance->experiment.start_time;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_EXIT_INITIALIZATION_MODE);
    if (!instance) {
        return fmi2Error;
    }
    FcMessage message;
    const bool is_ode = instance->experiment.interface == FC_MODEL_EXCHANGE;
    fc_friction_contact_free(&instance->contact);
    if ((is_ode && !fc_ode_allows(&instance->contact, &message)) ||
        !fc_friction_contact_initialize(&instance->contact, instance->experiment.start_time, &message)) {
        return fc_refuse(instance, FC_CALL_EXIT_INITIALIZATION_MODE, "%s", message.text);
    }
    if (is_ode) {
        fc_ode_start(&instance->contact);
    }
    instance->experiment.mode = is_ode ? FC_EVENT_MODE : FC_STEP_COMPLETE;
    instance->experiment.outputs_stale = is_ode;
    fc_log_plausibility(instance);
    fc_log(instance, FC_CALL_EXIT_INITIALIZATION_MODE, fmi2OK, FC_LOG_EVENTS, "initialized at %s",
           fc_quantity_text(instance->experiment.start_time, "s").text);
    return fmi2OK;
}

fmi2Status fmi2Terminate(fmi2Component c) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_TERMINATE);
    if (!instance) {
        return fmi2Error;
    }
    instance->experiment.mode = FC_TERMINATED;
    fc_log(instance, FC_CALL_TERMINATE, fmi2OK, FC_LOG_EVENTS, "terminated at %s",
           fc_quantity_text(instance->contact.state.clock.time, "s").text);
    fc_log(instance, FC_CALL_TERMINATE, fmi2OK, FC_LOG_SOLVER, "%s evaluations since the start",
           fc_quantity_text(instance->contact.state.variables.solver.evaluations, "1").text);
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c) {
    FcInstance* instance = fc_instance_enter(c, FC_CALL_RESET);
    if (!instance) {
        return fmi2Error;
    }
    fc_friction_contact_free(&instance->contact);
    fc_instance_set_start_values(instance);
    fc_log(instance, FC_CALL_RESET, fmi2OK, FC_LOG_EVENTS, "reset to the start values");
    return fmi2OK;
}
