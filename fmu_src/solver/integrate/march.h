// The march: a bristle, or Coulomb's law, over an interval along a line or in the plane. It integrates over the parts of the
// interval (time_map.h) panel by panel (panel.h), from event to event (events.h). A line is a plane in which nothing moves
// transversely.
#ifndef FC_SOLVER_INTEGRATE_MARCH_H
#define FC_SOLVER_INTEGRATE_MARCH_H

#include "solver/affine_map.h"

// Takes *result over [0, duration] of the scene, from a bristle within its bound (fc_project_onto_bound), and adds the integrals.
void fc_march_step(const FcScene* scene, const FcSolverOptions* options, double duration,
                   FcStepResult* result);

// The map of delta over an interval without a meeting, for any start of the size of start [m]; in the plane with that
// of delta_y in *across, which is NULL along a line.
FcMap fc_march_map(const FcScene* scene, const FcSolverOptions* options, double duration, double start,
                   FcMap* across, double* evaluations);

// Whether a bristle within its bound may meet it in the scene.
bool fc_march_may_meet(const FcScene* scene);

#endif
