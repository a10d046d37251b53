// A panel over which the bristle relaxes little: Gauss quadrature with the integrating factor, no linear
// system.
//
//     delta(x) = e^-G(x) (delta(0) + integral_0^x e^G V dt),      G(x) = integral_0^x sigma |V| / g dt
//
// The integrals are taken over the same Gauss nodes, the inner ones up to each node by the integration
// matrix. This is collocation of G, delta and the impulse together: its order is twice the number of nodes.
//
// Its error is bounded before it is taken. The bound depends on three numbers: half the angle phi by which
// the vibration turns in the panel, half the largest change mu of ln(sigma), and the relaxation z. Over all
// phases, all means of V and all models of the contact, n nodes miss at most (K / (2.94 n))^2n. They miss a
// sine of K radians in half the panel by as much. K is bounded by a linear function of phi, mu, z and
// sqrt(z).
#ifndef FC_SOLVER_GAUSS_PANEL_H
#define FC_SOLVER_GAUSS_PANEL_H

#include "solver/interval.h"
#include "solver/panels/panel.h"

// The panel [t, t + h], h > 0, of 4, 6, 8 or 12 nodes, with an estimate of its errors.
void fc_gauss_panel(const FcScene* scene, double t, double h, int count, const FcTrajectories* from,
                    FcPanel* panel);

// Bound of the error of the force at the panel's end, over the least of 1 and z, and of the mean force, work and heat in
// a panel of that many nodes, all over sigma times the deflection; h [s]. The Stribeck curve is not in it.
double fc_gauss_bound(const FcPace* pace, int nodes, double h, double z);

// The largest z of a bounded panel: the largest that workshop.constants.panel_bound measured.
static const double FC_MOST_BOUNDED = 7.0;

// The panel [t, t + h] of the scene, on which V keeps its sign, with the displacement X [m], the relaxation
// of about z, and the fewest nodes whose bound is small enough; false if there are none. Adds its evaluations
// to *evaluations.
bool fc_bounded_panel(const FcInterval* interval, const FcScene* scene, double t, double h, double X,
                      double z, const FcTrajectories* from, FcPanel* panel, double* evaluations);

#endif
