// A Gauss panel whose error is known before it is taken: no estimate, no second try.
//
// Where V, sigma and the limit move by the vibration and linear inputs alone, three numbers tell what a panel has to resolve:
// half the angle phi by which the vibration turns in it, half of what ln(sigma) may move by, mu, and what relaxes, z. Over
// all phases, all means of V and all models of the contact, n nodes miss at most (K / (2.94 n))^2n: a sine of that many
// radians K in half the panel is missed by as much. K is bounded by a linear function of phi, mu, z and sqrt(z).
#ifndef FC_SOLVER_BOUNDED_PANEL_H
#define FC_SOLVER_BOUNDED_PANEL_H

#include "solver/panel.h"

// No panel that relaxes by more is bounded.
static const double FC_MOST_BOUNDED = 7.0;

// What moves in an interval.
typedef struct {
    double phi_rate;  // 1/s, phi over the panel's length
    double mu_rate;   // 1/s, mu over the panel's length
    double stiffness; // N/m, the largest sigma
    double limit;     // N, the smallest g
    double damping;   // N, the largest sigma_1 |V|
    double allowed;   // N, of the force
    bool is_bounded;  // whether nothing else moves
} FcMotion;
// For a tolerance [N] of the force.
FcMotion fc_motion(const FcScene* scene, double duration, double largest_stiffness, double tolerance);

// Error of the force at the panel's end, over the least of 1 and z, and of the mean force, work and heat in the panel, over
// sigma times the deflection. n = 4, 6, 8 or 12; h [s].
double fc_panel_bound(const FcMotion* motion, int n, double h, double z);

// The fewest nodes of a panel of that length [s], displacement X [m] and relaxation z whose error is small enough; 0 if there
// are none.
int fc_bounded_panel_nodes(const FcMotion* motion, double h, double X, double z, const FcTrajectories* from);

// The panel [t, t + h] over which V keeps its sign, of the displacement X [m] and the relaxation of about z, if its error is
// small enough.
bool fc_bounded_panel(const FcScene* scene, const FcMotion* motion, double t, double h, double X, double z,
                      const FcTrajectories* from, FcPanel* panel, double* evaluations);

#endif
