// Panels pass on one side of the shares of the budget (solver/budget.h), and not on the other.
#include "solver/panels/judge.h"

#include <math.h>

#include "check.h"
#include "solver/budget.h"

static const double ALLOWED = 0.55; // N

// Estimates, over what a panel between Stribeck peaks may have.
static bool passes(double z, double of_end, double of_mean, double share, int nodes) {
    const double may_be = FC_SHARE_OF_GAUSS_PANEL * ALLOWED;
    const FcPanel panel = {.z = z, .end_error = of_end * may_be, .mean_error = of_mean * may_be};
    return fc_gauss_panel_is_accurate(&panel, nodes, share, false, 0.0, ALLOWED);
}

static bool passes_in_peak(double of_end, double of_mean, double forgets) {
    const double may_be = FC_SHARE_OF_GAUSS_PANEL_IN_PEAK * ALLOWED;
    const FcPanel panel = {.z = 0.01, .end_error = of_end * may_be, .mean_error = of_mean * may_be};
    return fc_gauss_panel_is_accurate(&panel, 8, 1.0, true, forgets, ALLOWED);
}

static void gauss_panels(void) {
    CHECK(passes(1.0, 0.99, 0.99, 1.0, 12));
    CHECK(!passes(1.0, 1.01, 0.0, 1.0, 12));
    CHECK(!passes(1.0, 0.0, 1.01, 1.0, 12));
    // The mean sees a part of a stretch by its share.
    CHECK(passes(1.0, 0.0, 3.99, 0.25, 12));
    CHECK(!passes(1.0, 0.0, 4.01, 0.25, 12));
    // A bristle that relaxes little sums up what panels miss.
    CHECK(passes(0.01, 0.0099, 0.0, 1.0, 12));
    CHECK(!passes(0.01, 0.0101, 0.0, 1.0, 12));
    CHECK(passes(0.0, 0.0, 0.0, 1.0, 12));
    CHECK(!passes(0.0, 1e-300, 0.0, 1.0, 12));
    // n nodes resolve e^z up to half of n; z is no number where the stiffness is none, and negative where V turns.
    CHECK(passes(3.99, 0.0, 0.0, 1.0, 8));
    CHECK(!passes(4.01, 0.0, 0.0, 1.0, 8));
    CHECK(!passes(-1e-3, 0.0, 0.0, 1.0, 8));
    CHECK(!passes(NAN, 0.0, 0.0, 1.0, 8));
    CHECK(!passes(1.0, NAN, 0.0, 1.0, 12));
    CHECK(!passes(1.0, 0.0, NAN, 1.0, 12));
    CHECK(passes_in_peak(0.99, 0.99, 3.0));
    CHECK(!passes_in_peak(1.01, 0.0, 3.0));
    CHECK(!passes_in_peak(0.0, 1.01, 3.0));
    CHECK(!passes_in_peak(0.6, 0.0, 0.5));
}

// The mean sees an error of the end for as long as it lives and that of the panel while it lasts.
static void radau_panels(void) {
    const double limit = 55.0;
    const FcPanel panel = {.z = 2.0, .limit = limit, .end_error = 0.3, .mean_error = 0.7};
    const FcErrorLife life = {.lives = 0.02, .lasts = 0.4, .grows = 3.0};
    const double end = 3.0 * 0.3;
    const double mean = end * 0.02 + 0.7 * 0.4;
    const FcExcess over = fc_radau_panel_excess(&panel, &life, ALLOWED);
    CHECK_NEAR(over.mean, mean / (FC_SHARE_OF_RADAU_MEAN * ALLOWED), 1e-14);
    CHECK_NEAR(over.end, end / (FC_SHARE_OF_RADAU_END * ALLOWED), 1e-14);
    // Of a panel that relaxes little, only that part; nothing below rounding is asked for.
    FcPanel little = panel;
    little.z = 0.25;
    CHECK_NEAR(fc_radau_panel_excess(&little, &life, ALLOWED).end, 4.0 * over.end, 1e-14);
    CHECK_NEAR(fc_radau_panel_excess(&panel, &life, 1e-14).end, end / (FC_ROUNDING_OF_PANEL * limit), 1e-14);
    // In a Stribeck peak estimates are too small: less passes.
    const FcErrorLife in_peak = {
        .lives = 0.02, .lasts = 0.4, .grows = 3.0, .in_peak = true, .crosses_peak = true};
    CHECK(fc_radau_panel_excess(&panel, &in_peak, ALLOWED).end > over.end);
    CHECK(fc_radau_panel_excess(&panel, &in_peak, ALLOWED).mean > over.mean);
}

int main(void) {
    gauss_panels();
    radau_panels();
    return check_result();
}
