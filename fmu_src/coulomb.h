// Coulomb friction: F_t = F_C sgn(V), 0 where V is 0. No state; the limit of the Dahl bristle at infinite stiffness.
#ifndef FC_COULOMB_H
#define FC_COULOMB_H

#include "solver.h"

double coulomb_force(double V, double F_C); // N

// As the steps of solver.h: the deflection stays, the impulse and the work are exact.
int coulomb_step(const DahlProblem* problem, const SolverOptions* options, double h, double delta_0,
                 StepResult* result, Message* message);

#endif
