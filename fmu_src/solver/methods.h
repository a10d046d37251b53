// The methods besides the default (march.h); method.h chooses among them.
#ifndef FC_SOLVER_METHODS_H
#define FC_SOLVER_METHODS_H

#include "solver/solver.h"

// Take *result over a step of h [s] >= 0. They return false, with *message filled and *result
// unchanged, if they refuse the step: an explicit method would be unstable, a number is not finite, the work
// is too much, or CVODE fails.
bool fc_fixed_step(const FcScene* scene, FcMethod method, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message);

// Whether steps of that size [s] are few enough for a communication step of h [s], which may be cut into pieces.
bool fc_check_fixed_steps(const FcScene* scene, double size, double h, FcMessage* message);

// SUNDIALS CVODE keeps its memory between steps, never its state. fc_cvode_new gives NULL, with *message
// filled, without memory or in a build without SUNDIALS; fc_cvode_free takes NULL.
typedef struct FcCvode FcCvode;
FcCvode* fc_cvode_new(FcMessage* message);
void fc_cvode_free(FcCvode* solver);
bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message);

#endif
