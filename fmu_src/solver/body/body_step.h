// A step of a contact with a mass: the dispatch of its methods, segment by segment.
#ifndef FC_SOLVER_BODY_BODY_STEP_H
#define FC_SOLVER_BODY_BODY_STEP_H

#include "solver/body/body.h"
#include "solver/cvode.h"

// The step [0, h], h [s] >= 0, of a scene along a line, whose V does not contain v: from a bristle that is within its bound,
// and takes the body with it.
// A segment with a bristle that the march of collocation cannot make accurate is left to CVODE, unless cvode is NULL.
// impulse, work and heat of the result are those of F_t, with its damping and viscous friction. Returns false, with
// *message filled, if it refuses the step.
bool fc_body_step(const FcScene* scene, FcMethod method, FcCvode* cvode, const FcSolverOptions* options,
                  double h, FcBristle from, FcBody* body, FcStepResult* result, FcMessage* message);

#endif
