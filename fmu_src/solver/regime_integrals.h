// What a bristle that sticks, and one that slips along its bound, gives in impulse, work and heat (solver.h).
//
// Sticking from a on, delta = delta_a + x(t):    F = sigma delta,  no heat but the damping's.
// Slipping along s D, s = +1 or -1:              F = s g,          heat = integral of g (s V - D').
//
// Where sigma (sticking) or g (slipping) is constant the integrals are closed forms, elsewhere Gauss-Legendre
// quadrature of smooth functions, which breaks off where the evaluations exceed FC_MOST_EVALUATIONS.
#ifndef FC_SOLVER_REGIME_INTEGRALS_H
#define FC_SOLVER_REGIME_INTEGRALS_H

#include "model/scene.h"
#include "solver/path.h"

typedef struct {
    double impulse; // N s
    double work;    // J
    double heat;    // J
    double drag;    // m2/s  integral of delta' V, 0 without sigma_1
} FcTotals;

// Sticking is affine in delta_a.
typedef struct {
    double impulse_slope;  // N s/m  integral of sigma
    double impulse_offset; // N s    integral of sigma x
    double work_slope;     // N      integral of sigma V
    double work_offset;    // J      integral of sigma x V
    double drag;           // m2/s
} FcStickIntegrals;

// From path->start to end [s], at which x = x_end [m]. Adds what it evaluates to *evaluations.
FcStickIntegrals fc_stick_integrals(const FcScene* scene, const FcPath* path, double end, double x_end,
                                    double* evaluations);

// From start to end [s] along side * D, D_start and D_end [m] at its ends.
FcTotals fc_slip_totals(const FcScene* scene, double side, double start, double end, double D_start,
                        double D_end, double* evaluations);

#endif
