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
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "fmi2Functions.h"
#include "fmi2_library.h"
#include "random.h"
#include "variable_reference.h"

static const double F_C = 55.0; // N and Hz, the start values
static const double F = 20e3;
static const double LIMIT = 1e-11; // of the drift, relative to the work

static void demand(const Fmi2Instance* contact, fmi2Status status, const char* call) {
    if (status != fmi2OK) {
        fprintf(stderr, "error: %s returns %d: %s\n", call, (int)status, contact->said);
        exit(2);
    }
}

static void set(Fmi2Instance* contact, size_t offset, double value) {
    const fmi2ValueReference vr = reference_of(offset);
    demand(contact, fmi2SetReal(contact->component, &vr, 1, &value), "fmi2SetReal");
}

static double get(const Fmi2Instance* contact, size_t offset) {
    const fmi2ValueReference vr = reference_of(offset);
    double value = 0.0;
    demand(contact, fmi2GetReal(contact->component, &vr, 1, &value), "fmi2GetReal");
    return value;
}

static void step(const Fmi2Instance* contact, double t, double h) {
    demand(contact, fmi2DoStep(contact->component, t, h, fmi2True), "fmi2DoStep");
}

static void initialize(Fmi2Instance* contact, double V, double V_1) {
    if (!fmi2_instance_make(contact, &fmi2_linked, "soak", fc_guid, NULL)) {
        fprintf(stderr, "error: %s\n", contact->said);
        exit(2);
    }
    set(contact, offsetof(FcVariables, V), V);
    set(contact, offsetof(FcVariables, vibration.V_1), V_1);
    set(contact, offsetof(FcVariables, solver.tolerance), 1e-9);
    fmi2Component c = contact->component;
    demand(contact, fmi2EnterInitializationMode(c), "fmi2EnterInitializationMode");
    demand(contact, fmi2ExitInitializationMode(c), "fmi2ExitInitializationMode");
}

static double seconds(void) {
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// A step of about 10^-5 to 1 s whose end t + h is exact, so that no time is lost between steps.
static double uneven_step(double t) {
    volatile double end = t + pow(10.0, -5.0 * random_01());
    return end - t;
}

// Uneven steps from 0 on until the duration is over: how many, and the time reached [s].
static double step_unevenly(const Fmi2Instance* contact, double duration, double* t) {
    double steps = 0.0;
    for (*t = 0.0; *t < duration; steps += 1.0) {
        const double h = uneven_step(*t);
        step(contact, *t, h);
        *t = *t + h;
    }
    return steps;
}

static int report(const char* run, double steps, double began, double work, double drift) {
    printf("%-10s %.3g steps in %.1f s, work %.9g J, drift %.2e of it\n", run, steps, seconds() - began, work,
           drift);
    return fabs(drift) <= LIMIT;
}

static int held(double steps) {
    const double began = seconds();
    const double h = 1e-6;
    Fmi2Instance contact;
    initialize(&contact, 0.005, 0.0);
    double t = 0.0;
    long double expected = 0.0L;
    for (double done = 0.0; done < steps;) {
        const double V = 0.02 * random_01() - 0.01;
        const double before = get(&contact, offsetof(FcVariables, delta));
        set(&contact, offsetof(FcVariables, V), V);
        const double many = fmin(1e6, steps - done);
        for (double i = 0.0; i < many; i += 1.0) {
            step(&contact, t, h);
            t = t + h;
        }
        done += many;
        const double slipped = get(&contact, offsetof(FcVariables, delta)) - before;
        expected += (long double)F_C * (fabsl((long double)V) * (long double)h * (long double)many -
                                        (V < 0.0 ? -1.0L : 1.0L) * (long double)slipped);
    }
    const double work = get(&contact, offsetof(FcVariables, W_f));
    fmi2_instance_free(&contact);
    return report("held", steps, began, work, (double)(((long double)work - expected) / expected));
}

static int vibrating(double duration) {
    const double began = seconds();
    const double V = 0.5;
    const double V_1 = 0.4;
    Fmi2Instance contact;
    initialize(&contact, V, V_1);
    double t;
    const double steps = step_unevenly(&contact, duration, &t);
    const long double two_pi = 6.283185307179586476925286766559L;
    const long double cycles = (long double)F * (long double)t;
    const long double swing =
        (long double)V_1 / (two_pi * (long double)F) * sinl(two_pi * (cycles - floorl(cycles)));
    const double delta = get(&contact, offsetof(FcVariables, delta));
    const long double expected =
        (long double)F_C * ((long double)V * (long double)t + swing - (long double)delta);
    const double work = get(&contact, offsetof(FcVariables, W_f));
    fmi2_instance_free(&contact);
    return report("vibrating", steps, began, work, (double)(((long double)work - expected) / expected));
}

static int reversing(double duration) {
    const double began = seconds();
    Fmi2Instance contact, whole;
    initialize(&contact, 0.1, 0.4);
    initialize(&whole, 0.1, 0.4);
    double t;
    const double steps = step_unevenly(&contact, duration, &t);
    step(&whole, 0.0, t);
    const double work = get(&contact, offsetof(FcVariables, W_f));
    const double expected = get(&whole, offsetof(FcVariables, W_f));
    fmi2_instance_free(&contact);
    fmi2_instance_free(&whole);
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
