// The panels: intervals of time over which the bristle's motion or its force is known at 10 points (nodes.h).
//
//     free      delta' = V - r delta, one affine map for all starts; a stuck bristle has r = 0       relaxation.c
//     slipping  delta = D (cos a, sin a): D a' = V_y cos a - V sin a in the plane, a constant along a line   slip.c
//     Coulomb   its force: quadratures                                                             slip.c
#ifndef FC_SOLVER_PANEL_PANEL_H
#define FC_SOLVER_PANEL_PANEL_H

#include "solver/affine_map.h"
#include "solver/panel/nodes.h"

// The trajectories whose errors count.
typedef struct {
    FcVector delta; // m, the start of the one
    double scale;   // m, of the starts of all others, 0 for none
    double speed;   // m/s, of the surfaces, for work and heat: the mean on a line, else the largest,
    double push;    // m/s, and of the bristle and its bound together
    bool for_any;   // the maps are for any start, else for this one alone
    bool has_constant_coefficients; // sigma and g of Dahl's law are constant: delta has a closed form
    bool limit_stands;              // g is constant
} FcPanelStart;

typedef struct {
    FcMap along, across;       // of delta and delta_y
    double z;                  // integral of r = sigma |V| / g over the panel
    double rate, sigma, limit; // r [1/s], sigma [N/m] and g [N] at the end
    double end_error;          // N, estimated, of the force at the end
    double mean_error; // N, estimated, of the mean force over the panel, and of its work over the path
    FcVector delta[FC_POINTS];  // m, of a bounded law
    double to_bound[FC_POINTS]; // m2, |delta|^2 - D^2 of a free panel; m/s, the push of one that slips
} FcPanel;

// The motion between meetings; does not set to_bound.
void fc_relaxation_panel(const FcPlane* plane, const FcNodes* nodes, const FcPanelStart* from,
                         FcPanel* panel);
FC_TWICE(fc_relaxation_panel);

// Coulomb's law.
void fc_coulomb_panel(const FcNodes* nodes, double speed, FcPanel* panel);

// A slip along the bound on the side of from->delta, for that start alone. False if the panel is too long to be solved, in
// the plane.
bool fc_slip_panel(const FcPlane* plane, const FcNodes* nodes, const FcPanelStart* from, FcPanel* panel);

#endif
