// A panel by Radau IIA collocation of 9 stages: order 17, L-stable, stiffly accurate.
//
// The equation is affine, so the stage values solve one linear system. With A the matrix of the method,
//
//     (A^-1 + diag(h r_i)) u = A^-1 1 u(0) + h V_i,      r = sigma |V| / g,
//
// whose matrix differs from a constant one in the diagonal only. It is solved for two right-hand sides at
// once: the homogeneous equation from the start 1, less this 1 so that a small relaxation keeps its digits,
// and the full equation from the start 0.
#ifndef FC_SOLVER_RADAU_PANEL_H
#define FC_SOLVER_RADAU_PANEL_H

#include "solver/panels/panel.h"
#include "solver/panels/radau_error.h"

// The panel [t, t + h], h > 0. sign is the sign of V over it.
void fc_radau_panel(const FcScene* scene, double t, double h, double sign, const FcTrajectories* from,
                    FcPanel* panel);

#endif
