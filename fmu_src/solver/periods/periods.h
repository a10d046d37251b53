// Many vibration periods at the cost of a few: the Poincare map of one period, its fixed point, and limit cycles.
//
// With held inputs every period of the vibration is the same map of the deflection, a clamped affine one if
// the bristle has a bound:
//
//     delta -> clamp(P delta + Q, lo, hi),  0 <= P <= 1
//
// The map rises with delta, so the deflection goes one way from period to period. Until the bristle meets its
// bound, n periods are the n-th power of the affine map, and n has a closed form. It follows from the highest
// start that meets no bound, whose period has the same end as the period that begins at the bound. A period
// that meets the bound forgets its start, so periods soon repeat. With static friction break-away is a drop,
// and a cycle of several periods may repeat: some stick, and one slips. With moving inputs the periods differ
// (multirevolution.h).
#ifndef FC_SOLVER_PERIODS_PERIODS_H
#define FC_SOLVER_PERIODS_PERIODS_H

#include <stdbool.h>

#include "solver/periods/segments.h"

// The step [0, h], h [s] >= 0, from the bristle in *result. Adds its integrals to *result. Returns false,
// with *message filled, if the periods or the evaluations are too many.
bool fc_periods_step(const FcScene* scene, const FcSolverOptions* options, double h, FcStepResult* result,
                     FcMessage* message);

// The limit of the bristle in *end after infinitely many periods of a vibrating scene with held inputs.
// Returns the mean of F (solver.h) [N] over a period of that state, or over the periods that repeat. Adds its
// evaluations to end->evaluations. *scatters: static friction lets none repeat, and the mean is that of many.
FcVector fc_periods_settled(const FcScene* scene, const FcSolverOptions* options, FcStepResult* end,
                            bool* scatters);

#endif
