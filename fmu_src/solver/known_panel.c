// Panels whose force is known at any time: Coulomb's law, and a slip along a line.
#include <assert.h>
#include <math.h>

#include "solver/panel_error.h"

enum { STAGES = FC_STAGES, POINTS = FC_POINTS, START = FC_STAGES, LAST = FC_STAGES - 1 };

void fc_coulomb_panel(const FcNodes* nodes, double speed, FcPanel* panel) {
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

// The heat is the work, less the stored energy, whose rate follows Stribeck's curve at once, less the part of the
// stiffness.
void fc_line_slip_panel(const FcPlane* plane, const FcNodes* nodes, const FcFrom* from, FcPanel* panel) {
    assert(plane->on_line && from->delta.y == 0.0);
    const int side = from->delta.x < 0.0 ? -1 : 1;
    double F[POINTS];
    double heat[POINTS];
    FcPlaneBound bound[POINTS];
    FcMap* map = &panel->along;
    *map = panel->across = (FcMap){.relaxation = 1.0};
    panel->z = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const FcPlaneCoefficients at = fc_nodes_at(nodes, i);
        bound[i] = fc_plane_bound(plane, &at, 1, nodes->t[i], nodes->phase[i]);
        const double D = bound[i].D;
        const double force = at.sigma * D;
        const double outwards = side * at.V.x;
        const double power = force * (outwards + 0.5 * D * bound[i].log_sigma_rate);
        const double weight = FC_RADAU.weight[i] * nodes->tau[i];
        F[i] = side * force;
        heat[i] = power / from->push;
        panel->z += weight / D * outwards;
        panel->delta[i] = (FcVector){side * D, 0.0};
        panel->to_bound[i] = fc_plane_push(plane, &at, &bound[i], (FcVector){side, 0.0});
        map->impulse_offset += weight * F[i];
        map->work_offset += weight * F[i] * at.V.x;
        map->heat_offset += weight * power;
        map->drag_offset += weight * bound[i].rate * outwards;
    }
    const double D_start = bound[START].D;
    const double D_end = bound[LAST].D;
    map->heat_offset -= 0.5 * (nodes->sigma[LAST] * D_end * D_end - nodes->sigma[START] * D_start * D_start);
    map->offset = side * D_end;
    panel->sigma = nodes->sigma[LAST];
    panel->limit = nodes->limit[LAST];
    panel->rate = side * nodes->V[LAST] / D_end;
    panel->end_error = 0.0;
    if (from->limit_stands && plane->scene->friction->sigma_1 == 0.0) { // a constant force: exact
        map->impulse_offset = F[LAST] * nodes->duration;
        map->work_offset = F[LAST] * nodes->moved[LAST];
        map->heat_offset = map->work_offset - side * F[LAST] * (D_end - D_start);
        panel->mean_error = 0.0;
        return;
    }
    panel->mean_error =
        fc_error_of_force(nodes, from->speed, 0.0, true, F, nodes->V) + fc_error_of_mean(nodes, heat);
}
