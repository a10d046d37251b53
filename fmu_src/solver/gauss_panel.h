// A panel over which the bristle relaxes little: Gauss quadrature with the integrating factor, no linear system.
//
//     delta(x) = e^-G(x) (delta(0) + integral_0^x e^G V dt),      G(x) = integral_0^x sigma |V| / g dt
//
// The integrals are taken over the same Gauss nodes, the inner ones up to each node by the integration matrix. This is
// collocation of G, delta and the impulse together: its order is twice the number of nodes.
#ifndef FC_SOLVER_GAUSS_PANEL_H
#define FC_SOLVER_GAUSS_PANEL_H

#include "solver/panel.h"

// The panel [t, t + h], h > 0, of 4, 6, 8 or 12 nodes.
void fc_gauss_panel(const FcScene* scene, double t, double h, int count, const FcTrajectories* from,
                    FcPanel* panel);

// The same without an estimate of its errors.
void fc_gauss_panel_unjudged(const FcScene* scene, double t, double h, int count, const FcTrajectories* from,
                             FcPanel* panel);

#endif
