// Coulomb friction: F_t = g sgn(V), 0 where V is 0. No state; the limit of the Dahl bristle at infinite stiffness.
#ifndef FC_SOLVER_COULOMB_H
#define FC_SOLVER_COULOMB_H

#include "solver/periods.h"

// An FcIntervalMap: the deflection stays; impulse and work are exact where g is constant, and quadratures of a smooth
// function between the reversals elsewhere.
FcMap fc_coulomb_interval(const FcScene* scene, const FcSolverOptions* options, double duration,
                          double delta_0, FcMapScope scope, double* evaluations);

#endif
