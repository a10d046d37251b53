// Whether a panel is accurate enough, by what it estimates.
//
// Estimates are 10 to 10^5 times too large for most panels and rarely too small, so they may be above the tolerance. The
// end of the interval sees the last panels as they are; in the mean the few whose estimates are too small drown. In bells
// of the Stribeck curve estimates are up to ten times too small.
#ifndef FC_SOLVER_JUDGE_H
#define FC_SOLVER_JUDGE_H

#include <stdbool.h>

#include "solver/panel.h"

// The estimated errors of a panel over what they may be for a tolerance [N]: what the mean sees, and what the
// end would see if nothing of it faded.
typedef struct {
    double mean, end;
} FcExcess;

// Of a Gauss panel that lasts for that share of its stretch, or in a bell that does. forgets: how much relaxes in the bell and
// the next stretch, which counts there.
FcExcess fc_gauss_panel_excess(const FcPanel* panel, double share, bool in_bell, double forgets,
                               double tolerance);

// Whether as many nodes resolve what relaxes in a Gauss panel, and also both of its errors are small enough.
bool fc_gauss_panel_is_resolved(const FcPanel* panel, int nodes);
bool fc_gauss_panel_is_accurate(const FcPanel* panel, int nodes, double share, bool in_bell, double forgets,
                                double tolerance);

// What becomes of an error of a Radau panel, and whether it is in a bell, or crosses it by more than V_S.
typedef struct {
    double lives; // 1, of the interval, that it lives for after the panel
    double lasts; // 1, of the interval, that the panel lasts
    double grows; // 1, by which it may grow on its way with sigma
    bool in_bell, crosses_bell;
} FcErrorLife;
FcExcess fc_radau_panel_excess(const FcPanel* panel, const FcErrorLife* life, double tolerance);

#endif
