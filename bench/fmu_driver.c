// Times an FMI 2.0 co-simulation FMU as a host in C drives it: SetReal, SetRealInputDerivatives, DoStep, GetReal.
//
//     fmu_driver LIBRARY GUID RESOURCES < job        see job.h
#define _GNU_SOURCE // RTLD_DEFAULT
#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2FunctionTypes.h"
#include "job.h"

static struct {
    fmi2InstantiateTYPE* instantiate;
    fmi2SetupExperimentTYPE* setup_experiment;
    fmi2EnterInitializationModeTYPE* enter_initialization;
    fmi2ExitInitializationModeTYPE* exit_initialization;
    fmi2SetRealTYPE* set_real;
    fmi2SetIntegerTYPE* set_integer;
    fmi2SetRealInputDerivativesTYPE* set_rates;
    fmi2GetRealTYPE* get_real;
    fmi2DoStepTYPE* do_step;
    fmi2FreeInstanceTYPE* free_instance;
    const char* guid;
    const char* resources;
    char said[sizeof((Run*)0)->reason]; // last error that the FMU logged
} fmu;

static void logger(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                   fmi2String category, fmi2String message, ...) {
    (void)environment, (void)instance, (void)category;
    if (status < fmi2Error) {
        return;
    }
    va_list arguments;
    va_start(arguments, message);
    vsnprintf(fmu.said, sizeof fmu.said, message, arguments);
    va_end(arguments);
}

// Puts the library's function of this name, or NULL, into the function pointer at target. ISO C has no conversion.
static int function(void* library, const char* name, void* target) {
    void* address = dlsym(library, name);
    memcpy(target, &address, sizeof address);
    return address != NULL;
}

static void load(const char* path) {
    void* library = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    if (!library) {
        fprintf(stderr, "error: the FMU's library can't be loaded: %s\n", dlerror());
        exit(2);
    }
    const struct {
        const char* name;
        void* target;
    } wanted[] = {
        {"fmi2Instantiate", &fmu.instantiate},
        {"fmi2SetupExperiment", &fmu.setup_experiment},
        {"fmi2EnterInitializationMode", &fmu.enter_initialization},
        {"fmi2ExitInitializationMode", &fmu.exit_initialization},
        {"fmi2SetReal", &fmu.set_real},
        {"fmi2SetInteger", &fmu.set_integer},
        {"fmi2SetRealInputDerivatives", &fmu.set_rates},
        {"fmi2GetReal", &fmu.get_real},
        {"fmi2DoStep", &fmu.do_step},
        {"fmi2FreeInstance", &fmu.free_instance},
    };
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        if (!function(library, wanted[i].name, wanted[i].target)) {
            fprintf(stderr, "error: the FMU's library lacks %s\n", wanted[i].name);
            exit(2);
        }
    }
}

static void fail(Run* run, int step) {
    run->failed_at = step;
    snprintf(run->reason, sizeof run->reason, "%s", fmu.said[0] ? fmu.said : "refused without a message");
    for (char* c = run->reason; *c; c++) {
        *c = *c == '\n' ? ' ' : *c;
    }
}

static int initialize(fmi2Component c, const Job* job) {
    if (fmu.setup_experiment(c, fmi2False, 0.0, job->start, fmi2False, 0.0) > fmi2Warning) {
        return 0;
    }
    for (int i = 0; i < job->values; i++) {
        const StartValue* value = &job->value[i];
        const fmi2Integer number = (fmi2Integer)value->value;
        const fmi2Status status = value->is_integer ? fmu.set_integer(c, &value->reference, 1, &number)
                                                    : fmu.set_real(c, &value->reference, 1, &value->value);
        if (status > fmi2Warning) {
            return 0;
        }
    }
    return fmu.enter_initialization(c) <= fmi2Warning && fmu.exit_initialization(c) <= fmi2Warning;
}

static fmi2Status step(fmi2Component c, const Job* job, const fmi2ValueReference* reference, int k,
                       double* row) {
    const size_t inputs = (size_t)job->inputs;
    fmi2Status worst = fmi2OK;
    if (inputs > 0) {
        double value[JOB_INPUTS];
        for (int i = 0; i < job->inputs; i++) {
            value[i] = job_sample(&job->input[i], k);
        }
        worst = fmu.set_real(c, reference, inputs, value);
        if (job->linear && worst <= fmi2Warning) {
            static const fmi2Integer order[JOB_INPUTS] = {1, 1, 1};
            double rate[JOB_INPUTS];
            for (int i = 0; i < job->inputs; i++) {
                rate[i] = (job_sample(&job->input[i], k + 1) - value[i]) / job->step;
            }
            worst = fmu.set_rates(c, reference, inputs, order, rate);
        }
    }
    if (worst <= fmi2Warning) {
        worst = fmu.do_step(c, job->start + k * job->step, job->step, fmi2True);
    }
    if (worst <= fmi2Warning) {
        worst = fmu.get_real(c, job->output, (size_t)job->outputs, row);
    }
    return worst;
}

// Counted by count_allocations.c where that is preloaded.
static long allocations(void) {
    static long (*counted)(void);
    if (!counted) {
        function(RTLD_DEFAULT, "allocations_counted", &counted);
    }
    return counted ? counted() : -1;
}

static void run_job(const Job* job, Run* run) {
    const long at_first = allocations();
    const fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};
    fmu.said[0] = '\0';
    fmi2Component c =
        fmu.instantiate("bench", fmi2CoSimulation, fmu.guid, fmu.resources, &callbacks, fmi2False, fmi2True);
    if (!c || !initialize(c, job)) {
        fail(run, 0);
    } else {
        fmi2ValueReference reference[JOB_INPUTS];
        for (int i = 0; i < job->inputs; i++) {
            reference[i] = job->input[i].reference;
        }
        const long at_start = allocations();
        const double cpu = cpu_seconds();
        const double wall = wall_seconds();
        for (int k = 0; k < job->count; k++) {
            if (step(c, job, reference, k, run->row + k * job->outputs) > fmi2Warning) {
                fail(run, k);
                break;
            }
        }
        run->wall = wall_seconds() - wall;
        run->cpu = cpu_seconds() - cpu;
        if (at_start >= 0) {
            run->allocations = allocations() - at_start;
            run->allocations_to_start = at_start - at_first;
        }
        if (job->counts_evaluations && run->failed_at < 0) {
            fmu.get_real(c, &job->evaluations, 1, &run->evaluations);
        }
    }
    if (c) {
        fmu.free_instance(c);
    }
}

int main(int argc, char** argv) {
    if (argc != 4) {
        fprintf(stderr, "usage: fmu_driver LIBRARY GUID RESOURCES < job\n");
        return 2;
    }
    load(argv[1]);
    fmu.guid = argv[2];
    fmu.resources = argv[3];
    const Job job = job_read();
    job_measure(&job, run_job);
    return 0;
}
