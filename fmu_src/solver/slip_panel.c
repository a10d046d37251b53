// A slip around the disc of the bound in the plane: one equation for the angle, not linear, by Newton's method.
#include <assert.h>
#include <math.h>

#include "model/extremes.h"
#include "solver/panel_error.h"

enum { STAGES = FC_STAGES, POINTS = FC_POINTS, START = FC_STAGES, LAST = FC_STAGES - 1 };

// Solves (A^-1 + diagonal) x = right, in place; no diagonal is negative. Gaussian elimination without pivoting.
static void solve(const double* diagonal, double* right) {
    double row[STAGES][STAGES];
    for (int i = 0; i < STAGES; i++) {
        for (int j = 0; j < STAGES; j++) {
            row[i][j] = FC_RADAU.inverse[i][j];
        }
        row[i][i] += diagonal[i];
    }
    for (int k = 0; k < STAGES; k++) {
        const double pivot = 1.0 / row[k][k];
        for (int i = k + 1; i < STAGES; i++) {
            const double factor = row[i][k] * pivot;
            for (int j = k + 1; j < STAGES; j++) {
                row[i][j] -= factor * row[k][j];
            }
            right[i] -= factor * right[k];
        }
        row[k][k] = pivot;
    }
    for (int k = STAGES - 1; k >= 0; k--) {
        right[k] *= row[k][k];
        for (int i = 0; i < k; i++) {
            right[i] -= row[i][k] * right[k];
        }
    }
}

// The largest number of iterations of Newton's method. Chosen empirically: a panel that needs more is too
// long. Half of it refuses good panels, twice of it costs time.
enum { MOST_ITERATIONS = 12 };
// The step of the angle [rad] below which Newton's method ends. Derived: its square is rounding, and so is, to the
// finest tolerance, its multiple if a diagonal is cut and the method is of first order.
static const double LAST_STEP = 1e-10;

// First values of the angles: on the way from a_0 to the direction of V, to which a slip leads over some D.
static void guess_angles(const FcNodes* nodes, const FcPlaneBound* bound, double a_0, double* a) {
    FcVector before = {cos(a_0), sin(a_0)};
    double turned = 0.0;
    for (int i = 0; i < STAGES; i++) {
        const FcVector V = {nodes->V[i], nodes->V_y[i]};
        turned += atan2(fc_across(before, V), fc_product(before, V));
        before = V;
        const double z = (0.5 + FC_RADAU.node[i]) * nodes->tau[i] * nodes->speed[i] / bound[i].D;
        a[i] = a_0 - turned * expm1(-z);
    }
}

// The angles a at the stages, beginning at a_0, with the slope tau / D (V_y cos a - V sin a).
static bool find_angles(const FcNodes* nodes, const FcPlaneBound* bound, double a_0, double* a) {
    guess_angles(nodes, bound, a_0, a);
    for (int tries = 0; tries < MOST_ITERATIONS; tries++) {
        double diagonal[STAGES];
        double step[STAGES];
        for (int i = 0; i < STAGES; i++) {
            const FcVector V = {nodes->V[i], nodes->V_y[i]};
            const double c = cos(a[i]);
            const double s = sin(a[i]);
            const double pace = nodes->tau[i] / bound[i].D;
            double left = pace * (V.y * c - V.x * s);
            for (int j = 0; j < STAGES; j++) {
                left -= FC_RADAU.inverse[i][j] * (a[j] - a_0);
            }
            diagonal[i] = fc_most(0.0, pace * (V.x * c + V.y * s));
            step[i] = left;
        }
        solve(diagonal, step);
        double largest = 0.0;
        for (int i = 0; i < STAGES; i++) {
            a[i] += step[i];
            largest = fc_most(largest, fabs(step[i]));
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

bool fc_plane_slip_panel(const FcPlane* plane, const FcNodes* nodes, const FcFrom* from, FcPanel* panel) {
    assert(!plane->on_line && from->push > 0.0);
    FcPlaneCoefficients at[POINTS];
    FcPlaneBound bound[POINTS];
    double a[POINTS];
    for (int i = 0; i < POINTS; i++) {
        at[i] = fc_nodes_at(nodes, i);
        bound[i] = fc_plane_bound(plane, &at[i], 1, nodes->t[i], nodes->phase[i]);
    }
    const double a_0 = atan2(from->delta.y, from->delta.x);
    if (!find_angles(nodes, bound, a_0, a)) {
        return false;
    }
    a[START] = a_0;
    double FC_PAIRED slope[POINTS];
    double z[POINTS];
    double F_x[POINTS];
    double F_y[POINTS];
    double heat[POINTS]; // N, its power over a speed
    FcMap* map = &panel->along;
    *map = (FcMap){.relaxation = 1.0};
    panel->across = (FcMap){.relaxation = 1.0};
    panel->z = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const FcVector V = {nodes->V[i], nodes->V_y[i]};
        const FcVector n = {cos(a[i]), sin(a[i])};
        const double turns = V.y * n.x - V.x * n.y; // D a'
        const double outwards = fc_product(n, V);
        const double D = bound[i].D;
        const double force = nodes->sigma[i] * D;
        const double weight = FC_RADAU.weight[i] * nodes->tau[i];
        slope[i] = nodes->tau[i] / D * turns;
        z[i] = nodes->tau[i] / D * outwards;
        panel->z += FC_RADAU.weight[i] * z[i];
        F_x[i] = force * n.x;
        F_y[i] = force * n.y;
        panel->delta[i] = (FcVector){D * n.x, D * n.y};
        panel->to_bound[i] = fc_plane_push(plane, &at[i], &bound[i], n);
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
    const double start = bound[START].D;
    const double end = bound[LAST].D;
    map->heat_offset -= 0.5 * (nodes->sigma[LAST] * end * end - nodes->sigma[START] * start * start);
    map->offset = panel->delta[LAST].x;
    panel->across.offset = panel->delta[LAST].y;
    panel->sigma = nodes->sigma[LAST];
    panel->limit = nodes->limit[LAST];
    panel->rate = z[LAST] / nodes->tau[LAST];
    const double force = panel->sigma * bound[LAST].D;
    const double quadrature = fc_error_of_force(nodes, from->speed, 0.0, true, F_x, nodes->V) +
                              fc_error_of_force(nodes, from->speed, 0.0, true, F_y, nodes->V_y) +
                              fc_error_of_mean(nodes, heat);
    fc_set_errors(panel, 0.0, z[LAST], force, fc_radau_unresolved(slope, fc_most(0.0, panel->z)), quadrature);
    return true;
}
