// The plane without vibration and with its inputs held: closed forms.
#ifndef FC_SOLVER_PLANE_STILL_H
#define FC_SOLVER_PLANE_STILL_H

#include "model/plane.h"
#include "solver/solver.h"

// A step of h [s] >= 0 in which nothing moves, of Dahl's or LuGre's law without a bound: exact.
void fc_plane_constant(const FcScene* scene, double h, FcStepResult* result);

// What a bristle that is within its bound tends to without vibration, sliding for ever, and its force [N]; itself if nothing moves.
FcBristle fc_plane_slides_for_ever(const FcScene* scene, FcBristle from, FcVector* force);

#endif
