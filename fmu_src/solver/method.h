// The dispatch of the methods: the choice of the method for a step, and the settled state of a scene.
#ifndef FC_SOLVER_METHOD_H
#define FC_SOLVER_METHOD_H

#include "model/plane.h"
#include "solver/solver.h"

// Take *result over a step of h [s] >= 0. They return false, with *message filled and *result
// unchanged, if they refuse the step: an explicit method would be unstable, a number is not finite, the work
// is too much, or CVODE fails.
bool fc_fixed_step(const FcScene* scene, FcMethod method, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message);

// Whether steps of that size [s] are few enough for a communication step of h [s], which may be cut into segments.
bool fc_check_fixed_steps(const FcScene* scene, double size, double h, FcMessage* message);

// SUNDIALS CVODE keeps its memory between steps, never its state. fc_cvode_new gives NULL, with *message
// filled, without memory or in a build without SUNDIALS; fc_cvode_free takes NULL. The one with a body is for
// fc_body_step (solver/body.h), the other one for fc_cvode_step.
typedef struct FcCvode FcCvode;
FcCvode* fc_cvode_new(bool with_body, FcMessage* message);
void fc_cvode_free(FcCvode* solver);
bool fc_cvode_step(FcCvode* solver, const FcScene* scene, const FcSolverOptions* options, double h,
                   FcStepResult* result, FcMessage* message);

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
