// Whether a panel is accurate enough, by its estimated errors and the budget (budget.h).
#ifndef FC_SOLVER_JUDGE_H
#define FC_SOLVER_JUDGE_H

#include <stdbool.h>

#include "solver/panels/panel.h"

// A Gauss panel that takes that share of its stretch; in a Stribeck peak the share is the peak's. allowed
// [N]: the error of a force. forgets: the relaxation in the stretch and the next one, which limits the error
// at the end of a peak.
bool fc_gauss_panel_is_accurate(const FcPanel* panel, int nodes, double share, bool in_peak, double forgets,
                                double allowed);

// The life of an error of a Radau panel, and whether the panel is in a peak, or crosses it by more than V_S.
typedef struct {
    double lives; // 1, its life after the panel, over the interval
    double lasts; // 1, the panel's length, over the interval
    double grows; // 1, the factor by which it may grow with sigma meanwhile
    bool in_peak, crosses_peak;
} FcErrorLife;

// The estimated errors of a Radau panel over the allowed ones: in the interval's mean, and at its end if
// nothing of the error faded.
typedef struct {
    double mean, end;
} FcExcess;
FcExcess fc_radau_panel_excess(const FcPanel* panel, const FcErrorLife* life, double allowed);

#endif
