// What panels may estimate and pass: the shares that solver/judge.h names, on both sides of each.
#include "solver/judge.h"

#include <math.h>

#include "check.h"

static const double TOLERANCE = 0.55; // N

static FcPanel gauss(double z, double of_end, double of_mean) {
    return (FcPanel){.z = z, .end_error = of_end * TOLERANCE, .mean_error = of_mean * TOLERANCE};
}

static bool passes(FcPanel panel, double share) {
    return fc_gauss_panel_is_accurate(&panel, 12, share, false, 0.0, TOLERANCE);
}

static bool passes_in_bell(FcPanel panel, double forgets) {
    return fc_gauss_panel_is_accurate(&panel, 8, 1.0, true, forgets, TOLERANCE);
}

static void gauss_panels(void) {
    CHECK(passes(gauss(1.0, 9.99, 9.99), 1.0));
    CHECK(!passes(gauss(1.0, 10.01, 0.0), 1.0));
    CHECK(!passes(gauss(1.0, 0.0, 10.01), 1.0));
    // The mean sees a part of a stretch by its share.
    CHECK(passes(gauss(1.0, 0.0, 39.9), 0.25));
    CHECK(!passes(gauss(1.0, 0.0, 40.1), 0.25));
    // A bristle that relaxes little sums up what panels miss.
    CHECK(passes(gauss(0.01, 0.0999, 0.0), 1.0));
    CHECK(!passes(gauss(0.01, 0.1001, 0.0), 1.0));
    CHECK(passes(gauss(0.0, 0.0, 0.0), 1.0));
    CHECK(!passes(gauss(0.0, 1e-300, 0.0), 1.0));
    // Steep ones, and those that n nodes don't resolve.
    CHECK(passes(gauss(4.1, 9.99, 1.99), 1.0));
    CHECK(!passes(gauss(4.1, 0.0, 2.01), 1.0));
    CHECK(passes(gauss(3.99, 0.0, 9.99), 1.0));
    const FcPanel resolved = gauss(3.99, 0.0, 0.0);
    CHECK(fc_gauss_panel_is_resolved(&resolved, 8));
    const FcPanel unresolved = gauss(4.01, 0.0, 0.0);
    CHECK(!fc_gauss_panel_is_resolved(&unresolved, 8));
    CHECK(!fc_gauss_panel_is_accurate(&unresolved, 8, 1.0, false, 0.0, TOLERANCE));
    const FcPanel backwards = gauss(-1e-3, 0.0, 0.0); // V turns in it
    CHECK(!fc_gauss_panel_is_resolved(&backwards, 8));
    const FcPanel unknown = gauss(NAN, 0.0, 0.0);
    CHECK(!fc_gauss_panel_is_resolved(&unknown, 8));
    // In bells of the Stribeck curve.
    CHECK(passes_in_bell(gauss(0.01, 0.999, 0.999), 3.0));
    CHECK(!passes_in_bell(gauss(0.01, 1.001, 0.0), 3.0));
    CHECK(!passes_in_bell(gauss(0.01, 0.0, 1.001), 3.0));
    CHECK(!passes_in_bell(gauss(0.01, 0.6, 0.0), 0.5));
    // No number is no accuracy.
    CHECK(!passes(gauss(1.0, NAN, 0.0), 1.0));
    CHECK(!passes(gauss(1.0, 0.0, NAN), 1.0));
    CHECK(!passes(gauss(NAN, 0.0, 0.0), 1.0));
}

// The mean sees an error of the end for as long as it lives and that of the panel while it lasts; a tenth of both counts,
// but five times what the end sees.
static void radau_panels(void) {
    const double limit = 55.0;
    const FcPanel panel = {.z = 2.0, .limit = limit, .end_error = 0.3, .mean_error = 0.7};
    FcErrorLife life = {.lives = 0.02, .lasts = 0.4, .grows = 3.0};
    FcExcess over = fc_radau_panel_excess(&panel, &life, TOLERANCE);
    CHECK_NEAR(over.mean, (3.0 * 0.3 * 0.02 + 0.7 * 0.4) / (10.0 * TOLERANCE), 1e-14);
    CHECK_NEAR(over.end, 3.0 * 0.3 / (0.2 * TOLERANCE), 1e-14);
    life.in_bell = true;
    over = fc_radau_panel_excess(&panel, &life, TOLERANCE);
    CHECK_NEAR(over.mean, (3.0 * 0.3 * 0.02 + 0.7 * 0.4) / (10.0 * TOLERANCE), 1e-14);
    CHECK_NEAR(over.end, 3.0 * 0.3 / (0.05 * TOLERANCE), 1e-14);
    life.crosses_bell = true;
    CHECK_NEAR(fc_radau_panel_excess(&panel, &life, TOLERANCE).mean,
               (3.0 * 0.3 * 0.02 + 0.7 * 0.4) / TOLERANCE, 1e-14);
    // Of a panel that relaxes little, only that part.
    FcPanel little = panel;
    little.z = 0.25;
    CHECK_NEAR(fc_radau_panel_excess(&little, &life, TOLERANCE).end, 4.0 * 3.0 * 0.3 / (0.05 * TOLERANCE),
               1e-14);
    // Nothing below rounding is asked for.
    over = fc_radau_panel_excess(&panel, &life, 1e-14);
    CHECK_NEAR(over.end, 3.0 * 0.3 / (2e-13 * limit), 1e-14);
    CHECK_NEAR(over.mean, (3.0 * 0.3 * 0.02 + 0.7 * 0.4) / (2e-13 * limit), 1e-14);
}

int main(void) {
    gauss_panels();
    radau_panels();
    return check_result();
}
