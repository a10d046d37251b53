#include "promise.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "fmu_step.h"

// By what the logarithm of a positive input moves in the step.
static double log_change(double value, double change) {
    return fabs(log(fmax(1e-300, 1.0 + change / value)));
}

// By d the load moves like e^(-lambda d / R_q), and the stiffness by d^-3 besides.
static bool moves_by_decades(const ReferenceScene* s) {
    const double change = s->d_rate * s->h;
    const double by_d = fabs(change) * s->lambda / s->R_q + 3.0 * log_change(s->d - s->a_d, change);
    const double by_load = s->input == INPUT_LOAD ? log_change(s->load, s->load_rate * s->h) : by_d;
    const double by_vibration = 2.0 * s->a_d * s->lambda / s->R_q;
    return fmax(by_load, log_change(s->E, s->E_rate * s->h)) > log(3.0) || by_vibration > log(1e6);
}

// N, of the bristle: its spring, or its damping where all of V moves it.
static double largest_force(const ReferenceScene* s, const ReferenceStep* truth) {
    const double top = fmax(fabs(s->V), fabs(s->V + s->V_rate * s->h)) + s->V_1;
    return fmax(truth->largest, s->sigma_1 * top);
}

int promise_class(const ReferenceScene* s, const ReferenceStep* truth, int method) {
    const bool is_affine = s->law == LAW_DAHL || s->law == LAW_LUGRE;
    const bool by_decades = moves_by_decades(s);
    if (is_affine && method != FMU_COLLOCATION && (method != FMU_CVODE || by_decades)) {
        return CLASS_FIXED;
    }
    return by_decades && largest_force(s, truth) > 3.0 * truth->scale ? CLASS_BEYOND_BY_DECADES : CLASS_HELD;
}

enum { COLUMNS = 5 };
static const double TOLERANCES[COLUMNS] = {1e-2, 1e-3, 1e-4, 1e-6, 1e-9};

static const struct {
    const char* name;
    double factor[COLUMNS]; // of the tolerance
} PROMISES[CLASSES] = {
    [CLASS_FIXED] = {"fixed steps; cvode by decades", {INFINITY, INFINITY, INFINITY, INFINITY, INFINITY}},
    [CLASS_BEYOND_BY_DECADES] = {"beyond the limit by decades", {100, 10, 10, 10, 1000}},
    [CLASS_HELD] = {"all others", {1, 1, 1, 1, 100}},
};

const char* promise_name(int kind) { return PROMISES[kind].name; }

double promise_factor(int kind, double tolerance) {
    int column = 0;
    while (column + 1 < COLUMNS && tolerance < 0.99 * TOLERANCES[column]) {
        column++;
    }
    return PROMISES[kind].factor[column];
}

void promise_print(void) {
    printf("| steps |");
    for (int k = 0; k < COLUMNS; k++) {
        printf(" %g |", TOLERANCES[k]);
    }
    printf("\n");
    for (int kind = 0; kind < CLASSES; kind++) {
        printf("| %s |", PROMISES[kind].name);
        for (int k = 0; k < COLUMNS; k++) {
            const double factor = PROMISES[kind].factor[k];
            isinf(factor) ? printf(" none |") : printf(" %g |", factor);
        }
        printf("\n");
    }
}
