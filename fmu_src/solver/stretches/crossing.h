// Takes the bristle through a stretch panel by panel, each of the first kind that is accurate there.
//
//     bounded Gauss   a section over which little relaxes, in one panel; no estimate         (panels/gauss_panel.h)
//     judged Gauss    the same in a few panels, each judged by its estimate
//     settled         the bristle follows its limit: up to the next event in closed form     (settled_panel.h)
//     Radau           everything else, each judged and, if refused, taken again, shorter     (mesh.h, panels/radau_panel.h)
#ifndef FC_SOLVER_CROSSING_H
#define FC_SOLVER_CROSSING_H

#include "solver/panels/panel.h"
#include "solver/stretches/stretch.h"
#include "solver/stretches/watch.h"

// The map of the crossed part of an interval, and its cost.
typedef struct {
    const FcInterval* interval;
    FcMap* map;
    double scale;       // m, size of the deflection at the start if the map must hold for any, else 0
    double held;        // N, the force whose work the displacement corrects, or 0
    double evaluations; // in the communication step so far
    FcWatch* watch;     // of a bounded bristle, which is crossed up to its meeting with the bound; else NULL
} FcCrossed;

// Whether the bristle has met its bound.
static inline bool fc_has_met(const FcCrossed* crossed) {
    return crossed->watch && crossed->watch->met.side != 0;
}

// Whether the taken panel may stay. *h [s] is its length. It is less if the bristle meets its bound in it:
// then the panel is cut there.
bool fc_may_keep_panel(FcCrossed* crossed, const FcPanelAt* at, const FcTrajectories* from, FcPanel* panel,
                       double* h);

// The trajectories at the end of the map.
FcTrajectories fc_crossed_trajectories(const FcCrossed* crossed);

// Crosses the next stretch.
void fc_cross(FcCrossed* crossed, FcStretch* stretch);

#endif
