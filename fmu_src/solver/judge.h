// Whether a panel is accurate enough, by what it estimates.
//
// Estimates are 10 to 10^5 times too large for most panels and rarely too small, so they may be above the tolerance. The
// end of the interval sees the last panels as they are; in the mean the few whose estimates are too small drown. In bells
// of the Stribeck curve estimates are up to ten times too small.
#ifndef FC_SOLVER_JUDGE_H
#define FC_SOLVER_JUDGE_H

#include <stdbool.h>

#include "solver/panel.h"

// What a Gauss panel's estimates may be, over the tolerance.
static const double FC_OF_GAUSS_PANELS = 10.0;

// Whether a Gauss panel of that many nodes, in a part of a stretch that is that share of it, is accurate for a tolerance [N].
// forgets: how much relaxes in the part and the next stretch, which counts in a bell.
bool fc_gauss_panel_is_accurate(const FcPanel* panel, int nodes, double share, bool in_bell, double forgets,
                                double tolerance);

// What becomes of an error of a Radau panel, and whether it is in a bell, or crosses it by more than V_S.
typedef struct {
    double lives; // 1, of the interval, that it lives for after the panel
    double lasts; // 1, of the interval, that the panel lasts
    double grows; // 1, by which it may grow on its way with sigma
    bool in_bell, crosses_bell;
} FcErrorLife;

// The estimated errors of a Radau panel over what they may be for a tolerance [N]: what the mean sees, and what the end would
// see if nothing of it faded.
typedef struct {
    double mean, end;
} FcExcess;
FcExcess fc_radau_panel_excess(const FcPanel* panel, const FcErrorLife* life, double tolerance);

#endif
