// A bristle, or Coulomb's law, in the plane over an interval: part by part (course.h), panel by panel
// (plane_panel.h).
//
// The march is that of one line (march/march.h) with a disc for the bound. The polynomial through the points
// of a free panel shows whether |delta| reaches D. The panel is cut there, and the bristle slips around the
// disc until it is no longer pushed outwards.
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
