#include "solver/gauss_panel.h"

#include <assert.h>
#include <math.h>

#include "solver/gauss_tables.h"
#include "solver/nodes.h"

// Integrals of f over [0, 1] up to each node.
FC_INLINE void integrate(const FcGaussRule* rule, int n, const double* f, double* integral) {
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

// e^x for x in [0, largest]: Taylor series of e^(x / 2^k) - 1, doubled back k times.
FC_INLINE void exponentials(int n, const double* x, double largest, double* e) {
    double part = 1.0;
    int halvings = 0;
    while (largest * part > 0.25 && halvings < 10) {
        part *= 0.5;
        halvings++;
    }
    for (int i = 0; i < n; i++) {
        const double y = x[i] * part;
        double sum = 1.0 / 479001600; // 1 / 12!
        sum = 1.0 / 39916800 + y * sum;
        sum = 1.0 / 3628800 + y * sum;
        sum = 1.0 / 362880 + y * sum;
        sum = 1.0 / 40320 + y * sum;
        sum = 1.0 / 5040 + y * sum;
        sum = 1.0 / 720 + y * sum;
        sum = 1.0 / 120 + y * sum;
        sum = 1.0 / 24 + y * sum;
        sum = 1.0 / 6 + y * sum;
        sum = 1.0 / 2 + y * sum;
        e[i] = y * (1.0 + y * sum);
    }
    for (int k = 0; k < halvings; k++) {
        for (int i = 0; i < n; i++) {
            e[i] *= 2.0 + e[i];
        }
    }
    for (int i = 0; i < n; i++) {
        e[i] += 1.0;
    }
}

// Of a quadrature that is exact up to the degree 2 n - 1: the tail, falling on for three quarters of the n degrees that it
// would fall for if it fell evenly; as it falls there, or as it fell from the largest value on, whichever is less.
FC_INLINE double quadrature_error(const FcGaussRule* rule, int n, const double* f) {
    const FcTail tail = fc_tail_of(n, &rule->tail[0][0], FC_GAUSS_MOST_NODES, f);
    const double largest = fc_largest(n, f);
    const double fall_3 = tail.fall * tail.fall * tail.fall;
    double falls = 1.0;
    for (int k = 0; k < n / 4; k++) {
        falls *= fall_3;
    }
    const double fell_half = sqrt(tail.top / (largest + 1e-300));
    return fc_beyond_rounding(largest, tail.top) * fc_most(falls, fell_half * sqrt(fell_half));
}

FC_INLINE void panel_of(const FcGaussRule* rule, int n, const FcScene* scene, double t, double h,
                        const FcTrajectories* from, FcPanel* panel) {
    FcNodeCoefficients at;
    fc_node_coefficients(scene, t, h, rule->node, n, &at);
    double z[FC_GAUSS_MOST_NODES];
    double G[FC_GAUSS_MOST_NODES];
    double grown[FC_GAUSS_MOST_NODES]; // e^G
    double source[FC_GAUSS_MOST_NODES];
    double P[FC_GAUSS_MOST_NODES];
    double Q[FC_GAUSS_MOST_NODES];
    double u[FC_GAUSS_MOST_NODES];
    double f[FC_GAUSS_MOST_NODES];
    const double signed_h = copysign(h, at.V[n / 2]);
    for (int i = 0; i < n; i++) {
        z[i] = signed_h * at.V[i] * at.sigma[i] / at.limit[i];
    }
    integrate(rule, n, z, G);
    const double whole = fc_dot(n, rule->weight, z);
    exponentials(n, G, whole, grown);
    for (int i = 0; i < n; i++) {
        source[i] = h * at.V[i] * grown[i];
    }
    integrate(rule, n, source, Q);
    for (int i = 0; i < n; i++) {
        P[i] = 1.0 / grown[i];
        Q[i] *= P[i];
        u[i] = P[i] * from->delta_0 + Q[i];
    }
    const double relaxation = -expm1(-whole);
    panel->map =
        (FcMap){.relaxation = relaxation, .offset = (1.0 - relaxation) * fc_dot(n, rule->weight, source)};
    fc_panel_integrals(n, rule->weight, P, Q, z, at.V, at.sigma, h, &panel->map);
    panel->z = whole;

    const double sigma = fc_most(at.sigma[0], fc_most(at.sigma[n / 2], at.sigma[n - 1]));
    panel->end_error = sigma * (1.0 - relaxation) *
                       (quadrature_error(rule, n, source) +
                        (fabs(from->delta_0) + from->scale) * quadrature_error(rule, n, z));
    const double side = copysign(1.0, signed_h);
    fc_panel_force(n, &at, side, from->speed, 0.0, u, f);
    panel->mean_error = quadrature_error(rule, n, f);
    if (from->scale != 0.0) {
        for (int i = 0; i < n; i++) {
            u[i] = from->scale * P[i];
        }
        fc_panel_force(n, &at, side, from->speed, 0.0, u, f);
        panel->mean_error += quadrature_error(rule, n, f);
    }
}

void fc_gauss_panel(const FcScene* scene, double t, double h, int count, const FcTrajectories* from,
                    FcPanel* panel) {
    assert(h > 0.0);
    switch (count) { // constants where panel_of is inlined
    case 4:
        panel_of(&FC_GAUSS_4, 4, scene, t, h, from, panel);
        break;
    case 6:
        panel_of(&FC_GAUSS_6, 6, scene, t, h, from, panel);
        break;
    case 8:
        panel_of(&FC_GAUSS_8, 8, scene, t, h, from, panel);
        break;
    default:
        panel_of(&FC_GAUSS_12, 12, scene, t, h, from, panel);
        break;
    }
}
