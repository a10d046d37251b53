// Coulomb friction: F_t = F_C sgn(V), 0 where V is 0. No state; the limit of the Dahl bristle at infinite stiffness.
#ifndef FC_SOLVER_COULOMB_H
#define FC_SOLVER_COULOMB_H

#include "solver/periods.h"

double fc_coulomb_force(double V, double F_C); // N

// An FcIntervalMap: the deflection stays, the impulse and the work are exact.
FcMap fc_coulomb_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                          double delta_0, FcMapScope scope, double* evaluations);

#endif
