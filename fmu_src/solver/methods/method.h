// The methods behind one door: which of them takes a scene over a step, and where a scene settles.
#ifndef FC_SOLVER_METHOD_H
#define FC_SOLVER_METHOD_H

#include "model/plane.h"
#include "solver/methods/methods.h"
#include "solver/solver.h"

// The step [0, h], h [s] >= 0, from a bristle that is within its bound (fc_reach). Whatever the method is, Coulomb and ElasticPlastic
// are solved in the default's way: exactly, or to the tolerance if sigma or g moves. So is what cvode does not know of, a bristle
// that may meet its bound.
// cvode is the solver of FC_METHOD_CVODE, unused by the others. Returns false, with *message filled, if the method refuses.
bool fc_method_step(const FcScene* scene, FcMethod method, FcCvode* cvode, const FcSolverOptions* options,
                    double h, FcBristle from, FcStepResult* result, FcMessage* message);

// What a bristle that is within its bound tends to in a scene with held inputs: after infinitely many periods of the vibration, at the
// phase of its start, or after sliding for ever. Itself if nothing moves. *force [N] becomes the mean of F (solver.h) over
// a period of the vibration, or over those that repeat; without vibration the force of sliding for ever. Adds what it spends
// to *evaluations.
FcBristle fc_method_settled(const FcScene* scene, const FcSolverOptions* options, FcBristle from,
                            FcVector* force, double* evaluations);

#endif
