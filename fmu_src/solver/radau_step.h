// One step of the 9-stage Radau IIA collocation for the Dahl equation: order 17, L-stable, stiffly accurate.
//
// The equation is affine, so the stage values solve one linear system. With A the matrix of the method,
//
//     (A^-1 + diag(h r_i)) u = A^-1 1 u(0) + h V_i,      r = sigma |V| / g,
//
// whose matrix differs from a constant one in the diagonal only. It is solved for two right-hand sides at once: the
// homogeneous equation started from 1, less that 1 so that a small relaxation keeps its digits, and the full
// equation started from 0.
#ifndef FC_SOLVER_RADAU_STEP_H
#define FC_SOLVER_RADAU_STEP_H

#include "solver/affine_map.h"

enum { FC_RADAU_STAGES = 9, FC_RADAU_TAIL = 4 };

// Legendre coefficients of h u' over the step, of the degrees 8, 7, 6, 5: how fast they fall tells the error.
typedef struct {
    double coefficient[FC_RADAU_TAIL];
} FcRadauTail;

typedef struct {
    double relaxed[FC_RADAU_STAGES]; // homogeneous solution at the stages, less 1
    double driven[FC_RADAU_STAGES];  // full solution from 0 at the stages [m]
    double z[FC_RADAU_STAGES];       // h r at the stages
    double shift[FC_RADAU_STAGES];   // h V at the stages [m]
    double sigma[FC_RADAU_STAGES];   // N/m
    double saturation;               // g / sigma at the end [m]
    double z_mean;                   // integral of r over the step
} FcRadauStep;

// sign is the sign of V over the step [t, t + h], h > 0: V does not reverse inside.
void fc_radau_step(const FcScene* scene, double t, double h, double sign, FcRadauStep* step);

// The step as a map of the deflection at its start.
FcMap fc_radau_map(const FcRadauStep* step, double h);

// Tails of the trajectory that starts the step at u_0 [m]: homogeneous, and full.
FcRadauTail fc_radau_tail_homogeneous(const FcRadauStep* step, double u_0);
FcRadauTail fc_radau_tail_full(const FcRadauStep* step, double u_0);

// Estimated error at the end of the step [m] of a trajectory with this tail.
double fc_radau_error(const FcRadauTail* tail, double z_mean);

#endif
