// The method cvode: SUNDIALS CVODE.
#ifndef FC_SOLVER_CVODE_H
#define FC_SOLVER_CVODE_H

#include "solver/body/body.h"

// SUNDIALS CVODE keeps its memory between steps, never its state. fc_cvode_new gives NULL, with *message
// filled, without memory or in a build without SUNDIALS; fc_cvode_free takes NULL. The one with a body is for
// fc_body_cvode_step, the other one for fc_cvode_step.
typedef struct FcCvode FcCvode;
FcCvode* fc_cvode_new(bool with_body, FcMessage* message);
void fc_cvode_free(FcCvode* solver);

// Takes *result over a step of h [s] >= 0. False, with *message filled and *result unchanged, if CVODE fails.
bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message);

// Takes *result and the body over a segment with a bristle; refuses as fc_body_step.
bool fc_body_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                        FcBody* body, FcStepResult* result, FcMessage* message);

#endif
