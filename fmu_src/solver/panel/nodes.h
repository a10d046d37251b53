// The coefficients of the bristle's equation at the points of a panel: its 9 stages, and then its start.
#ifndef FC_SOLVER_PANEL_NODES_H
#define FC_SOLVER_PANEL_NODES_H

#include "solver/integrate/time_map.h"
#include "solver/panel/arithmetic.h"
#include "solver/panel/panel_tables.h"

typedef struct {
    double t[FC_POINTS];               // s
    double FC_PAIRED tau[FC_POINTS];   // s, dt/du times the panel's length in u
    FcPhase phase[FC_POINTS];          // of the vibration
    double FC_PAIRED V[FC_POINTS];     // m/s
    double FC_PAIRED V_y[FC_POINTS];   // m/s
    double speed[FC_POINTS];           // m/s, |V|; along a line side V, also by rounding beyond the reversal
    double FC_PAIRED sigma[FC_POINTS]; // N/m
    double limit[FC_POINTS];           // N, g at that speed
    double static_limit[FC_POINTS];    // N
    double moved[FC_POINTS];           // m, the displacement from the panel's start on
    double moved_y[FC_POINTS];         // m
    double duration;                   // s
    int side;                          // along a line, the sign of V; else 0
} FcNodes;

// The panel [u, u + h] of the part, h > 0, or 0 by underflow. Rounding takes no point out of the part.
void fc_nodes_make(const FcPlane* plane, const FcPart* part, double u, double h, FcNodes* nodes);
FC_TWICE(fc_nodes_make);

static inline FcPlaneCoefficients fc_nodes_at(const FcNodes* nodes, int i) {
    return (FcPlaneCoefficients){.V = {nodes->V[i], nodes->V_y[i]},
                                 .speed = nodes->speed[i],
                                 .sigma = nodes->sigma[i],
                                 .limit = nodes->limit[i],
                                 .static_limit = nodes->static_limit[i]};
}

#endif
