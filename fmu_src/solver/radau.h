// The errors of a panel by Radau IIA of 9 stages, from functions that are known at its points: order 17, L-stable,
// stiffly accurate. More stages need a larger linear system, fewer need more panels for the same error.
#ifndef FC_SOLVER_RADAU_H
#define FC_SOLVER_RADAU_H

#include <math.h>

#include "solver/panel_tables.h"

// The larger of the two highest Legendre coefficients of a function over the stages, and their ratio from
// degree to degree.
typedef struct {
    double top;
    double fall;
} FcTail;

FC_INLINE FcTail fc_tail_of(const double* f) {
    FcPair first = {0.0, 0.0};
    FcPair second = {0.0, 0.0};
    for (int j = 0; j < FC_POINTS; j++) {
        first += f[j] * fc_pair(FC_RADAU.tail[j]);
        second += f[j] * fc_pair(FC_RADAU.tail[j] + 2);
    }
    const double tiny = 1e-300;
    const double top = fc_most(fabs(first[0]), fabs(first[1]));
    const double before = fc_most(fabs(second[0]), fabs(second[1]));
    return (FcTail){top, fc_least(1.0, sqrt(top / (before + tiny)))};
}

// x^6: the rest of an error that is orthogonal to the polynomials of degree 7, weighted with a function whose
// Legendre coefficients fall by x. The exponent is three quarters of 8, since x is an estimate.
FC_INLINE double fc_acting_part(double x) {
    const double x_3 = x * x * x;
    return x_3 * x_3;
}

// The part of the slope that the collocation does not resolve and that acts on the end. at_start is the
// defect at the panel's start, where it is largest. The continuation of the tail counts if at_start happens
// to vanish.
FC_INLINE double fc_radau_unresolved(const double* slope, double z) {
    const double at_start = fc_dot(FC_POINTS, FC_RADAU.start, slope);
    const FcTail tail = fc_tail_of(slope);
    const double acts = fc_least(1.0, z / (z + 2.0 * FC_STAGES) + tail.fall);
    return fc_most(fabs(at_start), tail.top * tail.fall) * fc_acting_part(acts);
}

// The error of the integral of f over the panel, which is 1 long. A tail within the rounding of f counts as none.
FC_INLINE double fc_radau_quadrature_error(const double* f) {
    double largest = 0.0;
    for (int i = 0; i < FC_STAGES; i++) {
        largest = fc_most(largest, fabs(f[i]));
    }
    const FcTail tail = fc_tail_of(f);
    return fc_most(0.0, tail.top - 3e-14 * largest) * tail.fall * fc_acting_part(tail.fall);
}

#endif
