// Quadrature over the nodes of a Gauss rule: integrals up to each node, their exponentials, and the error of
// a rule.
#ifndef FC_SOLVER_GAUSS_RULE_H
#define FC_SOLVER_GAUSS_RULE_H

#include <math.h>

#include "solver/panels/arithmetic.h"
#include "solver/panels/panel.h"
#include "solver/panels/panel_tables.h"

// Nodes of the largest rule. If they do not suffice, a panel is halved. Half of them would halve more panels.
enum { FC_GAUSS_MOST_NODES = 12 };

// The next number of nodes for which there is a rule.
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

// The estimated error of the quadrature of f over [0, 1]. The rule is exact up to the degree 2 n - 1, n
// degrees beyond the tail. Coefficients that fell evenly would have fallen by tail.fall^n there. They do not
// fall evenly, so the exponent is 3 (n / 4) in whole numbers: 3, 3, 6 and 9, three quarters of 4, 8 and 12
// nodes and half of 6. The estimate takes the slower of two falls: that of the tail, and the mean fall from
// the largest value to the tail, over n degrees too, to the power of three quarters.
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
