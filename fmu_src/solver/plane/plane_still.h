// The plane without vibration and with its inputs held: closed forms.
#ifndef FC_SOLVER_PLANE_STILL_H
#define FC_SOLVER_PLANE_STILL_H

#include "model/plane.h"
#include "solver/solver.h"

// A step of h [s] >= 0 with all inputs held, of Dahl's or LuGre's law without a bound: exact.
void fc_plane_constant(const FcScene* scene, double h, FcStepResult* result);

// The limit of a bristle within its bound in steady sliding without vibration, and its force [N]; the bristle
// itself if nothing moves.
FcBristle fc_plane_slides_for_ever(const FcScene* scene, FcBristle from, FcVector* force);

#endif
