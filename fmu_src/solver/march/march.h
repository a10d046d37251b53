// A bounded bristle over an interval, regime by regime.
//
//     free      as if there were no bound: delta' = V in ElasticPlastic, by the panels of the unbounded laws in Dahl and LuGre
//     slipping  along its bound D, delta = side D, while it is pushed beyond it
//
// The points of each free panel show whether the bristle meets its bound (meeting.h). The panel is cut there,
// and the bristle slips, panel by panel, until its push has come to 0. In ElasticPlastic the deflection is a
// formula: delta_0 + displacement while the bristle sticks, D(t) while it slips. Only roots and quadratures
// remain. With a constant bound (march_between_reversals) the quadratures are closed forms, too.
//
// With static friction, break-away is a drop from the static bound to the kinetic one, and the energy that
// the bristle loses is heat.
#ifndef FC_SOLVER_MARCH_H
#define FC_SOLVER_MARCH_H

#include "solver/methods/periods.h"

// An FcStep: the scene over [0, duration] from a bristle within its bound (fc_reach).
void fc_march_step(const FcScene* scene, const FcSolverOptions* options, double duration,
                   FcStepResult* result);

// The map of a bristle of ElasticPlastic that sticks throughout.
FcMap fc_march_stuck(const FcScene* scene, const FcSolverOptions* options, double duration,
                     double* evaluations);

// Whether a bristle within its bound may touch the bound in the step. A relaxing bristle does not if the
// bound is constant or rises.
bool fc_march_may_touch(const FcScene* scene);

#endif
