// The methods behind one door: which of them takes a scene over a step, and where a scene settles.
#ifndef FC_SOLVER_METHOD_H
#define FC_SOLVER_METHOD_H

#include "solver/methods/methods.h"
#include "solver/solver.h"

// The step [0, h], h [s] >= 0, from delta_0 [m]. Whatever the method is, Coulomb and ElasticPlastic are solved
// in the default's way: exactly, or to the tolerance where sigma or g moves. So is what cvode does not know of, a bristle that
// may touch its bound.
// cvode is the solver of FC_METHOD_CVODE, unused by the others. Returns false, with *message filled and *result as it
// was, where the method refuses.
bool fc_method_step(const FcScene* scene, FcMethod method, FcCvode* cvode, const FcSolverOptions* options,
                    double h, double delta_0, FcStepResult* result, FcMessage* message);

// The deflection [m] that a step from delta [m] starts at: of a bounded bristle at most the bound, beyond which inputs or
// parameters may have left it.
double fc_method_start(const FcScene* scene, double delta);

// The deflection [m] that delta_0 [m] tends to after infinitely many periods of a scene with held inputs, at the phase
// of its start; without vibration after sliding for ever. delta_0 where nothing moves. Not for Coulomb's law, which has none.
// Adds what it spends to *evaluations.
double fc_method_settled(const FcScene* scene, const FcSolverOptions* options, double delta_0,
                         double* evaluations);

// The mean of F (solver.h) [N] over a period of the vibration once delta_0 [m] has settled so; without vibration the force
// of sliding for ever. Adds what it spends to *evaluations.
double fc_method_settled_force(const FcScene* scene, const FcSolverOptions* options, double delta_0,
                               double* evaluations);

#endif
