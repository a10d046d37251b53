// Loads the FMU's library and runs what stdin says, one word and its numbers after the other. Numbers are hexadecimal
// floating point, so that no digit is lost between platforms.
//
//     scenario                a new instance
//     integer REFERENCE VALUE
//     real REFERENCE VALUE    a start value
//     start                   leaves initialization mode
//     rate REFERENCE VALUE    time derivative of an input over the next step
//     step H COUNT            steps of H seconds; after each prints the scenario's number and the reals OUTPUT ...
//
// usage: run_scenarios LIBRARY GUID OUTPUT ... < words
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2_library.h"

enum { MOST_OUTPUTS = 16 };

static Fmi2Library fmu;
static Fmi2Instance instance;
static int scenario;

static void must(fmi2Status status, const char* word) {
    if (status > fmi2Warning) {
        fprintf(stderr, "scenario %d: %s: %s\n", scenario, word, instance.said);
        exit(1);
    }
}

static double number(void) {
    char text[64] = "";
    must(scanf("%63s", text) == 1 ? fmi2OK : fmi2Error, "a number is missing");
    return strtod(text, NULL);
}

static void new_scenario(const char* guid) {
    scenario++;
    fmi2_instance_free(&instance);
    must(fmi2_instance_make(&instance, &fmu, "scenario", guid, NULL) ? fmi2OK : fmi2Error, "instantiate");
    must(fmu.SetupExperiment(instance.component, fmi2False, 0.0, 0.0, fmi2False, 0.0), "setup");
    must(fmu.EnterInitializationMode(instance.component), "enter initialization mode");
}

static void take_steps(double* time, const fmi2ValueReference references[], size_t width) {
    double values[MOST_OUTPUTS];
    const double h = number();
    for (int count = (int)number(); count > 0; count--) {
        must(fmu.DoStep(instance.component, *time, h, fmi2True), "step");
        *time += h;
        must(fmu.GetReal(instance.component, references, width, values), "get");
        printf("%d", scenario);
        for (size_t k = 0; k < width; k++) {
            printf(" %a", values[k]);
        }
        putchar('\n');
    }
}

int main(int argc, char** argv) {
    char word[16], why[FMI2_TEXT];
    double time = 0.0;
    fmi2ValueReference outputs[MOST_OUTPUTS];
    size_t width = 0;
    for (int k = 3; k < argc && width < MOST_OUTPUTS; k++) {
        outputs[width++] = (fmi2ValueReference)atoi(argv[k]);
    }
    if (width == 0 || !fmi2_library_open(&fmu, argv[1], why, sizeof why)) {
        fprintf(stderr, "usage: run_scenarios LIBRARY GUID OUTPUT ... < words\n");
        return 2;
    }
    while (scanf("%15s", word) == 1) {
        const fmi2Component c = instance.component;
        if (strcmp(word, "scenario") == 0) {
            new_scenario(argv[2]);
            time = 0.0;
        } else if (strcmp(word, "start") == 0) {
            must(fmu.ExitInitializationMode(c), word);
        } else if (strcmp(word, "step") == 0) {
            take_steps(&time, outputs, width);
        } else {
            const fmi2ValueReference reference = (fmi2ValueReference)number();
            const double value = number();
            const fmi2Integer whole = (fmi2Integer)value, order = 1;
            must(word[0] == 'i'   ? fmu.SetInteger(c, &reference, 1, &whole)
                 : word[1] == 'e' ? fmu.SetReal(c, &reference, 1, &value)
                                  : fmu.SetRealInputDerivatives(c, &reference, 1, &order, &value),
                 word);
        }
    }
    fmi2_instance_free(&instance);
    return 0;
}
