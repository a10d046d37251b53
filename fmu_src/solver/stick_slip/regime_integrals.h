// What a bristle that sticks, and one that slips along its bound, gives in impulse, work and heat (solver.h).
//
// Sticking from a on, delta = delta_a + x(t):    F = sigma delta,  no heat.
// Slipping along s D, s = +1 or -1:              F = s g,          heat = integral of g (s V - D').
//
// Where sigma (sticking) or g (slipping) is constant the integrals are closed forms, elsewhere Gauss quadrature of smooth
// functions with the nodes that the tolerance needs, which breaks off where the evaluations exceed FC_MOST_EVALUATIONS.
#ifndef FC_SOLVER_REGIME_INTEGRALS_H
#define FC_SOLVER_REGIME_INTEGRALS_H

#include "solver/affine_map.h"
#include "solver/stick_slip/bound.h"

// How the integrals over the parts of an interval are taken.
typedef struct {
    const FcScene* scene;
    double smooth_time; // s, of bound.h, no shorter anywhere; 0: to be asked where it counts
    int digits;         // of the quadratures
} FcIntegrator;

FcIntegrator fc_integrator(const FcScene* scene, double smooth_time, double tolerance);

// The map of a bristle that sticks from start to end [s], over the displacement x [m]. The drag is 0 without sigma_1. Adds what it evaluates to
// *evaluations.
FcMap fc_stick_map(const FcIntegrator* integrator, double start, double end, double x, double* evaluations);

// Integrals along +D from start to end [s]. fc_limit_integrals gives the first two. Adds what it evaluates to
// *evaluations.
typedef struct {
    double limit;         // N s   of g
    double limit_V;       // J     of g V
    double limit_recedes; // J     of g D'
    double V_recedes;     // m2/s  of V D'
} FcSlipIntegrals;
FcSlipIntegrals fc_limit_integrals(const FcIntegrator* integrator, double start, double end,
                                   double* evaluations);

// Takes the result from start to end along side * D.
void fc_add_slip(const FcIntegrator* integrator, double side, const FcBoundMotion* start,
                 const FcBoundMotion* end, FcStepResult* result);

#endif
