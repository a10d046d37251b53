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

#include "fmi2Functions.h"
#include "fmi2_library.h"
#include "random.h"
#include "variable_reference.h"

static const double F_C = 55.0; // N and Hz, the start values
static const double F = 20e3;
static const double LIMIT = 1e-11; // of the drift, relative to the work

#define SET(contact, variable, value) set(contact, offsetof(FcVariables, variable), value)
#define GET(contact, variable) get(contact, offsetof(FcVariables, variable))

static void demand(const Fmi2Instance* contact, bool is_ok, const char* call) {
    if (!is_ok) {
        fprintf(stderr, "error: %s: %s\n", call, contact->said);
        exit(2);
    }
}

static void set(Fmi2Instance* contact, size_t offset, double value) {
    const fmi2ValueReference vr = reference_of(offset);
    demand(contact, fmi2SetReal(contact->component, &vr, 1, &value) == fmi2OK, "fmi2SetReal");
}

static double get(const Fmi2Instance* contact, size_t offset) {
    const fmi2ValueReference vr = reference_of(offset);
    double value = 0.0;
    demand(contact, fmi2GetReal(contact->component, &vr, 1, &value) == fmi2OK, "fmi2GetReal");
    return value;
}

static void step(const Fmi2Instance* contact, double t, double h) {
    demand(contact, fmi2DoStep(contact->component, t, h, fmi2True) == fmi2OK, "fmi2DoStep");
}

static void start(Fmi2Instance* contact, double V, double V_1) {
    demand(contact, fmi2_instance_make(contact, &fmi2_linked, "soak", fc_guid, NULL), "fmi2Instantiate");
    SET(contact, V, V);
    SET(contact, vibration.V_1, V_1);
    SET(contact, solver.tolerance, 1e-9);
    fmi2Component c = contact->component;
    const bool begins = fmi2EnterInitializationMode(c) == fmi2OK && fmi2ExitInitializationMode(c) == fmi2OK;
    demand(contact, begins, "initialization");
}

// Uneven steps of about 10^-5 to 1 s from 0 on until the duration is over; returns the time reached [s]. Each end t + h is
// exact, so that no time is lost between steps.
static double step_unevenly(const Fmi2Instance* contact, double duration) {
    double t = 0.0;
    while (t < duration) {
        volatile double end = t + pow(10.0, -5.0 * random_01());
        step(contact, t, end - t);
        t = end;
    }
    return t;
}

// Frees the contact; returns whether its work is as expected.
static bool is_right(const char* run, Fmi2Instance* contact, long double expected) {
    const double work = GET(contact, W_f), drift = (double)(((long double)work - expected) / expected);
    printf("%-10s work %.9g J, drift %.2e of it\n", run, work, drift);
    fmi2_instance_free(contact);
    return fabs(drift) <= LIMIT;
}

static bool held(double steps) {
    const double h = 1e-6;
    Fmi2Instance contact;
    start(&contact, 0.005, 0.0);
    double t = 0.0;
    long double expected = 0.0L;
    for (double done = 0.0; done < steps; done += 1e6) {
        const double V = 0.02 * random_01() - 0.01, many = fmin(1e6, steps - done);
        const double before = GET(&contact, delta);
        SET(&contact, V, V);
        for (double i = 0.0; i < many; i += 1.0) {
            step(&contact, t, h);
            t = t + h;
        }
        const long double slipped = copysign(1.0, V) * (GET(&contact, delta) - before);
        expected += (long double)F_C * (fabsl((long double)V) * (long double)h * (long double)many - slipped);
    }
    return is_right("held", &contact, expected);
}

static bool vibrating(double duration) {
    const long double V = 0.5L, V_1 = 0.4L, two_pi = 6.283185307179586476925286766559L;
    Fmi2Instance contact;
    start(&contact, (double)V, (double)V_1);
    const long double t = step_unevenly(&contact, duration), cycles = (long double)F * t;
    const long double swing = V_1 / (two_pi * (long double)F) * sinl(two_pi * (cycles - floorl(cycles)));
    const long double slipped = GET(&contact, delta);
    return is_right("vibrating", &contact, (long double)F_C * (V * t + swing - slipped));
}

static bool reversing(double duration) {
    Fmi2Instance contact, whole;
    start(&contact, 0.1, 0.4);
    start(&whole, 0.1, 0.4);
    step(&whole, 0.0, step_unevenly(&contact, duration));
    const double expected = GET(&whole, W_f);
    fmi2_instance_free(&whole);
    return is_right("reversing", &contact, expected);
}

int main(int argc, char** argv) {
    if (argc != 3) {
        fprintf(stderr, "usage: soak STEPS SECONDS\n");
        return 2;
    }
    const double steps = strtod(argv[1], NULL), seconds = strtod(argv[2], NULL);
    const bool are_right[] = {held(steps), vibrating(seconds), reversing(seconds)};
    return are_right[0] && are_right[1] && are_right[2] ? 0 : 1;
}
