#include "solver/plane/plane_panel.h"

#include <math.h>

enum { STAGES = FC_RADAU_STAGES, POINTS = FC_RADAU_POINTS, LAST = STAGES - 1, MOST_SIDES = 3 };

void fc_plane_nodes(const FcPlane* plane, const FcPart* part, double u, double h, FcPlaneNodes* nodes) {
    nodes->duration = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const double place = u + (0.5 + FC_RADAU_9.node[i]) * h;
        nodes->t[i] = fc_part_time(part, place);
        nodes->tau[i] = h * fc_straight_pace(&part->in, place);
        nodes->phase[i] = fc_drive_phase(&plane->scene->drive, nodes->t[i]);
        nodes->at[i] = fc_plane_coefficients(plane, nodes->t[i], nodes->phase[i]);
        nodes->duration += FC_RADAU_9.weight[i] * nodes->tau[i];
    }
}

// The linear system: the matrix A^-1 plus a non-negative diagonal, and its right-hand sides, which become the
// solutions. Gaussian elimination without pivoting.
typedef struct {
    double row[STAGES][STAGES];
    double side[STAGES][MOST_SIDES];
} System;

static void solve(System* of, const double* diagonal, int sides) {
    for (int i = 0; i < STAGES; i++) {
        for (int j = 0; j < STAGES; j++) {
            of->row[i][j] = FC_RADAU_9.inverse[i][j];
        }
        of->row[i][i] += diagonal[i];
    }
    for (int k = 0; k < STAGES; k++) {
        const double pivot = 1.0 / of->row[k][k];
        for (int i = k + 1; i < STAGES; i++) {
            const double factor = of->row[i][k] * pivot;
            for (int j = k + 1; j < STAGES; j++) {
                of->row[i][j] -= factor * of->row[k][j];
            }
            for (int j = 0; j < sides; j++) {
                of->side[i][j] -= factor * of->side[k][j];
            }
        }
        of->row[k][k] = pivot;
    }
    for (int k = STAGES - 1; k >= 0; k--) {
        for (int j = 0; j < sides; j++) {
            of->side[k][j] *= of->row[k][k];
            for (int i = 0; i < k; i++) {
                of->side[i][j] -= of->row[i][k] * of->side[k][j];
            }
        }
    }
}

// The estimated error of the mean over the panel of a function whose values are f.
static double error_of_mean(const FcPlaneNodes* nodes, const double* f) {
    double FC_PAIRED weighted[POINTS];
    for (int i = 0; i < POINTS; i++) {
        weighted[i] = f[i] * nodes->tau[i] / nodes->duration;
    }
    return fc_radau_quadrature_error(weighted);
}

// The parts of force, work and heat of one direction, in one function (fc_panel_force).
static double error_of_direction(const FcPlaneNodes* nodes, double speed, const double* F, const double* V) {
    double f[POINTS];
    for (int i = 0; i < POINTS; i++) {
        const FcPlaneCoefficients* at = &nodes->at[i];
        const double of_limit = at->limit > 0.0 ? F[i] / at->limit : 0.0;
        f[i] = F[i] * (1.0 + V[i] / speed + of_limit * (at->speed / speed));
    }
    return error_of_mean(nodes, f);
}

void fc_plane_force_errors(const FcPlaneNodes* nodes, double speed, const double* F_x, const double* F_y,
                           const double* V_x, const double* V_y, FcPanel* panel) {
    panel->end_error = 0.0;
    panel->mean_error =
        error_of_direction(nodes, speed, F_x, V_x) + error_of_direction(nodes, speed, F_y, V_y);
}

void fc_plane_free_panel(const FcPlane* plane, const FcPlaneNodes* nodes, const FcPlaneFrom* from,
                         FcPlanePanel* panel) {
    const bool relaxes = plane->scene->friction->model != FC_ELASTIC_PLASTIC;
    double z[POINTS]; // of the panel's variable
    double FC_PAIRED weight[POINTS];
    double FC_PAIRED P[POINTS];
    double FC_PAIRED Q_x[POINTS];
    double FC_PAIRED Q_y[POINTS];
    double FC_PAIRED V_x[POINTS];
    double FC_PAIRED V_y[POINTS];
    double FC_PAIRED sigma[POINTS];
    double FC_PAIRED rate[POINTS]; // r times the duration
    double F_x[POINTS];
    double F_y[POINTS];
    System system;
    panel->along.z = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const FcPlaneCoefficients* at = &nodes->at[i];
        const double r = relaxes ? at->sigma * at->speed / at->limit : 0.0;
        z[i] = nodes->tau[i] * r;
        rate[i] = nodes->duration * r;
        weight[i] = FC_RADAU_9.weight[i] * nodes->tau[i] / nodes->duration;
        V_x[i] = at->V.x;
        V_y[i] = at->V.y;
        sigma[i] = at->sigma;
        panel->along.z += FC_RADAU_9.weight[i] * z[i];
    }
    for (int i = 0; i < STAGES; i++) {
        system.side[i][0] = -z[i];
        system.side[i][1] = nodes->tau[i] * V_x[i];
        system.side[i][2] = nodes->tau[i] * V_y[i];
    }
    solve(&system, z, 3);
    for (int i = 0; i < POINTS; i++) {
        const bool is_start = i == STAGES;
        const double less_1 = is_start ? 0.0 : system.side[i][0]; // P - 1
        P[i] = 1.0 + less_1;
        Q_x[i] = is_start ? 0.0 : system.side[i][1];
        Q_y[i] = is_start ? 0.0 : system.side[i][2];
        panel->delta[i] = (FcVector){from->delta.x + (less_1 * from->delta.x + Q_x[i]),
                                     from->delta.y + (less_1 * from->delta.y + Q_y[i])};
        F_x[i] = sigma[i] * panel->delta[i].x;
        F_y[i] = sigma[i] * panel->delta[i].y;
    }
    panel->along.map = (FcMap){.relaxation = -system.side[LAST][0], .offset = Q_x[LAST]};
    panel->across = (FcMap){.relaxation = -system.side[LAST][0], .offset = Q_y[LAST]};
    fc_panel_integrals(POINTS, weight, P, Q_x, rate, V_x, sigma, nodes->duration, &panel->along.map);
    fc_panel_integrals(POINTS, weight, P, Q_y, rate, V_y, sigma, nodes->duration, &panel->across);
    panel->along.sigma = sigma[LAST];
    panel->along.limit = nodes->at[LAST].limit;
    panel->along.rate = rate[LAST] / nodes->duration;

    double FC_PAIRED slope_x[POINTS];
    double FC_PAIRED slope_y[POINTS];
    double FC_PAIRED slope_P[POINTS];
    for (int i = 0; i < POINTS; i++) {
        slope_x[i] = nodes->tau[i] * V_x[i] - z[i] * panel->delta[i].x;
        slope_y[i] = nodes->tau[i] * V_y[i] - z[i] * panel->delta[i].y;
        slope_P[i] = -z[i] * P[i];
    }
    double defect =
        fc_radau_unresolved(slope_x, panel->along.z) + fc_radau_unresolved(slope_y, panel->along.z);
    double quadrature =
        error_of_direction(nodes, from->speed, F_x, V_x) + error_of_direction(nodes, from->speed, F_y, V_y);
    if (from->scale != 0.0) {
        defect += from->scale * fc_radau_unresolved(slope_P, panel->along.z);
        for (int i = 0; i < POINTS; i++) {
            F_x[i] = from->scale * sigma[i] * P[i];
        }
        quadrature += error_of_direction(nodes, from->speed, F_x, V_x);
    }
    // 0.0: between its ends r may be less than at both.
    fc_radau_set_errors(&panel->along, 0.0, z[LAST], sigma[LAST], defect, quadrature);
}

// The largest number of iterations of Newton's method. Chosen empirically: a panel that needs more is too
// long. Half of it refuses good panels, twice of it costs time.
enum { MOST_ITERATIONS = 12 };
// The step of the angle [rad] below which Newton's method ends. Derived: its square is rounding, and so is, to the
// finest tolerance, its multiple if a diagonal is cut and the method is of first order.
static const double LAST_STEP = 1e-10;

// First values of the angles: on the way from a_0 to the direction of V, to which a slip leads over some D.
static void guess_angles(const FcPlaneNodes* nodes, const FcPlaneBound* bound, double a_0, double* a) {
    FcVector before = {cos(a_0), sin(a_0)};
    double turned = 0.0;
    for (int i = 0; i < STAGES; i++) {
        const FcVector V = nodes->at[i].V;
        turned += atan2(fc_across(before, V), fc_product(before, V));
        before = V;
        const double z = (0.5 + FC_RADAU_9.node[i]) * nodes->tau[i] * nodes->at[i].speed / bound[i].D;
        a[i] = a_0 - turned * expm1(-z);
    }
}

// The angles a at the stages, beginning at a_0, with the slope tau / D (V_y cos a - V sin a).
static bool find_angles(const FcPlaneNodes* nodes, const FcPlaneBound* bound, double a_0, double* a) {
    guess_angles(nodes, bound, a_0, a);
    for (int tries = 0; tries < MOST_ITERATIONS; tries++) {
        System system;
        double diagonal[STAGES];
        for (int i = 0; i < STAGES; i++) {
            const FcVector V = nodes->at[i].V;
            const double c = cos(a[i]);
            const double s = sin(a[i]);
            const double pace = nodes->tau[i] / bound[i].D;
            double left = pace * (V.y * c - V.x * s);
            for (int j = 0; j < STAGES; j++) {
                left -= FC_RADAU_9.inverse[i][j] * (a[j] - a_0);
            }
            diagonal[i] = fmax(0.0, pace * (V.x * c + V.y * s));
            system.side[i][0] = left;
        }
        solve(&system, diagonal, 1);
        double largest = 0.0;
        for (int i = 0; i < STAGES; i++) {
            a[i] += system.side[i][0];
            largest = fmax(largest, fabs(system.side[i][0]));
        }
        if (!(largest < 2.0)) { // also of no number
            return false;
        }
        if (largest < LAST_STEP) {
            return true;
        }
    }
    return false;
}

bool fc_plane_slip_panel(const FcPlane* plane, const FcPlaneNodes* nodes, const FcPlaneFrom* from,
                         FcPlanePanel* panel) {
    FcPlaneBound bound[POINTS];
    double a[POINTS];
    for (int i = 0; i < POINTS; i++) {
        bound[i] = fc_plane_bound(plane, &nodes->at[i], 1, nodes->t[i], nodes->phase[i]);
    }
    const double a_0 = atan2(from->delta.y, from->delta.x);
    if (!find_angles(nodes, bound, a_0, a)) {
        return false;
    }
    a[STAGES] = a_0;
    double FC_PAIRED slope[POINTS];
    double z[POINTS];
    double F_x[POINTS];
    double F_y[POINTS];
    double V_x[POINTS];
    double V_y[POINTS];
    double heat[POINTS]; // N, its power over a speed
    FcMap* map = &panel->along.map;
    *map = (FcMap){.relaxation = 1.0};
    panel->across = (FcMap){.relaxation = 1.0};
    panel->along.z = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const FcVector V = nodes->at[i].V;
        const FcVector n = {cos(a[i]), sin(a[i])};
        const double turns = V.y * n.x - V.x * n.y; // D a'
        const double outwards = fc_product(n, V);
        const double D = bound[i].D;
        const double force = nodes->at[i].sigma * D;
        const double weight = FC_RADAU_9.weight[i] * nodes->tau[i];
        slope[i] = nodes->tau[i] / D * turns;
        z[i] = nodes->tau[i] / D * outwards;
        panel->along.z += FC_RADAU_9.weight[i] * z[i];
        V_x[i] = V.x;
        V_y[i] = V.y;
        F_x[i] = force * n.x;
        F_y[i] = force * n.y;
        panel->delta[i] = (FcVector){D * n.x, D * n.y};
        panel->to_bound[i] = fc_plane_push(plane, &nodes->at[i], &bound[i], n);
        map->impulse_offset += weight * F_x[i];
        panel->across.impulse_offset += weight * F_y[i];
        map->work_offset += weight * force * outwards;
        // The heat is the work, minus the stored energy, whose rate follows Stribeck's curve at once, minus
        // the part of the stiffness.
        const double power = force * (outwards + 0.5 * D * bound[i].log_sigma_rate);
        heat[i] = power / from->push;
        map->heat_offset += weight * power;
        map->drag_offset += weight * (bound[i].rate * outwards + turns * turns);
    }
    const double start = bound[STAGES].D;
    const double end = bound[LAST].D;
    map->heat_offset -= 0.5 * (nodes->at[LAST].sigma * end * end - nodes->at[STAGES].sigma * start * start);
    map->offset = panel->delta[LAST].x;
    panel->across.offset = panel->delta[LAST].y;
    panel->along.sigma = nodes->at[LAST].sigma;
    panel->along.limit = nodes->at[LAST].limit;
    panel->along.rate = z[LAST] / nodes->tau[LAST];
    const double force = panel->along.sigma * bound[LAST].D;
    const double quadrature = error_of_direction(nodes, from->speed, F_x, V_x) +
                              error_of_direction(nodes, from->speed, F_y, V_y) + error_of_mean(nodes, heat);
    fc_radau_set_errors(&panel->along, 0.0, z[LAST], force,
                        fc_radau_unresolved(slope, fmax(0.0, panel->along.z)), quadrature);
    return true;
}
