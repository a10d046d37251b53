// What the two kinds of panel share: their maps by quadrature over the nodes, and the tails that tell their errors.
//
// A panel is an interval of time on which V keeps its sign. The bristle's equation is solved at the panel's nodes for
// all starts at once, delta = P delta_0 + Q, and everything an interval's map holds follows from P and Q there.
#ifndef FC_SOLVER_PANEL_H
#define FC_SOLVER_PANEL_H

#include <math.h>

#include "solver/affine_map.h"
#include "solver/nodes.h"

typedef struct {
    FcMap map;
    double z;                  // integral of r = sigma |V| / g over the panel
    double rate, sigma, limit; // r [1/s], sigma [N/m] and g [N] at the end (of a Radau panel)
    double displacement;       // m, of V by the panel's quadrature
    double end_error;          // N, estimated, of the force at the end
    double mean_error; // N, estimated, of the mean force over the panel, and of its work over the path
} FcPanel;

// The trajectories whose errors count: the one that starts at delta_0 [m], and the homogeneous one that starts at
// scale [m] where the map must hold for any start, else 0. speed [m/s] is what the work is relative to, held [N] the
// force whose work is put right afterwards.
typedef struct {
    double delta_0;
    double scale;
    double speed;
    double held;
} FcTrajectories;

// The loops of a panel run over constants once these are inlined with a constant n.
#define FC_INLINE static inline __attribute__((always_inline))

FC_INLINE double fc_least(double a, double b) { return a < b ? a : b; }
FC_INLINE double fc_most(double a, double b) { return a > b ? a : b; }

FC_INLINE double fc_dot(int n, const double* a, const double* b) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

// Adds the integrals of F = sigma u, F V, u' V = (V - r u) V and F (V - u') = sigma r u^2 with u = P u_0 + Q.
FC_INLINE void fc_panel_integrals(int n, const double* weight, const double* P, const double* Q,
                                  const double* z, const double* V, const double* sigma, double h,
                                  FcMap* map) {
    for (int i = 0; i < n; i++) {
        const double F = weight[i] * sigma[i];
        const double FP = F * P[i];
        const double FQ = F * Q[i];
        const double V_h = h * V[i];
        map->impulse_slope += FP;
        map->impulse_offset += FQ;
        map->work_slope += FP * V_h;
        map->work_offset += FQ * V_h;
        const double w_V = weight[i] * V[i];
        map->drag_slope -= w_V * z[i] * P[i];
        map->drag_offset += w_V * (V_h - z[i] * Q[i]);
        map->heat_square += FP * z[i] * P[i];
        map->heat_slope += 2.0 * FP * z[i] * Q[i];
        map->heat_offset += FQ * z[i] * Q[i];
    }
    map->impulse_slope *= h;
    map->impulse_offset *= h;
}

// The highest Legendre coefficients of a function over the nodes (rows: the four highest degrees)
// and by how much they fall per degree.
typedef struct {
    double top;
    double fall;
} FcTail;

FC_INLINE FcTail fc_tail_of(int n, const double* row, int stride, const double* f) {
    double c[4];
    for (int k = 0; k < 4; k++) {
        c[k] = fabs(fc_dot(n, row, f));
        row += stride;
    }
    const double tiny = 1e-300;
    const double top = fc_most(c[0], c[1]);
    return (FcTail){top, fc_least(1.0, sqrt(top / (fc_most(c[2], c[3]) + tiny)))};
}

FC_INLINE double fc_largest(int n, const double* f) {
    double largest = 0.0;
    for (int i = 0; i < n; i++) {
        largest = fc_most(largest, fabs(f[i]));
    }
    return largest;
}

// Of a tail, what is more than the rounding of a function of that size.
FC_INLINE double fc_beyond_rounding(double largest, double top) {
    return fc_most(0.0, top - 3e-14 * largest);
}

// What the quadratures of F, of F V and of the heat F^2 |V| / g are estimated by: one function whose tail has all three.
// Of the last two, only those of F - held: what the constant force held does is put right by the displacement, which is
// known.
FC_INLINE void fc_panel_force(int n, const FcNodeCoefficients* at, double sign, double speed, double held,
                              const double* u, double* f) {
    for (int i = 0; i < n; i++) {
        const double F = at->sigma[i] * u[i];
        const double V = sign * at->V[i];
        f[i] = F + (F - held) * (V / speed) * (1.0 + (F + held) / (sign * at->limit[i]));
    }
}

#endif
