// A long run: does anything drift?
//
//     soak STEPS SECONDS
//
// held       STEPS steps of 1 us with V held, of either sign, changed every million steps
// vibrating  SECONDS s at 20 kHz in uneven steps of 1e-5 s to 1 s, V > V_1
// reversing  the same with V < V_1, against one step of the whole length
//
// Where V keeps its sign s over a step, the work is F_C (integral |V| dt - s (delta_1 - delta_0)): the cycle identity
// (Eq. 1, 2). Its right side is summed here in long double.
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "fmi2/variables.h"
#include "fmi2Functions.h"
#include "friction_contact.h"

static const double F_C = 55.0;
static const double F = 20e3;
static const double LIMIT = 1e-11; // of the drift, relative to the work

static void logger(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                   fmi2String category, fmi2String text, ...) {
    (void)environment, (void)name, (void)category;
    if (status == fmi2Error) {
        fprintf(stderr, "error: %s\n", text);
    }
}

static void demand(fmi2Status status, const char* call) {
    if (status != fmi2OK) {
        fprintf(stderr, "error: %s returns %d\n", call, (int)status);
        exit(2);
    }
}

static fmi2ValueReference reference_of(size_t offset) {
    fmi2ValueReference vr = 0;
    while (fc_variables[vr].offset != offset) {
        vr++;
    }
    return vr;
}

static void set(fmi2Component c, size_t offset, double value) {
    const fmi2ValueReference vr = reference_of(offset);
    demand(fmi2SetReal(c, &vr, 1, &value), "fmi2SetReal");
}

static double get(fmi2Component c, size_t offset) {
    const fmi2ValueReference vr = reference_of(offset);
    double value = 0.0;
    demand(fmi2GetReal(c, &vr, 1, &value), "fmi2GetReal");
    return value;
}

static void step(fmi2Component c, double t, double h) { demand(fmi2DoStep(c, t, h, fmi2True), "fmi2DoStep"); }

static fmi2Component initialized(double V, double V_1) {
    static const fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};
    fmi2Component c = fmi2Instantiate("soak", fmi2CoSimulation, fc_guid, NULL, &callbacks, 0, 0);
    if (!c) {
        exit(2);
    }
    set(c, offsetof(FcVariables, V), V);
    set(c, offsetof(FcVariables, F_C), F_C);
    set(c, offsetof(FcVariables, vibration.f), F);
    set(c, offsetof(FcVariables, vibration.V_1), V_1);
    set(c, offsetof(FcVariables, solver.tolerance), 1e-9);
    demand(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0), "fmi2SetupExperiment");
    demand(fmi2EnterInitializationMode(c), "fmi2EnterInitializationMode");
    demand(fmi2ExitInitializationMode(c), "fmi2ExitInitializationMode");
    return c;
}

static double seconds(void) {
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// xorshift64*, in [0, 1).
static double chance(void) {
    static uint64_t x = 88172645463325252u;
    x ^= x >> 12;
    x ^= x << 25;
    x ^= x >> 27;
    return (double)((x * 2685821657736338717u) >> 11) * 0x1p-53;
}

// A step of about 10^-5 to 1 s whose end t + h is exact, so that no time is lost between steps.
static double uneven_step(double t) {
    volatile double end = t + pow(10.0, -5.0 * chance());
    return end - t;
}

static int report(const char* run, double steps, double began, double work, double drift) {
    printf("%-10s %.3g steps in %.1f s, work %.9g J, drift %.2e of it\n", run, steps, seconds() - began, work,
           drift);
    return fabs(drift) <= LIMIT;
}

static int held(double steps) {
    const double began = seconds();
    const double h = 1e-6;
    fmi2Component c = initialized(0.005, 0.0);
    double t = 0.0;
    long double expected = 0.0L;
    for (double done = 0.0; done < steps;) {
        const double V = 0.02 * chance() - 0.01;
        const double before = get(c, offsetof(FcVariables, delta));
        set(c, offsetof(FcVariables, V), V);
        const double many = fmin(1e6, steps - done);
        for (double i = 0.0; i < many; i += 1.0) {
            step(c, t, h);
            t = t + h;
        }
        done += many;
        const double slipped = get(c, offsetof(FcVariables, delta)) - before;
        expected += (long double)F_C * (fabsl((long double)V) * (long double)h * (long double)many -
                                        (V < 0.0 ? -1.0L : 1.0L) * (long double)slipped);
    }
    const double work = get(c, offsetof(FcVariables, W_f));
    fmi2FreeInstance(c);
    return report("held", steps, began, work, (double)(((long double)work - expected) / expected));
}

static int vibrating(double duration) {
    const double began = seconds();
    const double V = 0.5;
    const double V_1 = 0.4;
    fmi2Component c = initialized(V, V_1);
    double t = 0.0;
    double steps = 0.0;
    for (; t < duration; steps += 1.0) {
        const double h = uneven_step(t);
        step(c, t, h);
        t = t + h;
    }
    const long double two_pi = 6.283185307179586476925286766559L;
    const long double cycles = (long double)F * (long double)t;
    const long double swing =
        (long double)V_1 / (two_pi * (long double)F) * sinl(two_pi * (cycles - floorl(cycles)));
    const double delta = get(c, offsetof(FcVariables, delta));
    const long double expected =
        (long double)F_C * ((long double)V * (long double)t + swing - (long double)delta);
    const double work = get(c, offsetof(FcVariables, W_f));
    fmi2FreeInstance(c);
    return report("vibrating", steps, began, work, (double)(((long double)work - expected) / expected));
}

static int reversing(double duration) {
    const double began = seconds();
    const double V = 0.1;
    const double V_1 = 0.4;
    fmi2Component c = initialized(V, V_1);
    fmi2Component whole = initialized(V, V_1);
    double t = 0.0;
    double steps = 0.0;
    for (; t < duration; steps += 1.0) {
        const double h = uneven_step(t);
        step(c, t, h);
        t = t + h;
    }
    step(whole, 0.0, t);
    const double work = get(c, offsetof(FcVariables, W_f));
    const double expected = get(whole, offsetof(FcVariables, W_f));
    fmi2FreeInstance(c);
    fmi2FreeInstance(whole);
    return report("reversing", steps, began, work, (work - expected) / expected);
}

int main(int argc, char** argv) {
    if (argc != 3) {
        fprintf(stderr, "usage: soak STEPS SECONDS\n");
        return 2;
    }
    const int held_well = held(strtod(argv[1], NULL));
    const int vibrated_well = vibrating(strtod(argv[2], NULL));
    const int reversed_well = reversing(strtod(argv[2], NULL));
    return held_well && vibrated_well && reversed_well ? 0 : 1;
}
