// Panels in the plane, by Radau IIA collocation of 9 stages in the variable u that straightens |V|
// (course.h).
//
// Free: r is a number, so the equations of delta and delta_y are two of one kind (panels/radau_panel.h), with
// one matrix. Each has an affine map of its own, and the work, the heat and the drag of both add up.
//
// Slipping along the bound, delta = D (cos a, sin a): D a' = V_y cos a - V sin a. One equation, not linear,
// by Newton's method.
#ifndef FC_SOLVER_PLANE_PANEL_H
#define FC_SOLVER_PLANE_PANEL_H

#include "solver/panels/radau_error.h"
#include "solver/plane/course.h"

// The coefficients of a panel at its stages and its start.
typedef struct {
    double t[FC_RADAU_POINTS];   // s
    double tau[FC_RADAU_POINTS]; // s, dt/du times the panel's length in u
    FcPhase phase[FC_RADAU_POINTS];
    FcPlaneCoefficients at[FC_RADAU_POINTS];
    double duration; // s
} FcPlaneNodes;

// The panel [u, u + h] of the part; rounding takes no node out of it.
void fc_plane_nodes(const FcPlane* plane, const FcPart* part, double u, double h, FcPlaneNodes* nodes);

// The trajectories whose errors count, as FcTrajectories.
typedef struct {
    FcVector delta; // m
    double scale;   // m
    double speed;   // m/s, the largest of the surfaces,
    double push;    // m/s, and of the bristle and its bound together
} FcPlaneFrom;

typedef struct {
    FcPanel along;                    // its map, and the panel's errors
    FcMap across;                     // the map of delta_y
    FcVector delta[FC_RADAU_POINTS];  // m
    double to_bound[FC_RADAU_POINTS]; // m2, |delta|^2 - D^2 of a free panel; m/s, the push of one that slips
} FcPlanePanel;

// The estimated errors of a panel whose force is known at its points.
void fc_plane_force_errors(const FcPlaneNodes* nodes, double speed, const double* F_x, const double* F_y,
                           const double* V_x, const double* V_y, FcPanel* panel);

// A free panel; does not set to_bound.
void fc_plane_free_panel(const FcPlane* plane, const FcPlaneNodes* nodes, const FcPlaneFrom* from,
                         FcPlanePanel* panel);

// A panel that slips along its bound, beginning at from->delta on the bound, for that start alone. False if
// it is too long to be solved.
bool fc_plane_slip_panel(const FcPlane* plane, const FcPlaneNodes* nodes, const FcPlaneFrom* from,
                         FcPlanePanel* panel);

#endif
