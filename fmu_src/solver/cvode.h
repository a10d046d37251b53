// SUNDIALS CVODE as a method. It keeps its memory between steps, never its state.
#ifndef FC_SOLVER_CVODE_H
#define FC_SOLVER_CVODE_H

#include "solver/solver.h"

typedef struct FcCvode FcCvode;

// NULL, with *message filled, without memory or in a build without SUNDIALS.
FcCvode* fc_cvode_new(FcMessage* message);
void fc_cvode_free(FcCvode* solver); // NULL is allowed

// Over h [s] >= 0 from delta_0 [m]. Returns false, with *message filled and *result as it was, where CVODE fails or the
// work is too much.
bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   double delta_0, FcStepResult* result, FcMessage* message);

#endif
