// Quadrature over the nodes of a Gauss rule: integrals up to each node, exponentials of them, and what a rule misses.
#ifndef FC_SOLVER_GAUSS_RULE_H
#define FC_SOLVER_GAUSS_RULE_H

#include <math.h>

#include "solver/panels/arithmetic.h"
#include "solver/panels/panel.h"
#include "solver/panels/panel_tables.h"

// Nodes of the largest rule. By hand: where these do not suffice a panel is halved.
enum { FC_GAUSS_MOST_NODES = 12 };

// The next number of nodes that there is a rule of.
static inline int fc_gauss_count(double nodes) {
    return nodes <= 4.0 ? 4 : nodes <= 6.0 ? 6 : nodes <= 8.0 ? 8 : FC_GAUSS_MOST_NODES;
}

// Integrals of f over [0, 1] up to each node.
FC_INLINE void fc_gauss_integrate(const FcGaussRule* rule, int n, const double* f, double* integral) {
    double sum[FC_GAUSS_MOST_NODES];
    for (int i = 0; i < n; i++) {
        sum[i] = 0.0;
    }
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            sum[i] += rule->integral[j][i] * f[j];
        }
    }
    for (int i = 0; i < n; i++) {
        integral[i] = sum[i];
    }
}

// e^x - 1 for x in [0, largest]: Taylor series of e^(x / 2^k) - 1, doubled back k times.
FC_INLINE void fc_exponentials_less_1(int n, const double* x, double largest, double* e) {
    double part = 1.0;
    int halvings = 0;
    while (largest * part > FC_SERIES_RANGE && halvings < 10) {
        part *= 0.5;
        halvings++;
    }
    for (int i = 0; i < n; i++) {
        e[i] = fc_series_exp_less_1(x[i] * part);
    }
    for (int k = 0; k < halvings; k++) {
        for (int i = 0; i < n; i++) {
            e[i] *= 2.0 + e[i];
        }
    }
}

// Of a quadrature that is exact up to the degree 2 n - 1: the tail, falling on for three quarters of the n degrees that it
// would fall for if it fell evenly; as it falls there, or as it fell from the largest value on, whichever is less.
FC_INLINE double fc_gauss_error(const FcGaussRule* rule, int n, const double* f) {
    const FcTail tail = fc_tail_of(n, rule->tail, f);
    const double largest = fc_largest(n, f);
    const double fall_3 = tail.fall * tail.fall * tail.fall;
    double falls = 1.0;
    for (int k = 0; k < n / 4; k++) {
        falls *= fall_3;
    }
    const double fell_half = sqrt(tail.top / (largest + 1e-300));
    return fc_beyond_rounding(largest, tail.top) * fc_most(falls, fell_half * sqrt(fell_half));
}

#endif
