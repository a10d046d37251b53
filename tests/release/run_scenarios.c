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
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2FunctionTypes.h"

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

enum { MOST_OUTPUTS = 16 };

static fmi2InstantiateTYPE* instantiate;
static fmi2FreeInstanceTYPE* free_instance;
static fmi2SetupExperimentTYPE* setup_experiment;
static fmi2EnterInitializationModeTYPE* enter_initialization_mode;
static fmi2ExitInitializationModeTYPE* exit_initialization_mode;
static fmi2SetRealTYPE* set_real;
static fmi2SetIntegerTYPE* set_integer;
static fmi2SetRealInputDerivativesTYPE* set_real_input_derivatives;
static fmi2GetRealTYPE* get_real;
static fmi2DoStepTYPE* do_step;

static char scenario[64];
static fmi2Component component;

static void stop(const char* what) {
    fprintf(stderr, "%s: %s\n", scenario, what);
    exit(1);
}

static void must(fmi2Status status, const char* what) {
    if (status != fmi2OK && status != fmi2Warning) {
        stop(what);
    }
}

static void print_message(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                          fmi2String category, fmi2String message, ...) {
    (void)environment;
    if (status != fmi2OK && status != fmi2Warning) {
        fprintf(stderr, "%s %s: %s\n", name, category, message);
    }
}

static const fmi2CallbackFunctions callbacks = {print_message, calloc, free, NULL, NULL};

// Function pointers and what the loader gives are of one size on all platforms; C has no cast between them.
static void load(const char* path) {
    struct {
        const char* name;
        void* pointer;
    } const wanted[] = {
        {"fmi2Instantiate", &instantiate},
        {"fmi2FreeInstance", &free_instance},
        {"fmi2SetupExperiment", &setup_experiment},
        {"fmi2EnterInitializationMode", &enter_initialization_mode},
        {"fmi2ExitInitializationMode", &exit_initialization_mode},
        {"fmi2SetReal", &set_real},
        {"fmi2SetInteger", &set_integer},
        {"fmi2SetRealInputDerivatives", &set_real_input_derivatives},
        {"fmi2GetReal", &get_real},
        {"fmi2DoStep", &do_step},
    };
#ifdef _WIN32
    HMODULE library = LoadLibraryA(path);
#else
    void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
#endif
    if (!library) {
        stop("the library can't be loaded");
    }
    for (size_t k = 0; k < sizeof wanted / sizeof wanted[0]; k++) {
#ifdef _WIN32
        FARPROC function = GetProcAddress(library, wanted[k].name);
#else
        void* function = dlsym(library, wanted[k].name);
#endif
        if (!function) {
            stop(wanted[k].name);
        }
        memcpy(wanted[k].pointer, &function, sizeof function);
    }
}

static void new_scenario(const char* name, const char* guid) {
    if (component) {
        free_instance(component);
    }
    snprintf(scenario, sizeof scenario, "%s", name);
    component = instantiate(scenario, fmi2CoSimulation, guid, NULL, &callbacks, fmi2False, fmi2True);
    if (!component) {
        stop("instantiate");
    }
    must(setup_experiment(component, fmi2False, 0.0, 0.0, fmi2False, 0.0), "setup");
    must(enter_initialization_mode(component), "enter initialization mode");
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
        must(do_step(component, time, h, fmi2True), "step");
        time += h;
        must(get_real(component, references, width, values), "get");
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
    load(argv[1]);
    while (fgets(line, sizeof line, stdin)) {
        unsigned reference = 0, last = 0;
        int integer = 0;
        const fmi2Integer order = 1;
        if (sscanf(line, "scenario %63s", word) == 1) {
            new_scenario(word, argv[2]);
            time = 0.0;
        } else if (sscanf(line, "integer %u %d", &reference, &integer) == 2) {
            must(set_integer(component, &reference, 1, &integer), "set an integer");
        } else if (sscanf(line, "real %u %63s", &reference, number) == 2) {
            const double value = strtod(number, NULL);
            must(set_real(component, &reference, 1, &value), "set a real");
        } else if (sscanf(line, "rate %u %63s", &reference, number) == 2) {
            const double value = strtod(number, NULL);
            must(set_real_input_derivatives(component, &reference, 1, &order, &value), "set a rate");
        } else if (strncmp(line, "start", 5) == 0) {
            must(exit_initialization_mode(component), "exit initialization mode");
        } else if (sscanf(line, "step %63s %d %u %u", number, &integer, &reference, &last) == 4) {
            time = take_steps(time, strtod(number, NULL), integer, reference, last);
        } else {
            stop(line);
        }
    }
    if (component) {
        free_instance(component);
    }
    return 0;
}
