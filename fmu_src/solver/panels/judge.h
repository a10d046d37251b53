// Whether a panel is accurate enough, by the errors that it estimates and the budget (budget.h).
#ifndef FC_SOLVER_JUDGE_H
#define FC_SOLVER_JUDGE_H

#include <stdbool.h>

#include "solver/panels/panel.h"

// A Gauss panel that lasts for that share of its stretch, or in a Stribeck peak that does; allowed [N] of a force. forgets:
// how much relaxes in the peak and the next stretch, which counts there.
bool fc_gauss_panel_is_accurate(const FcPanel* panel, int nodes, double share, bool in_peak, double forgets,
                                double allowed);

// What becomes of an error of a Radau panel, and whether the panel is in a peak, or crosses it by more than V_S.
typedef struct {
    double lives; // 1, of the interval, that it lives for after the panel
    double lasts; // 1, of the interval, that the panel lasts
    double grows; // 1, by which it may grow on its way with sigma
    bool in_peak, crosses_peak;
} FcErrorLife;

// The estimated errors of a Radau panel over what they may be: what the mean sees, and what the end of the interval would see
// if nothing of it faded.
typedef struct {
    double mean, end;
} FcExcess;
FcExcess fc_radau_panel_excess(const FcPanel* panel, const FcErrorLife* life, double allowed);

#endif
