// The methods that integrate the bristle's equation, one file each; method.h chooses among them.
#ifndef FC_SOLVER_METHODS_H
#define FC_SOLVER_METHODS_H

#include "solver/methods/periods.h"

// The default: the map of an interval in which something moves, and the closed form for held inputs without
// vibration, exact for any h [s] >= 0, with the contact of its start.
FcMap fc_collocation_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                              double delta_0, FcMapScope scope, double* evaluations);
// The same of a bounded bristle, up to its first meeting with the bound.
struct FcWatch;
FcMap fc_collocation_watched(const FcScene* scene, const FcSolverOptions* options, double duration,
                             double delta_0, struct FcWatch* watch, double* evaluations);
void fc_collocation_constant(const FcScene* scene, const FcContactResponse* contact, double h, double delta_0,
                             FcStepResult* result);

// Coulomb's law, an FcStep.
void fc_coulomb_step(const FcScene* scene, const FcSolverOptions* options, double duration,
                     FcStepResult* result);

// The others take *result over a step of h [s] >= 0. They return false, with *message filled and *result
// unchanged, if they refuse the step: an explicit method would be unstable, a number is not finite, the work
// is too much, or CVODE fails.
bool fc_fixed_step(const FcScene* scene, FcMethod method, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message);

// SUNDIALS CVODE keeps its memory between steps, never its state. fc_cvode_new gives NULL, with *message
// filled, without memory or in a build without SUNDIALS; fc_cvode_free takes NULL.
typedef struct FcCvode FcCvode;
FcCvode* fc_cvode_new(FcMessage* message);
void fc_cvode_free(FcCvode* solver);
bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message);

#endif
