// A slip along the bound. Along a line its force is known at any time; around the disc in the plane the angle has one
// equation, which is not linear, solved by Newton's method.
#include <assert.h>
#include <math.h>

#include "model/extremes.h"
#include "solver/integrate/tuning.h"
#include "solver/panel/panel_error.h"
#include "solver/panel/radau.h"

enum { STAGES = FC_STAGES, POINTS = FC_POINTS, START = FC_STAGES, LAST = FC_STAGES - 1 };

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
    for (int tries = 0; tries < FC_MAX_ITERATIONS; tries++) {
        double diagonal[STAGES];
        double left[STAGES];
        for (int i = 0; i < STAGES; i++) {
            const FcVector V = {nodes->V[i], nodes->V_y[i]};
            const double c = cos(a[i]);
            const double s = sin(a[i]);
            const double pace = nodes->tau[i] / bound[i].D;
            left[i] = pace * (V.y * c - V.x * s);
            for (int j = 0; j < STAGES; j++) {
                left[i] -= FC_RADAU.inverse[i][j] * (a[j] - a_0);
            }
            diagonal[i] = fc_max(0.0, pace * (V.x * c + V.y * s));
        }
        FcSystem row;
        fc_collocation_begin(row, diagonal);
        for (int i = 0; i < STAGES; i++) {
            row[i][FC_FIRST] = left[i];
        }
        fc_collocation_solve(row, true, false);
        double largest = 0.0;
        for (int i = 0; i < STAGES; i++) {
            a[i] += row[i][FC_FIRST];
            largest = fc_max(largest, fabs(row[i][FC_FIRST]));
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

// The directions n of the deflection at the points: the side along a line, else those of the angles. False if Newton's method
// fails.
static bool find_directions(const FcPlane* plane, const FcNodes* nodes, const FcPlaneBound* bound,
                            FcVector delta, FcVector* n) {
    double a[POINTS];
    a[START] = atan2(delta.y, delta.x);
    if (!plane->is_one_dimensional && !find_angles(nodes, bound, a[START], a)) {
        return false;
    }
    for (int i = 0; i < POINTS; i++) {
        n[i] = plane->is_one_dimensional ? (FcVector){delta.x < 0.0 ? -1.0 : 1.0, 0.0}
                                         : (FcVector){cos(a[i]), sin(a[i])};
    }
    return true;
}

// The bound and the deflection along it at the points of a panel.
typedef struct {
    FcPlaneCoefficients at[POINTS];
    FcPlaneBound bound[POINTS];
    FcVector n[POINTS];             // the direction of the deflection
    double FC_PAIRED slope[POINTS]; // of its angle, times the duration
    double F_x[POINTS];             // N
    double F_y[POINTS];             // N
    double heat[POINTS];            // N, its power over a speed
} Slip;

// Integrates the force, the work, the heat and the drag over the panel, and sets the deflection and the push at its points.
// `push` [m/s] is that at the panel's start.
static void integrate(const FcPlane* plane, const FcNodes* nodes, double push, Slip* slip, FcPanel* panel) {
    assert(!(push <= 0.0));
    FcMap* map = &panel->along;
    *map = panel->across = (FcMap){.relaxation = 1.0};
    panel->z = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const FcPlaneCoefficients* at = &slip->at[i];
        const FcPlaneBound* bound = &slip->bound[i];
        const FcVector n = slip->n[i];
        const double turns = fc_across(n, at->V); // D a'
        const double outwards = fc_product(n, at->V);
        const double D = bound->D;
        const double force = at->sigma * D;
        const double weight = FC_RADAU.weight[i] * nodes->tau[i];
        slip->slope[i] = nodes->tau[i] / D * turns;
        panel->z += weight / D * outwards;
        slip->F_x[i] = force * n.x;
        slip->F_y[i] = force * n.y;
        panel->delta[i] = (FcVector){D * n.x, D * n.y};
        panel->to_bound[i] = fc_plane_push(plane, at, bound, n);
        map->impulse_offset += weight * slip->F_x[i];
        panel->across.impulse_offset += weight * slip->F_y[i];
        map->work_offset += weight * force * outwards;
        // Heat is the work less the rate of the stored energy E = sigma D^2 / 2. That of the whole E is taken at the ends below,
        // exactly, and has the part sigma' D^2 / 2 of the moving stiffness, which is no heat: it is added back here.
        const double power = force * (outwards + 0.5 * D * bound->log_sigma_rate);
        slip->heat[i] = power / push;
        map->heat_offset += weight * power;
        map->drag_offset += weight * (bound->rate * outwards + turns * turns);
    }
    const double D_start = slip->bound[START].D;
    const double D_end = slip->bound[LAST].D;
    map->heat_offset -= 0.5 * (nodes->sigma[LAST] * D_end * D_end - nodes->sigma[START] * D_start * D_start);
    map->offset = panel->delta[LAST].x;
    panel->across.offset = panel->delta[LAST].y;
}

// Replaces the integrals along a line with a constant limit by their exact values.
static void put_exact(const FcNodes* nodes, const Slip* slip, FcPanel* panel) {
    FcMap* map = &panel->along;
    const double force = slip->F_x[LAST];
    map->impulse_offset = force * nodes->duration;
    map->work_offset = force * nodes->moved[LAST];
    map->heat_offset = map->work_offset - fabs(force) * (slip->bound[LAST].D - slip->bound[START].D);
    panel->end_error = panel->mean_error = 0.0;
}

static void estimate_errors(const FcPlane* plane, const FcNodes* nodes, double speed, const Slip* slip,
                            FcPanel* panel) {
    double quadrature =
        fc_error_of_force(nodes, speed, 0.0, true, slip->F_x, nodes->V) + fc_error_of_mean(nodes, slip->heat);
    double unresolved = 0.0;
    if (!plane->is_one_dimensional) {
        quadrature += fc_error_of_force(nodes, speed, 0.0, true, slip->F_y, nodes->V_y);
        unresolved = fc_radau_unresolved(slip->slope, fc_max(0.0, panel->z));
    }
    fc_set_errors(panel, 0.0, panel->rate * nodes->tau[LAST], panel->sigma * slip->bound[LAST].D, unresolved,
                  quadrature);
}

// In four steps: the bound at the points; the direction of the deflection there; the integrals, whose heat is the work less
// the change of the stored energy; the errors, which are 0 along a line with a constant limit.
bool fc_slip_panel(const FcPlane* plane, const FcNodes* nodes, const FcPanelStart* from, FcPanel* panel) {
    assert(!(from->push <= 0.0) && (!plane->is_one_dimensional || from->delta.y == 0.0));
    Slip slip;
    for (int i = 0; i < POINTS; i++) {
        slip.at[i] = fc_nodes_at(nodes, i);
        slip.bound[i] = fc_plane_bound(plane, &slip.at[i], FC_SLIPPING, nodes->t[i], nodes->phase[i]);
    }
    if (!find_directions(plane, nodes, slip.bound, from->delta, slip.n)) {
        return false;
    }
    integrate(plane, nodes, from->push, &slip, panel);
    panel->sigma = nodes->sigma[LAST];
    panel->limit = nodes->limit[LAST];
    panel->rate = fc_product(slip.n[LAST], slip.at[LAST].V) / slip.bound[LAST].D;
    if (plane->is_one_dimensional && from->limit_stands && plane->scene->friction->sigma_1 == 0.0) {
        put_exact(nodes, &slip, panel);
    } else {
        estimate_errors(plane, nodes, from->speed, &slip, panel);
    }
    return true;
}

// Coulomb's law slips always: its force is known at any time.
void fc_coulomb_panel(const FcNodes* nodes, double speed, FcPanel* panel) {
    assert(nodes->side >= -1 && nodes->side <= 1 && !(nodes->duration < 0.0));
    double F_x[POINTS];
    double F_y[POINTS];
    *panel = (FcPanel){.z = 1.0, .sigma = INFINITY, .limit = nodes->limit[LAST]};
    for (int i = 0; i < POINTS; i++) {
        // Along a line also where V is 0, as beside it.
        const double over_speed = nodes->speed[i] > 0.0 ? nodes->limit[i] / nodes->speed[i] : 0.0;
        F_x[i] = nodes->side != 0 ? nodes->side * nodes->limit[i] : over_speed * nodes->V[i];
        F_y[i] = over_speed * nodes->V_y[i];
        const double weight = FC_RADAU.weight[i] * nodes->tau[i];
        panel->along.impulse_offset += weight * F_x[i];
        panel->across.impulse_offset += weight * F_y[i];
        panel->along.work_offset += weight * nodes->limit[i] * nodes->speed[i];
    }
    panel->along.heat_offset = panel->along.work_offset;
    panel->mean_error = fc_error_of_force(nodes, speed, 0.0, true, F_x, nodes->V) +
                        fc_error_of_force(nodes, speed, 0.0, true, F_y, nodes->V_y);
}
