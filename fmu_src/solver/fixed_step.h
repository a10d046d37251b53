// The fixed-step methods: explicit Euler, RK4, trapezoid, backward Euler.
#ifndef FC_SOLVER_FIXED_STEP_H
#define FC_SOLVER_FIXED_STEP_H

#include "solver/solver.h"

// Over h [s] >= 0 from delta_0 [m]. Returns false, with *message filled and *result as it was, where an explicit method
// would be unstable, a number ceases to be finite, or the steps are too many.
bool fc_fixed_step(const FcScene* scene, FcMethod method, const FcSolverOptions* options, double h,
                   double delta_0, FcStepResult* result, FcMessage* message);

#endif
