// The free panel, by Radau IIA collocation of 9 stages in the variable u of the part. With A the matrix of the method and
// z_i = r_i tau_i,
//
//     (A^-1 + diag(z_i)) (delta_i - delta_0) = tau_i V_i - z_i delta_0
//
// whose matrix differs from a constant one in the diagonal only. Right-hand sides: one along a line and two in the plane
// for one start; for any start those of delta_0 = 0 and that of the homogeneous equation from the start 1, less this 1
// so that a small relaxation keeps its digits.
#include <assert.h>
#include <math.h>

#include "solver/panel/panel_error.h"
#include "solver/panel/radau.h"

enum { STAGES = FC_STAGES, POINTS = FC_POINTS, START = FC_STAGES, LAST = FC_STAGES - 1 };

// delta = delta_0 + less_1 delta_0 + Q at the points for any start; for one start delta = Q.
typedef struct {
    double FC_PAIRED less_1[POINTS]; // P - 1
    double FC_PAIRED Q_x[POINTS];    // m
    double FC_PAIRED Q_y[POINTS];    // m
} Solution;

FC_INLINE void by_collocation(const FcNodes* nodes, const double* z, FcVector delta_0, bool planar,
                              bool for_any, Solution* of) {
    FcSystem row;
    const int x = planar && !for_any ? FC_PAIR : for_any ? FC_PAIR + !planar : FC_FIRST;
    const int y = FC_PAIR + 1;
    const int homogeneous = planar ? FC_FIRST : FC_PAIR;
    fc_collocation_begin(row, z);
    for (int i = 0; i < STAGES; i++) {
        row[i][homogeneous] = -z[i];
        row[i][x] = nodes->tau[i] * nodes->V[i] - (for_any ? 0.0 : z[i] * delta_0.x);
        if (planar) {
            row[i][y] = nodes->tau[i] * nodes->V_y[i] - (for_any ? 0.0 : z[i] * delta_0.y);
        }
    }
    fc_collocation_solve(row, planar == for_any, planar || for_any);
    for (int i = 0; i < STAGES; i++) {
        of->less_1[i] = for_any ? row[i][homogeneous] : 0.0;
        of->Q_x[i] = (for_any ? 0.0 : delta_0.x) + row[i][x];
        of->Q_y[i] = planar ? (for_any ? 0.0 : delta_0.y) + row[i][y] : 0.0;
    }
    of->less_1[START] = 0.0;
    of->Q_x[START] = for_any ? 0.0 : delta_0.x;
    of->Q_y[START] = for_any ? 0.0 : delta_0.y;
}

// A stuck bristle moves with the surfaces.
FC_INLINE void by_displacement(const FcNodes* nodes, FcVector delta_0, bool for_any, Solution* of) {
    for (int i = 0; i < POINTS; i++) {
        of->less_1[i] = 0.0;
        of->Q_x[i] = (for_any ? 0.0 : delta_0.x) + nodes->moved[i];
        of->Q_y[i] = (for_any ? 0.0 : delta_0.y) + nodes->moved_y[i];
    }
}

// The integrals of F = sigma delta, F V, delta' V = (V - r delta) V and F (V - delta') = sigma r delta^2 with delta = P
// delta_0 + Q. weight is over the duration, z = r times the duration.
FC_INLINE void integrate(const double* weight, bool for_any, const double* P, const double* Q,
                         const double* z, const double* V, const double* sigma, double duration, FcMap* map) {
    FcPair impulse_slope = {0.0, 0.0};
    FcPair impulse_offset = {0.0, 0.0};
    FcPair work_slope = {0.0, 0.0};
    FcPair work_offset = {0.0, 0.0};
    FcPair drag_slope = {0.0, 0.0};
    FcPair drag_offset = {0.0, 0.0};
    FcPair heat_square = {0.0, 0.0};
    FcPair heat_slope = {0.0, 0.0};
    FcPair heat_offset = {0.0, 0.0};
    for (int i = 0; i < POINTS; i += 2) {
        const FcPair w = fc_pair(weight + i);
        const FcPair F = w * fc_pair(sigma + i);
        const FcPair FQ = F * fc_pair(Q + i);
        const FcPair zQ = fc_pair(z + i) * fc_pair(Q + i);
        const FcPair X = duration * fc_pair(V + i);
        const FcPair w_V = w * fc_pair(V + i);
        impulse_offset += FQ;
        work_offset += FQ * X;
        drag_offset += w_V * (X - zQ);
        heat_offset += FQ * zQ;
        if (for_any) {
            const FcPair FP = F * fc_pair(P + i);
            const FcPair zP = fc_pair(z + i) * fc_pair(P + i);
            impulse_slope += FP;
            work_slope += FP * X;
            drag_slope += w_V * zP;
            heat_square += FP * zP;
            heat_slope += FP * zQ;
        }
    }
    map->impulse_slope = duration * fc_pair_sum(impulse_slope);
    map->impulse_offset = duration * fc_pair_sum(impulse_offset);
    map->work_slope = fc_pair_sum(work_slope);
    map->work_offset = fc_pair_sum(work_offset);
    map->drag_slope = -fc_pair_sum(drag_slope);
    map->drag_offset = fc_pair_sum(drag_offset);
    map->heat_square = fc_pair_sum(heat_square);
    map->heat_slope = 2.0 * fc_pair_sum(heat_slope);
    map->heat_offset = fc_pair_sum(heat_offset);
}

// sigma and g are constant along a line: over the path X, with D of the sign of V, delta = D + (delta_0 - D) e^(-X / D).
// Deflection, work and heat are closed forms of the path; the impulse is the quadrature's. There is no damping.
FC_INLINE void take_path(const FcNodes* nodes, const FcPanelStart* from, bool for_any, FcPanel* panel) {
    const FcCoefficients mean = {.V = nodes->moved[LAST], .sigma = panel->sigma, .limit = panel->limit};
    const FcMap path = fc_map_of_constant_scene(&mean, 1.0);
    const double start = for_any ? 0.0 : from->delta.x;
    const double D = (nodes->side < 0 ? -1.0 : 1.0) * panel->limit / panel->sigma;
    const double farthest = 700.0 * fabs(D); // e^-700 of the start
    double FC_PAIRED slope[POINTS];          // of the force, as a density over the panel
    double FC_PAIRED offset[POINTS];
    for (int i = 0; i < POINTS; i++) {
        const double X = nodes->side * nodes->moved[i];
        const double less_1 = fc_exp_less((X > farthest ? farthest : X) / -fabs(D), 1.0);
        const double force = panel->sigma * nodes->tau[i] / nodes->duration;
        slope[i] = force * (1.0 + less_1);
        offset[i] = force * (start + (start - D) * less_1);
    }
    panel->along =
        (FcMap){.relaxation = for_any ? path.relaxation : 1.0,
                .offset = start - path.relaxation * start + path.offset,
                .impulse_offset = nodes->duration * fc_dot(POINTS, FC_RADAU.weight, offset),
                .work_offset = path.work_slope * start + path.work_offset,
                .heat_offset = (path.heat_square * start + path.heat_slope) * start + path.heat_offset};
    panel->across = (FcMap){.relaxation = panel->along.relaxation};
    if (for_any) {
        panel->along.impulse_slope = nodes->duration * fc_dot(POINTS, FC_RADAU.weight, slope);
        panel->along.work_slope = path.work_slope;
        panel->along.heat_square = path.heat_square;
        panel->along.heat_slope = path.heat_slope;
    }
    for (int i = 0; i < POINTS && for_any; i++) {
        offset[i] += from->delta.x * slope[i];
    }
    panel->end_error = 0.0;
    panel->mean_error =
        fc_radau_quadrature_error(offset) + (for_any ? from->scale * fc_radau_quadrature_error(slope) : 0.0);
}

// The integrals of the constant force `held` are those of its quadrature: replaces them by exact ones. So a settled force
// needs no points for V and for the variable.
FC_INLINE void exact_integrals(const FcNodes* nodes, double held, double limit, FcMap* map) {
    const double duration = fc_dot(POINTS, FC_RADAU.weight, nodes->tau);
    double X = 0.0;
    for (int i = 0; i < STAGES; i++) {
        X += FC_RADAU.weight[i] * nodes->tau[i] * nodes->V[i];
    }
    const double rest = nodes->moved[LAST] - X;
    map->impulse_offset += held * (nodes->duration - duration);
    map->work_offset += held * rest;
    map->heat_offset += held * held / limit * nodes->side * rest;
}

// The errors of the motion x, y at the points, and by P of all other starts. A settled force gets its exact integrals.
FC_INLINE void estimate_errors(const FcNodes* nodes, const FcPanelStart* from, bool planar, bool relaxes,
                               const double* z, const double* x, const double* y, const double* P,
                               FcPanel* panel) {
    double F[POINTS];
    double FC_PAIRED slope[POINTS];
    for (int i = 0; i < POINTS; i++) {
        F[i] = nodes->sigma[i] * x[i];
        slope[i] = nodes->tau[i] * nodes->V[i] - z[i] * x[i];
    }
    double held = 0.0;
    if (from->limit_stands && !planar && relaxes) {
        held = F[LAST];
        exact_integrals(nodes, held, panel->limit, &panel->along);
    }
    double defect = relaxes ? fc_radau_unresolved(slope, panel->z) : 0.0;
    double quadrature = fc_error_of_force(nodes, from->speed, held, relaxes, F, nodes->V);
    if (planar) {
        for (int i = 0; i < POINTS; i++) {
            F[i] = nodes->sigma[i] * y[i];
            slope[i] = nodes->tau[i] * nodes->V_y[i] - z[i] * y[i];
        }
        defect += relaxes ? fc_radau_unresolved(slope, panel->z) : 0.0;
        quadrature += fc_error_of_force(nodes, from->speed, 0.0, relaxes, F, nodes->V_y);
    }
    if (from->scale != 0.0) {
        for (int i = 0; i < POINTS; i++) {
            F[i] = from->scale * nodes->sigma[i] * P[i];
            slope[i] = -z[i] * P[i];
        }
        defect += relaxes ? from->scale * fc_radau_unresolved(slope, panel->z) : 0.0;
        quadrature += fc_error_of_force(nodes, from->speed, 0.0, relaxes, F, nodes->V);
    }
    // In the plane r may be less between its ends than at both.
    fc_set_errors(panel, planar ? 0.0 : z[START], z[LAST], panel->sigma, defect, quadrature);
}

// The free panel, in four steps: the relaxation z of each point; the deflection at the points, for one start or for any;
// the maps of deflection, impulse, work, drag and heat; the errors. Along a line with constant sigma and g all of it is a
// closed form of the path.
FC_INLINE void take(const FcPlane* plane, const FcNodes* nodes, const FcPanelStart* from, bool planar,
                    bool for_any, FcPanel* panel) {
    const bool relaxes = !fc_may_stick(plane->scene->friction);
    const double over_duration = 1.0 / nodes->duration;
    double FC_PAIRED z[POINTS];
    double FC_PAIRED rate[POINTS]; // r times the duration
    double FC_PAIRED weight[POINTS];
    for (int i = 0; i < POINTS; i++) {
        const double r =
            relaxes ? nodes->sigma[i] * nodes->speed[i] / fc_max(nodes->limit[i], FC_MIN_DIVISOR) : 0.0;
        z[i] = nodes->tau[i] * r;
        rate[i] = nodes->duration * r;
        weight[i] = FC_RADAU.weight[i] * nodes->tau[i] * over_duration;
    }
    panel->z = fc_dot(POINTS, FC_RADAU.weight, z);
    panel->sigma = nodes->sigma[LAST];
    panel->limit = nodes->limit[LAST];
    panel->rate = rate[LAST] * over_duration;

    if (relaxes && from->has_constant_coefficients && !planar) {
        take_path(nodes, from, for_any, panel);
        return;
    }

    // The deflection at the points.
    Solution of;
    if (!relaxes) {
        by_displacement(nodes, from->delta, for_any, &of);
    } else {
        by_collocation(nodes, z, from->delta, planar, for_any, &of);
    }
    double FC_PAIRED P[POINTS];
    double FC_PAIRED x[POINTS];
    double FC_PAIRED y[POINTS];
    for (int i = 0; i < POINTS; i++) {
        P[i] = for_any ? 1.0 + of.less_1[i] : 0.0;
        x[i] = for_any ? from->delta.x + (of.less_1[i] * from->delta.x + of.Q_x[i]) : of.Q_x[i];
        y[i] = for_any ? from->delta.y + (of.less_1[i] * from->delta.y + of.Q_y[i]) : of.Q_y[i];
    }
    for (int i = 0; i < POINTS && fc_is_bounded(plane->scene->friction); i++) {
        panel->delta[i] = (FcVector){x[i], y[i]};
    }

    // The maps.
    const double relaxation = for_any ? -of.less_1[LAST] : 1.0;
    panel->along = (FcMap){.relaxation = relaxation, .offset = of.Q_x[LAST]};
    panel->across = (FcMap){.relaxation = relaxation, .offset = of.Q_y[LAST]};
    integrate(weight, for_any, P, of.Q_x, rate, nodes->V, nodes->sigma, nodes->duration, &panel->along);
    if (planar) {
        integrate(weight, for_any, P, of.Q_y, rate, nodes->V_y, nodes->sigma, nodes->duration,
                  &panel->across);
    }

    estimate_errors(nodes, from, planar, relaxes, z, x, y, P, panel);
}

void fc_relaxation_panel(const FcPlane* plane, const FcNodes* nodes, const FcPanelStart* from,
                         FcPanel* panel) {
    assert(nodes->duration >= 0.0 && (from->for_any || from->scale == 0.0));
    if (plane->is_one_dimensional && !from->for_any) {
        take(plane, nodes, from, false, false, panel);
    } else if (plane->is_one_dimensional) {
        take(plane, nodes, from, false, true, panel);
    } else if (!from->for_any) {
        take(plane, nodes, from, true, false, panel);
    } else {
        take(plane, nodes, from, true, true, panel);
    }
    assert(fc_map_contracts(&panel->along) && !(panel->end_error < 0.0 || panel->mean_error < 0.0));
}
