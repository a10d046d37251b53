#include "solver/judge.h"

// What a Gauss panel's estimates may be, over the tolerance.
static const double OF_GAUSS_PANELS = 10.0;
static const double OF_GAUSS_PANELS_IN_BELLS = 1.0;
// Of the mean over a Gauss panel that relaxes by more than STEEP: its estimate may be but twice the error.
static const double STEEP = 4.0;
static const double OF_STEEP_PANELS = 0.2;
// The same of Radau panels.
static const double OF_THE_MEAN = 10.0;
static const double AT_THE_END = 0.2;
static const double OF_THE_MEAN_IN_BELLS = 1.0;
static const double AT_THE_END_IN_BELLS = 0.05;
// Rounding in a panel, over the limit: asking for less would only shorten panels.
static const double ROUNDING = 2e-13;

bool fc_gauss_panel_is_resolved(const FcPanel* panel, int nodes) {
    // n nodes resolve e^G where G grows by less than half of n. It shrinks only where V turns, which no panel is for.
    return panel->z >= 0.0 && panel->z < 0.5 * nodes;
}

FcExcess fc_gauss_panel_excess(const FcPanel* panel, double share, bool in_bell, double forgets,
                               double tolerance) {
    const double allowed = (in_bell ? OF_GAUSS_PANELS_IN_BELLS : OF_GAUSS_PANELS) * tolerance;
    const double of_mean = panel->z < STEEP ? 1.0 : OF_STEEP_PANELS;
    const double of_end = fc_least(1.0, in_bell ? forgets : panel->z); // which may be 0, as the error then is
    return (FcExcess){share * panel->mean_error / (of_mean * allowed),
                      panel->end_error == 0.0 ? 0.0 : panel->end_error / (of_end * allowed)};
}

bool fc_gauss_panel_is_accurate(const FcPanel* panel, int nodes, double share, bool in_bell, double forgets,
                                double tolerance) {
    const FcExcess over = fc_gauss_panel_excess(panel, share, in_bell, forgets, tolerance);
    return fc_gauss_panel_is_resolved(panel, nodes) && over.mean <= 1.0 && over.end <= 1.0;
}

FcExcess fc_radau_panel_excess(const FcPanel* panel, const FcErrorLife* life, double tolerance) {
    const double rounding = ROUNDING * panel->limit;
    const double whole = tolerance * fc_least(1.0, panel->z);
    const double end_error = panel->end_error * life->grows;
    const double of_mean = end_error * life->lives + panel->mean_error * life->lasts;
    return (FcExcess){
        of_mean / fc_most((life->crosses_bell ? OF_THE_MEAN_IN_BELLS : OF_THE_MEAN) * whole, rounding),
        end_error / fc_most((life->in_bell ? AT_THE_END_IN_BELLS : AT_THE_END) * whole, rounding)};
}
