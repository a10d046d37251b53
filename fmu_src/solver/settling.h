// Where a stretch may be left to a settled panel (solver/settled_panel.h), and how far that goes.
//
//     |V|  |    .  '  '  .    |
//          |  '            '  |
//          |bell| between |bell|
//             |-------------->|    through both bells of the Stribeck curve, where the bristle follows it
//               |--------->|       else from where the first is not seen any more to where the last begins
#ifndef FC_SOLVER_SETTLING_H
#define FC_SOLVER_SETTLING_H

#include "solver/settled_panel.h"

typedef struct {
    const FcScene* scene;
    FcSettledStart start;                   // but for where that is
    double end;                             // s, of what is crossed
    bool follows_in_first, follows_in_last; // bell; of the first one, whether it may
    FcSettledBell first, last;              // where it follows in them
    double too_long;                        // s
} FcSettling;

// beyond_bells is the scene where it has no Stribeck curve. Keeps the pointers.
void fc_settling_init(FcSettling* settling, const FcScene* scene, const FcScene* beyond_bells,
                      const FcMesh* mesh, const FcStretch* stretch, double end);

// The settled panel from there, and the time [s] it ends at, if one is accurate. The panel holds what it was taken from.
bool fc_settle(FcSettling* settling, const FcPlace* at, FcPanel* panel, double* end, double* evaluations);

#endif
