// Loads the FMU's library and runs what stdin says, one command a line. References are value references, numbers
// are read and printed as hexadecimal floating point, so that no digit is lost between platforms.
//
//     scenario NAME           a new instance
//     integer REFERENCE VALUE
//     real REFERENCE VALUE    a start value, or an input or tunable parameter after `start`
//     start                   leaves initialization mode
//     rate REFERENCE VALUE    time derivative of an input over the next step
//     step H COUNT FIRST LAST takes COUNT steps of H seconds; after each prints the reals FIRST .. LAST
//
// usage: run_scenarios LIBRARY GUID < commands
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2_library.h"

enum { MOST_OUTPUTS = 16 };

static Fmi2Library fmu;
static Fmi2Instance instance;
static char scenario[64];

static void stop(const char* what) {
    fprintf(stderr, "%s: %s %s\n", scenario, what, instance.said);
    exit(1);
}

static void must(fmi2Status status, const char* what) {
    if (status != fmi2OK && status != fmi2Warning) {
        stop(what);
    }
}

static void new_scenario(const char* name, const char* guid) {
    fmi2_instance_free(&instance);
    snprintf(scenario, sizeof scenario, "%s", name);
    if (!fmi2_instance_make(&instance, &fmu, scenario, guid, NULL)) {
        stop("instantiate");
    }
    must(fmu.SetupExperiment(instance.component, fmi2False, 0.0, 0.0, fmi2False, 0.0), "setup");
    must(fmu.EnterInitializationMode(instance.component), "enter initialization mode");
}

static double take_steps(double time, double h, int count, unsigned first, unsigned last) {
    fmi2ValueReference references[MOST_OUTPUTS];
    double values[MOST_OUTPUTS];
    const unsigned width = last - first + 1;
    if (last < first || width > MOST_OUTPUTS) {
        stop("too many outputs");
    }
    for (unsigned k = 0; k < width; k++) {
        references[k] = first + k;
    }
    for (int step = 0; step < count; step++) {
        must(fmu.DoStep(instance.component, time, h, fmi2True), "step");
        time += h;
        must(fmu.GetReal(instance.component, references, width, values), "get");
        printf("%s %a", scenario, time);
        for (unsigned k = 0; k < width; k++) {
            printf(" %a", values[k]);
        }
        putchar('\n');
    }
    return time;
}

int main(int argc, char** argv) {
    char line[256], word[64], number[64];
    double time = 0.0;
    if (argc != 3) {
        fprintf(stderr, "usage: run_scenarios LIBRARY GUID < commands\n");
        return 2;
    }
    char why[FMI2_TEXT];
    if (!fmi2_library_open(&fmu, argv[1], why, sizeof why)) {
        stop(why);
    }
    while (fgets(line, sizeof line, stdin)) {
        unsigned reference = 0, last = 0;
        int integer = 0;
        const fmi2Integer order = 1;
        if (sscanf(line, "scenario %63s", word) == 1) {
            new_scenario(word, argv[2]);
            time = 0.0;
        } else if (sscanf(line, "integer %u %d", &reference, &integer) == 2) {
            must(fmu.SetInteger(instance.component, &reference, 1, &integer), "set an integer");
        } else if (sscanf(line, "real %u %63s", &reference, number) == 2) {
            const double value = strtod(number, NULL);
            must(fmu.SetReal(instance.component, &reference, 1, &value), "set a real");
        } else if (sscanf(line, "rate %u %63s", &reference, number) == 2) {
            const double value = strtod(number, NULL);
            must(fmu.SetRealInputDerivatives(instance.component, &reference, 1, &order, &value),
                 "set a rate");
        } else if (strncmp(line, "start", 5) == 0) {
            must(fmu.ExitInitializationMode(instance.component), "exit initialization mode");
        } else if (sscanf(line, "step %63s %d %u %u", number, &integer, &reference, &last) == 4) {
            time = take_steps(time, strtod(number, NULL), integer, reference, last);
        } else {
            stop(line);
        }
    }
    fmi2_instance_free(&instance);
    fmi2_library_close(&fmu);
    return 0;
}
