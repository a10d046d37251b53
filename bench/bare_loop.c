// The least that scenarios of an FMU cost: the FMI calls in a loop, and nothing else. What a sweep is measured by.
//
//     bare_loop LIBRARY GUID SAMPLES < numbers
//
// Numbers: value references of the frequency f and of initialState; how many variables are set, their value
// references; how many are read at each sample, their references; how many once before and once after the samples,
// their references; how many scenarios, and the values set in each. The samples are those of a period 1/f, settled.
//
// Printed: s of processor time in the loop, and the mean over all scenarios and samples of each variable read.
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "fmi2_library.h"

static const fmi2Integer SETTLED = 2; // of initialState

typedef struct {
    size_t count;
    fmi2ValueReference* reference;
} Variables;

static void stop(const char* why) {
    fprintf(stderr, "error: %s\n", why);
    exit(2);
}

static double number(void) {
    double value = 0.0;
    if (scanf("%lf", &value) != 1) {
        stop("a number is missing");
    }
    return value;
}

static void* memory(size_t count, size_t size) {
    void* block = calloc(count + 1, size);
    if (!block) {
        stop("no memory");
    }
    return block;
}

static Variables variables(void) {
    Variables v = {.count = (size_t)number()};
    v.reference = memory(v.count, sizeof *v.reference);
    for (size_t i = 0; i < v.count; i++) {
        v.reference[i] = (fmi2ValueReference)number();
    }
    return v;
}

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(int argc, char** argv) {
    if (argc != 4) {
        fprintf(stderr, "usage: bare_loop LIBRARY GUID SAMPLES < numbers\n");
        return 2;
    }
    Fmi2Library fmu;
    Fmi2Instance instance;
    char why[FMI2_TEXT];
    if (!fmi2_library_open(&fmu, argv[1], why, sizeof why)) {
        stop(why);
    }
    if (!fmi2_instance_make(&instance, &fmu, "bare", argv[2], NULL)) {
        stop(instance.said);
    }
    fmi2_instance_log_errors(&instance); // as a batch does
    const long samples = strtol(argv[3], NULL, 10);
    const fmi2ValueReference frequency = (fmi2ValueReference)number();
    const fmi2ValueReference initial_state = (fmi2ValueReference)number();
    const Variables set = variables();
    const Variables read = variables();
    const Variables around = variables();
    const size_t scenarios = (size_t)number();
    double* value = memory(scenarios * set.count, sizeof *value);
    for (size_t i = 0; i < scenarios * set.count; i++) {
        value[i] = number();
    }
    double* row = memory(read.count, sizeof *row);
    double* total = memory(read.count, sizeof *total);
    double* end = memory(around.count, sizeof *end);

    const fmi2Component c = instance.component;
    const double began = seconds();
    for (size_t i = 0; i < scenarios; i++) {
        fmu.Reset(c);
        fmu.SetupExperiment(c, fmi2False, 0.0, 0.0, fmi2False, 0.0);
        fmu.SetReal(c, set.reference, set.count, value + i * set.count);
        fmu.SetInteger(c, &initial_state, 1, &SETTLED);
        fmu.EnterInitializationMode(c);
        fmu.ExitInitializationMode(c);
        double f = 0.0;
        fmu.GetReal(c, &frequency, 1, &f);
        double t = 0.0;
        fmu.GetReal(c, around.reference, around.count, end);
        const double h = 1.0 / f / (double)samples;
        for (long k = 0; k < samples; k++) {
            fmu.DoStep(c, t, h, fmi2True);
            fmu.GetReal(c, read.reference, read.count, row);
            for (size_t j = 0; j < read.count; j++) {
                total[j] += row[j];
            }
            t += h;
        }
        fmu.GetReal(c, around.reference, around.count, end);
    }
    printf("%.9g", seconds() - began);
    for (size_t j = 0; j < read.count; j++) {
        printf(" %.17g", total[j] / (double)scenarios / (double)samples);
    }
    printf("\n");
    if (instance.errors) {
        stop(instance.said);
    }
    return 0; // what is allocated goes with the process
}
