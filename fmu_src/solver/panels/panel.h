// The common parts of the two kinds of panel: maps by quadrature over the nodes, and tails that estimate
// their errors.
//
// A panel is an interval of time on which V keeps its sign. The bristle's equation is solved at the panel's
// nodes for all starts at once, delta = P delta_0 + Q. All coefficients of the map follow from P and Q there.
#ifndef FC_SOLVER_PANEL_H
#define FC_SOLVER_PANEL_H

#include <math.h>

#include "solver/affine_map.h"
#include "solver/panels/nodes.h"

// The loops of a panel run over constants once these are inlined with a constant n.
#define FC_INLINE static inline __attribute__((always_inline))

typedef struct {
    FcMap map;
    double z;                  // integral of r = sigma |V| / g over the panel
    double rate, sigma, limit; // r [1/s], sigma [N/m] and g [N] at the end (of a Radau panel)
    double displacement;       // m, of V by the panel's quadrature
    double end_error;          // N, estimated, of the force at the end
    double mean_error; // N, estimated, of the mean force over the panel, and of its work over the path
    int nodes;         // of a bounded Gauss panel
} FcPanel;

// The values at a panel's nodes; a Radau panel's start comes last.
typedef struct {
    double V[FC_MOST_NODES];     // m/s
    double sigma[FC_MOST_NODES]; // N/m
    double limit[FC_MOST_NODES]; // N
    double P[FC_MOST_NODES];     // 1, delta = P delta_0 + Q
    double Q[FC_MOST_NODES];     // m
} FcPanelNodes;

FC_INLINE void fc_keep_nodes(FcPanelNodes* keep, int n, const FcNodeCoefficients* at, const double* P,
                             const double* Q) {
    for (int i = 0; keep && i < n; i++) {
        keep->V[i] = at->V[i];
        keep->sigma[i] = at->sigma[i];
        keep->limit[i] = at->limit[i];
        keep->P[i] = P[i];
        keep->Q[i] = Q[i];
    }
}

// The trajectories whose errors count: the one that starts at delta_0 [m], and the homogeneous one that
// starts at scale [m] if the map must hold for any start, else 0. speed [m/s] is the scale of V for the work,
// held [N] the force whose work is corrected afterwards.
typedef struct {
    double delta_0;
    double scale;
    double speed;
    double held;
    FcPanelNodes* keep; // receives the values at the nodes, or NULL
} FcTrajectories;

FC_INLINE double fc_least(double a, double b) { return a < b ? a : b; }
FC_INLINE double fc_most(double a, double b) { return a > b ? a : b; }

// n is even here and in the other functions that read pairs.
FC_INLINE double fc_dot(int n, const double* a, const double* b) {
    FcPair sum = {0.0, 0.0};
    for (int i = 0; i < n; i += 2) {
        sum += fc_pair(a + i) * fc_pair(b + i);
    }
    return fc_pair_sum(sum);
}

// The integrals of F = sigma u, F V, u' V = (V - r u) V and F (V - u') = sigma r u^2 with u = P u_0 + Q.
FC_INLINE void fc_panel_integrals(int n, const double* weight, const double* P, const double* Q,
                                  const double* z, const double* V, const double* sigma, double h,
                                  FcMap* map) {
    FcPair impulse_slope = {0.0, 0.0};
    FcPair impulse_offset = {0.0, 0.0};
    FcPair work_slope = {0.0, 0.0};
    FcPair work_offset = {0.0, 0.0};
    FcPair drag_slope = {0.0, 0.0};
    FcPair drag_offset = {0.0, 0.0};
    FcPair heat_square = {0.0, 0.0};
    FcPair heat_slope = {0.0, 0.0};
    FcPair heat_offset = {0.0, 0.0};
    for (int i = 0; i < n; i += 2) {
        const FcPair w = fc_pair(weight + i);
        const FcPair F = w * fc_pair(sigma + i);
        const FcPair FP = F * fc_pair(P + i);
        const FcPair FQ = F * fc_pair(Q + i);
        const FcPair zP = fc_pair(z + i) * fc_pair(P + i);
        const FcPair zQ = fc_pair(z + i) * fc_pair(Q + i);
        const FcPair V_h = h * fc_pair(V + i);
        const FcPair w_V = w * fc_pair(V + i);
        impulse_slope += FP;
        impulse_offset += FQ;
        work_slope += FP * V_h;
        work_offset += FQ * V_h;
        drag_slope += w_V * zP;
        drag_offset += w_V * (V_h - zQ);
        heat_square += FP * zP;
        heat_slope += FP * zQ;
        heat_offset += FQ * zQ;
    }
    map->impulse_slope = h * fc_pair_sum(impulse_slope);
    map->impulse_offset = h * fc_pair_sum(impulse_offset);
    map->work_slope = fc_pair_sum(work_slope);
    map->work_offset = fc_pair_sum(work_offset);
    map->drag_slope = -fc_pair_sum(drag_slope);
    map->drag_offset = fc_pair_sum(drag_offset);
    map->heat_square = fc_pair_sum(heat_square);
    map->heat_slope = 2.0 * fc_pair_sum(heat_slope);
    map->heat_offset = fc_pair_sum(heat_offset);
}

// The larger of the two highest Legendre coefficients of a function over the nodes, and their ratio from
// degree to degree.
typedef struct {
    double top;
    double fall;
} FcTail;

FC_INLINE FcTail fc_tail_of(int n, const double tail[][4], const double* f) {
    FcPair first = {0.0, 0.0};
    FcPair second = {0.0, 0.0};
    for (int j = 0; j < n; j++) {
        first += f[j] * fc_pair(tail[j]);
        second += f[j] * fc_pair(tail[j] + 2);
    }
    const double tiny = 1e-300;
    const double top = fc_most(fabs(first[0]), fabs(first[1]));
    const double before = fc_most(fabs(second[0]), fabs(second[1]));
    return (FcTail){top, fc_least(1.0, sqrt(top / (before + tiny)))};
}

FC_INLINE double fc_largest(int n, const double* f) {
    double largest = 0.0;
    for (int i = 0; i < n; i++) {
        largest = fc_most(largest, fabs(f[i]));
    }
    return largest;
}

// The part of a tail above the rounding of a function of that size.
FC_INLINE double fc_beyond_rounding(double largest, double top) {
    return fc_most(0.0, top - 3e-14 * largest);
}

// The function f whose tail estimates the quadratures of F, of F V and of the heat F^2 |V| / g together. The
// last two count for F - held alone, since the known displacement corrects the work of the constant force
// `held`. side_per_limit: sgn V / g.
FC_INLINE void fc_panel_force(int n, const FcNodeCoefficients* at, const double* side_per_limit, double side,
                              double speed, double held, const double* u, double* f) {
    const double side_per_speed = side / speed;
    for (int i = 0; i < n; i++) {
        const double F = at->sigma[i] * u[i];
        f[i] = F + (F - held) * (side_per_speed * at->V[i]) * (1.0 + (F + held) * side_per_limit[i]);
    }
}

#endif
