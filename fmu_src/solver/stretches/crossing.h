// Takes the bristle through a stretch panel by panel, each of the first kind that is accurate there.
//
//     bounded Gauss   a section over which little relaxes, in one panel; no estimate         (panels/gauss_panel.h)
//     judged Gauss    the same in a few panels, each judged by its estimate
//     settled         the bristle follows its limit: up to the next event in closed form     (settled_panel.h)
//     Radau           everything else, each judged and if need be taken again, shorter       (mesh.h, panels/radau_panel.h)
#ifndef FC_SOLVER_CROSSING_H
#define FC_SOLVER_CROSSING_H

#include "solver/panels/panel.h"
#include "solver/stretches/stretch.h"

// The map of what has been crossed of an interval, and what it has cost.
typedef struct {
    const FcInterval* interval;
    FcMap* map;
    double scale;       // m, size of the deflection at the start where the map must hold for any, else 0
    double held;        // N, the force whose work is put right by the displacement, or 0
    double evaluations; // in the communication step so far
} FcCrossed;

// The trajectories that the map has come to.
FcTrajectories fc_crossed_trajectories(const FcCrossed* crossed);

// Crosses the stretch that follows what has been crossed.
void fc_cross(FcCrossed* crossed, FcStretch* stretch);

#endif
