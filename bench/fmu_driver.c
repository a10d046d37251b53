// Times an FMI 2.0 co-simulation FMU as a host in C drives it: SetReal, SetRealInputDerivatives, DoStep, GetReal.
//
//     fmu_driver LIBRARY GUID RESOURCES < job        see job.h
#define _GNU_SOURCE // RTLD_DEFAULT
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2_library.h"
#include "job.h"

static struct {
    Fmi2Library library;
    const char* guid;
    const char* resources;
} fmu;

static void fail(const Fmi2Instance* instance, Run* run, int step) {
    run->failed_at = step;
    snprintf(run->reason, sizeof run->reason, "%s",
             instance->said[0] ? instance->said : "refused without a message");
}

static int initialize(fmi2Component c, const Job* job) {
    const Fmi2Library* fmi = &fmu.library;
    if (fmi->SetupExperiment(c, fmi2False, 0.0, job->start, fmi2False, 0.0) > fmi2Warning) {
        return 0;
    }
    for (int i = 0; i < job->values; i++) {
        const StartValue* value = &job->value[i];
        const fmi2Integer number = (fmi2Integer)value->value;
        const fmi2Status status = value->is_integer ? fmi->SetInteger(c, &value->reference, 1, &number)
                                                    : fmi->SetReal(c, &value->reference, 1, &value->value);
        if (status > fmi2Warning) {
            return 0;
        }
    }
    return fmi->EnterInitializationMode(c) <= fmi2Warning && fmi->ExitInitializationMode(c) <= fmi2Warning;
}

static fmi2Status step(fmi2Component c, const Job* job, const fmi2ValueReference* reference, int k,
                       double* row) {
    const Fmi2Library* fmi = &fmu.library;
    const size_t inputs = (size_t)job->inputs;
    fmi2Status worst = fmi2OK;
    if (inputs > 0) {
        double value[JOB_INPUTS];
        for (int i = 0; i < job->inputs; i++) {
            value[i] = job_sample(&job->input[i], k);
        }
        worst = fmi->SetReal(c, reference, inputs, value);
        if (job->linear && worst <= fmi2Warning) {
            static const fmi2Integer order[JOB_INPUTS] = {1, 1, 1};
            double rate[JOB_INPUTS];
            for (int i = 0; i < job->inputs; i++) {
                rate[i] = (job_sample(&job->input[i], k + 1) - value[i]) / job->step;
            }
            worst = fmi->SetRealInputDerivatives(c, reference, inputs, order, rate);
        }
    }
    if (worst <= fmi2Warning) {
        worst = job->calls ? fmi->DoStep(c, job->start, 0.0, fmi2True)
                           : fmi->DoStep(c, job->start + k * job->step, job->step, fmi2True);
    }
    if (worst <= fmi2Warning) {
        worst = fmi->GetReal(c, job->output, (size_t)job->outputs, row);
    }
    return worst;
}

// Counted by count_allocations.c where that is preloaded.
static long allocations(void) {
    static long (*counted)(void);
    if (!counted) {
        void* found = dlsym(RTLD_DEFAULT, "allocations_counted");
        memcpy(&counted, &found, sizeof counted); // ISO C has no conversion
    }
    return counted ? counted() : -1;
}

// All steps of the job, in which the instances take turns.
static void take_steps(Fmi2Instance* instances, const Job* job, Run* run) {
    fmi2ValueReference reference[JOB_INPUTS];
    for (int i = 0; i < job->inputs; i++) {
        reference[i] = job->input[i].reference;
    }
    for (int k = 0; k < job->count; k++) {
        for (int i = 0; i < job->instances; i++) {
            if (step(instances[i].component, job, reference, k, run->row + k * job->outputs) > fmi2Warning) {
                fail(&instances[i], run, k);
                return;
            }
        }
    }
}

static void run_job(const Job* job, Run* run) {
    Fmi2Instance* instances = calloc((size_t)job->instances, sizeof *instances);
    if (!instances) {
        fprintf(stderr, "error: no memory for the instances of the job\n");
        exit(2);
    }
    const long at_first = allocations();
    int made = 0;
    while (made < job->instances && run->failed_at < 0) {
        Fmi2Instance* instance = &instances[made++];
        if (!fmi2_instance_make(instance, &fmu.library, "bench", fmu.guid, fmu.resources) ||
            !initialize(instance->component, job)) {
            fail(instance, run, 0);
        }
    }
    if (run->failed_at < 0) {
        const long at_start = allocations();
        const double cpu = cpu_seconds();
        take_steps(instances, job, run);
        run->cpu = cpu_seconds() - cpu;
        if (at_start >= 0) {
            run->allocations = allocations() - at_start;
            run->allocations_to_start = at_start - at_first;
        }
        if (job->counts_evaluations && run->failed_at < 0) {
            fmu.library.GetReal(instances[0].component, &job->evaluations, 1, &run->evaluations);
        }
    }
    for (int i = 0; i < made; i++) {
        fmi2_instance_free(&instances[i]);
    }
    free(instances);
}

int main(int argc, char** argv) {
    if (argc != 4) {
        fprintf(stderr, "usage: fmu_driver LIBRARY GUID RESOURCES < job\n");
        return 2;
    }
    char why[FMI2_TEXT];
    if (!fmi2_library_open(&fmu.library, argv[1], why, sizeof why)) {
        fprintf(stderr, "error: the FMU's library: %s\n", why);
        return 2;
    }
    fmu.guid = argv[2];
    fmu.resources = argv[3];
    const Job job = job_read();
    job_measure(&job, run_job);
    return 0;
}
