// A bristle, or Coulomb's law, in the plane over an interval: half by half (course.h), panel by panel
// (plane_panel.h).
//
// It is the march of one line (march/march.h) with a disc for the bound: a bristle goes on as if it were
// free; each panel says by the polynomial through its points whether |delta| comes to D. It is cut there, and
// the bristle slips around the disc until it is not pushed outwards any more.
#ifndef FC_SOLVER_PLANE_MARCH_H
#define FC_SOLVER_PLANE_MARCH_H

#include "solver/methods/periods.h"

// An FcStep of a scene in the plane, from a bristle within its bound (fc_reach).
void fc_plane_step(const FcScene* scene, const FcSolverOptions* options, double duration,
                   FcStepResult* result);

// The maps of delta and delta_y over an interval without a meeting, for any start of the size of start [m].
FcMap fc_plane_map(const FcScene* scene, const FcSolverOptions* options, double duration, double start,
                   FcMap* across, double* evaluations);

#endif
