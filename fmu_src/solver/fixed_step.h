// The fixed-step methods: explicit Euler, RK4, trapezoid and backward Euler.
#ifndef FC_SOLVER_FIXED_STEP_H
#define FC_SOLVER_FIXED_STEP_H

#include "model/scene.h"
#include "solver/solver.h"

// Takes *result over a step of h [s] >= 0. Returns false, with *message filled and *result unchanged, if it refuses the step:
// an explicit method would be unstable, a number is not finite, or the work is too much.
bool fc_fixed_step(const FcScene* scene, FcMethod method, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message);

// Whether steps of that size [s] are few enough for a communication step of h [s], which may be cut into segments.
bool fc_check_fixed_steps(const FcScene* scene, double size, double h, FcMessage* message);

#endif
