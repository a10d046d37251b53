// One step of the 9-stage Radau IIA collocation for the Dahl equation: order 17, L-stable, stiffly accurate.
//
// The equation is affine, so the stage values solve one linear system. With A the matrix of the method,
//
//     (A^-1 + diag(h g_i)) u = A^-1 1 u(0) + h V_i,      g = sigma |V| / F_C,
//
// whose matrix differs from a constant one in the diagonal only. It is solved for two right-hand sides at once: the
// homogeneous equation started from 1, less that 1 so that a small relaxation keeps its digits, and the full
// equation started from 0.
#ifndef FC_RADAU_STEP_H
#define FC_RADAU_STEP_H

#include "dahl.h"

enum { RADAU_STAGES = 9, RADAU_TAIL = 4 };

// Legendre coefficients of h u' over the step, of the degrees 8, 7, 6, 5: how fast they fall tells the error.
typedef struct {
    double coefficient[RADAU_TAIL];
} RadauTail;

typedef struct {
    double relaxed[RADAU_STAGES]; // homogeneous solution at the stages, less 1
    double driven[RADAU_STAGES];  // full solution from 0 at the stages [m]
    double z[RADAU_STAGES];       // h g at the stages
    double shift[RADAU_STAGES];   // h V at the stages [m]
    double sigma[RADAU_STAGES];   // N/m
    double z_mean;                // integral of g over the step
} RadauStep;

// sign is the sign of V over the step [t, t + h], h > 0: V does not reverse inside.
void radau_step(const DahlProblem* problem, double t, double h, double sign, RadauStep* step);

// integral of sigma u over the step [N s] for the solutions started from 1 and from 0.
double radau_impulse_relaxed(const RadauStep* step, double h);
double radau_impulse_driven(const RadauStep* step, double h);

// Tails of the trajectory that starts the step at u_0 [m]: homogeneous, and full.
RadauTail radau_tail_homogeneous(const RadauStep* step, double u_0);
RadauTail radau_tail_full(const RadauStep* step, double u_0);

// Estimated error at the end of the step [m] of a trajectory with this tail.
double radau_error(const RadauTail* tail, double z_mean);

#endif
