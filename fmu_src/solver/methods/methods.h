// The methods that integrate the bristle's equation, one file each; method.h chooses among them.
#ifndef FC_SOLVER_METHODS_H
#define FC_SOLVER_METHODS_H

#include "solver/methods/periods.h"

// The default: an FcIntervalMap, for the scenes in which something moves, and the closed form for held inputs without
// vibration, exact for any h [s] >= 0.
FcMap fc_collocation_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                              double delta_0, FcMapScope scope, double* evaluations);
void fc_collocation_constant(const FcScene* scene, double h, double delta_0, FcStepResult* result);

// The others take a step of h [s] >= 0 from delta_0 [m]. They return false, with *message filled and *result as it was, where
// they refuse: an explicit method that would be unstable, a number that ceases to be finite, too much work, CVODE failing.
bool fc_fixed_step(const FcScene* scene, FcMethod method, const FcSolverOptions* options, double h,
                   double delta_0, FcStepResult* result, FcMessage* message);

// SUNDIALS CVODE keeps its memory between steps, never its state. fc_cvode_new gives NULL, with *message filled, without
// memory or in a build without SUNDIALS; fc_cvode_free takes NULL.
typedef struct FcCvode FcCvode;
FcCvode* fc_cvode_new(FcMessage* message);
void fc_cvode_free(FcCvode* solver);
bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   double delta_0, FcStepResult* result, FcMessage* message);

#endif
