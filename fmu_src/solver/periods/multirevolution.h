// The multirevolution step: many vibration periods with moving inputs, at the cost of some.
//
// Period k of a step begins with the inputs V + V' k T, d + d' k T, ... at the same phase. Its map is a smooth
// function of k, which need not be whole. A block of periods is taken by interpolated maps (period_interpolation.h).
//
// A bristle that slips in each period forgets its past. Then periods begin while it slips, at the bound, and
// their results are smooth functions of k. A block is halved if it is not smooth, for example if the bristle
// meets its bound for the first time, a slip disappears or the contact opens. The remaining periods are computed
// one by one.
#ifndef FC_SOLVER_PERIODS_MULTIREVOLUTION_H
#define FC_SOLVER_PERIODS_MULTIREVOLUTION_H

#include "solver/solver.h"

// Takes *total over whole periods of a scene with moving inputs; returns how many it took, fewer if they cost too much.
double fc_multirevolution(const FcScene* scene, const FcSolverOptions* options, double periods,
                          FcStepResult* total);

#endif
