// A panel over which the bristle relaxes little: Gauss quadrature with the integrating factor, no linear system.
//
//     delta(x) = e^-G(x) (delta(0) + integral_0^x e^G V dt),      G(x) = integral_0^x sigma |V| / g dt
//
// The integrals are taken over the same Gauss nodes, the inner ones up to each node by the integration matrix. This is
// collocation of G, delta and the impulse together: its order is twice the number of nodes.
//
// Where V, sigma and the limit move by the vibration and linear V and d alone, its error is bounded before it is taken. Three
// numbers tell what it has to resolve: half the angle phi by which the vibration turns in it, half of what ln(sigma) may
// move by, mu, and what relaxes, z. Over all phases, all means of V and all models of the contact, n nodes miss at most
// (K / (2.94 n))^2n: a sine of that many radians K in half the panel is missed by as much. K is bounded by a linear function
// of phi, mu, z and sqrt(z).
#ifndef FC_SOLVER_GAUSS_PANEL_H
#define FC_SOLVER_GAUSS_PANEL_H

#include "solver/interval.h"
#include "solver/panels/panel.h"

// The panel [t, t + h], h > 0, of 4, 6, 8 or 12 nodes, with an estimate of its errors.
void fc_gauss_panel(const FcScene* scene, double t, double h, int count, const FcTrajectories* from,
                    FcPanel* panel);

// No panel that relaxes by more is bounded: the largest z that workshop.constants.panel_bound measured.
static const double FC_MOST_BOUNDED = 7.0;

// The panel [t, t + h] of the scene over which V keeps its sign, of the displacement X [m] and the relaxation of about z, with
// the fewest nodes whose bound is small enough; false where there are none. Adds to *evaluations what it takes.
bool fc_bounded_panel(const FcInterval* interval, const FcScene* scene, double t, double h, double X,
                      double z, const FcTrajectories* from, FcPanel* panel, double* evaluations);

#endif
