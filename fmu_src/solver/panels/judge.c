#include "solver/panels/judge.h"

#include <assert.h>

#include "solver/budget.h"

// n nodes resolve e^G if G grows by less than half of n. A negative z means that V turned, for which there is
// no panel.
static bool is_resolved(const FcPanel* panel, int nodes) { return panel->z >= 0.0 && panel->z < 0.5 * nodes; }

bool fc_gauss_panel_is_accurate(const FcPanel* panel, int nodes, double share, bool in_peak, double forgets,
                                double allowed) {
    assert(!(share < 0.0 || share > 1.0) && allowed >= 0.0);
    const double may_be = (in_peak ? FC_SHARE_OF_GAUSS_PANEL_IN_PEAK : FC_SHARE_OF_GAUSS_PANEL) * allowed;
    const double of_end = fc_least(1.0, in_peak ? forgets : panel->z); // may be 0, and so is the error then
    return is_resolved(panel, nodes) && share * panel->mean_error <= may_be &&
           panel->end_error <= of_end * may_be;
}

FcExcess fc_radau_panel_excess(const FcPanel* panel, const FcErrorLife* life, double allowed) {
    assert(!(life->lives < 0.0 || life->lives > 1.0 || life->lasts < 0.0 || life->lasts > 1.0));
    const double rounding = FC_ROUNDING_OF_PANEL * panel->limit;
    const double whole = allowed * fc_least(1.0, panel->z);
    const double of_mean = life->crosses_peak ? FC_SHARE_OF_RADAU_MEAN_IN_PEAK : FC_SHARE_OF_RADAU_MEAN;
    const double of_end = life->in_peak ? FC_SHARE_OF_RADAU_END_IN_PEAK : FC_SHARE_OF_RADAU_END;
    const double end_error = panel->end_error * life->grows;
    const double mean_error = end_error * life->lives + panel->mean_error * life->lasts;
    return (FcExcess){mean_error / fc_most(of_mean * whole, rounding),
                      end_error / fc_most(of_end * whole, rounding)};
}
