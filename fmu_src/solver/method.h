// The dispatch of the methods: the choice of the method for a step, and the settled state of a scene.
#ifndef FC_SOLVER_METHOD_H
#define FC_SOLVER_METHOD_H

#include "model/plane.h"
#include "solver/cvode.h"
#include "solver/solver.h"

// The step [0, h], h [s] >= 0, of a scene in which nothing moves, by a closed form; false if there is none for
// this scene and this method. contact is the scene's at its start.
bool fc_method_formula(const FcScene* scene, const FcContactResponse* contact, FcMethod method, double h,
                       FcBristle from, FcStepResult* result);

// The step [0, h], h [s] >= 0, from a bristle that is within its bound (fc_project_onto_bound). Any method leaves Coulomb's
// law to the default, and the fixed-step methods leave ElasticPlastic. cvode is the solver of FC_METHOD_CVODE,
// unused by the others. Returns false, with *message filled, if the method refuses.
bool fc_method_step(const FcScene* scene, FcMethod method, FcCvode* cvode, const FcSolverOptions* options,
                    double h, FcBristle from, FcStepResult* result, FcMessage* message);

// The limit of a bristle that is within its bound in a scene with held inputs: after infinitely many periods
// of the vibration, at the phase of its start, or after infinite sliding. The bristle itself if nothing
// moves. *force [N] becomes the mean of F (solver.h) over a period of the vibration, or over the periods that
// repeat; without vibration the force of steady sliding. Adds its evaluations to *evaluations.
// *scatters: the periods do not repeat (periods.h).
FcBristle fc_method_settled(const FcScene* scene, const FcSolverOptions* options, FcBristle from,
                            FcVector* force, double* evaluations, bool* scatters);

#endif
