// Coulomb's law, whose force is known at any time.
#include <math.h>

#include "solver/panel_error.h"

enum { POINTS = FC_POINTS, LAST = FC_STAGES - 1 };

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
