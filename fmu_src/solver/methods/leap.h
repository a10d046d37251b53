// Many vibration periods with moving inputs, for the price of some.
//
// Period k of a step begins with the inputs V + V' k T, d + d' k T, ... at the same phase. Its map is a
// smooth function of k, which need not be whole: it is sampled at the Chebyshev points of a block of n
// periods and interpolated, and the n maps are applied one after the other, some 50 ns each.
//
//     block of n periods      k = (n - 1) (1 - cos(pi j / (m - 1))) / 2,  j = 0 .. m - 1,  m = 4, 7 or 13
//
// A bristle that slips in each period forgets: then periods begin while it slips, at the bound, and their
// results are smooth functions of k. The last coefficients of the interpolation, and a period between its
// points, decide whether the block is smooth. If not, it is halved: a bound that is met for the first time, a
// slip that disappears, a contact that opens. The rest is computed period by period.
#ifndef FC_SOLVER_LEAP_H
#define FC_SOLVER_LEAP_H

#include "solver/methods/periods.h"

// Takes *total over whole periods of a scene with moving inputs.
void fc_leap(FcIntegration law, const FcScene* scene, const FcSolverOptions* options, double periods,
             FcStepResult* total);

#endif
