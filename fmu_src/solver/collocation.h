// The default method.
#ifndef FC_SOLVER_COLLOCATION_H
#define FC_SOLVER_COLLOCATION_H

#include "solver/periods.h"

// An FcIntervalMap, for the scenes in which something moves.
FcMap fc_collocation_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                              double delta_0, FcMapScope scope, double* evaluations);

// The closed form for held inputs without vibration, exact for any h [s] >= 0.
void fc_collocation_constant(const FcScene* scene, double h, double delta_0, FcStepResult* result);

#endif
