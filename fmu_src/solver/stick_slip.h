// The elastic-plastic bristle over an interval, event by event.
//
// It sticks, delta' = V, while |delta| < D = g / sigma, slips along +D from the moment it meets it until V < D', and
// along -D until V > -D'. From turning point to turning point (turning_points.h) it meets each bound at most once; the
// moment is the root of D -+ (delta_a + x(t)), which rises or falls all the time there.
#ifndef FC_SOLVER_STICK_SLIP_H
#define FC_SOLVER_STICK_SLIP_H

#include "solver/regime_integrals.h"

typedef struct {
    double delta; // m, at the end
    FcTotals totals;
} FcStickSlip;

// Over [0, h] from delta_0 [m], which is taken onto the bound where it lies beyond, what it loses so being heat; to the tolerance over the force's
// scale, to rounding where D stands still. Adds what it evaluates to *evaluations, and breaks off where they exceed
// FC_MOST_EVALUATIONS.
FcStickSlip fc_stick_slip(const FcScene* scene, double tolerance, double h, double delta_0,
                          double* evaluations);

#endif
