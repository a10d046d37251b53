// Steps and settled states without vibration, with the inputs held: closed forms.
#ifndef FC_SOLVER_CONSTANT_STEP_H
#define FC_SOLVER_CONSTANT_STEP_H

#include "model/plane.h"
#include "solver/solver.h"

// A step of h [s] >= 0 of Dahl's or LuGre's law without a bound: from that start: exact. contact is the scene's at its start.
void fc_constant_step(const FcScene* scene, const FcContactResponse* contact, double h, FcBristle from,
                      FcStepResult* result);

// The limit of a bristle within its bound in steady sliding, and its force [N]; the bristle itself if nothing moves.
FcBristle fc_steady_sliding(const FcScene* scene, FcBristle from, FcVector* force);

#endif
