// What a bristle that sticks, and one that slips along its bound, gives in impulse, work and heat (solver.h).
//
// Sticking from a on, delta = delta_a + x(t):    F = sigma delta,  no heat but the damping's.
// Slipping along s D, s = +1 or -1:              F = s g,          heat = integral of g (s V - D').
//
// Where sigma (sticking) or g (slipping) is constant the integrals are closed forms, elsewhere Gauss quadrature of smooth
// functions with the nodes that the tolerance needs, which breaks off where the evaluations exceed FC_MOST_EVALUATIONS.
#ifndef FC_SOLVER_REGIME_INTEGRALS_H
#define FC_SOLVER_REGIME_INTEGRALS_H

#include "solver/bound.h"
#include "solver/path.h"

typedef struct {
    double impulse; // N s
    double work;    // J
    double heat;    // J
    double drag;    // m2/s  integral of delta' V, 0 without sigma_1
} FcTotals;

// How the integrals over the parts of an interval are taken.
typedef struct {
    const FcScene* scene;
    double smooth_time; // s, of bound.h, no shorter anywhere; 0: to be asked where it counts
    int digits;         // of the quadratures
} FcIntegrator;

FcIntegrator fc_integrator(const FcScene* scene, double smooth_time, double tolerance);

// From path->start, at which the deflection is delta [m], to end [s], at which it is delta_end. Adds what it evaluates to
// *evaluations.
FcTotals fc_stick_totals(const FcIntegrator* integrator, const FcPath* path, double delta, double end,
                         double delta_end, double* evaluations);

// From start to end along side * D.
FcTotals fc_slip_totals(const FcIntegrator* integrator, double side, const FcBoundMotion* start,
                        const FcBoundMotion* end, double* evaluations);

#endif
